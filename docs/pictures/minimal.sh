#!/usr/bin/env bash
# Draws docs/pictures/minimal.png: the minimal model (section 5.H of the thesis) with the thesis's numbers, and
# beside grains and the form with memory.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
program=${GRAINLAW:-./grainlaw}
curves=$(mktemp -d)
trap 'rm -rf "$curves"' EXIT
law() { "$program" predict "$@" 2>>"$curves/log"; }
cycle='{"mode": "iso", "controls": {"nu": 0.73}}, {"mode": "iso", "controls": {"nu": 0.64}}'
for M in 1 300; do
  echo "{\"start\": {\"nu\": 0.64}, \"segments\": [{\"repeat\": $M, \"segments\": [$cycle]}]}" >"$curves/iso-$M.json"
  law data/thesis/near-jamming.json "$curves/iso-$M.json" --form minimal -o "$curves/iso-$M.csv"
done
law data/thesis/near-jamming.json data/paths/shear-jamming.json --form minimal --rows 400 -o "$curves/shear.csv"
for form in coupled memory minimal; do
  law data/grains/w-3-memory.json data/records/base/records/d2-cycle-0.685-s1 --form $form -o "$curves/d2-$form.csv"
  law data/grains/w-3-memory.json data/records/base/records/iso-s1 --form $form -o "$curves/oc-$form.csv"
done
gnuplot -e "curves='$curves'; records='data/records/base/records'" docs/pictures/minimal.gp >docs/pictures/minimal.png
