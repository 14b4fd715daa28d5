#!/usr/bin/env bash
# Makes the CSV files of this folder anew with LAMMPS (Debian's package lammps), from packing.data.
# packing.data: grainlaw simulate scene.json -o packing; grainlaw export packing/snapshots.h5 -o packing.data
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
time=4.56  # us: 1000 steps of t_c/50

# flow NAME GAMMA GAMMA_B STEPS STRAIN: NAME.csv has the place of every grain at the end.
flow() {
  lmp -in in.reference -log "$work/log" -screen none -var gamma "$2" -var gamma_b "$3" -var steps "$4" \
    -var strain "$5" -var dt "$(awk -v t="$time" -v n="$4" 'BEGIN {printf "%.17g", t / n}')" -var out "$work/dump"
  awk 'BEGIN {print "id,x,y,z"} body {print $1 "," $2 "," $3 "," $4} /^ITEM: ATOMS/ {body = 1}' "$work/dump" >"$1.csv"
}

flow elastic 0 0 1000 0
for steps in 500 1000 2000; do
  flow "damped-$steps" 1000 100 "$steps" 0
  flow "flow-$steps" 1000 0 "$steps" 1e-3
done
for steps in 1000 2000; do flow "drag-$steps" 1000 100 "$steps" 1e-3; done
# The start, with damping: stress and twice the number of contacts.
awk 'BEGIN {print "sxx,syy,szz,sxy,sxz,syz,contacts"}
     $1 == 0 && NF == 8 && !seen++ {printf "%s,%s,%s,%s,%s,%s,%d\n", $2, $3, $4, $5, $6, $7, $8 / 2}' "$work/log" >start.csv
lmp -h | awk '/^Large-scale/ {sub(/.*Simulator - /, ""); print}' >version.txt
