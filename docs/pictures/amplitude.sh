#!/usr/bin/env bash
# Draws docs/pictures/amplitude.svg from data/bench/amplitude-9261, and prints the numbers behind it.
# Usage: docs/pictures/amplitude.sh
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
points=$(mktemp -d)
trap 'rm -rf "$points"' EXIT
# For each packing a table: amplitude; B and G_oct over those of linear response; contacts changed in either probe;
# contacts still changed after the way back; what is left of the stresses over the linear ones. Means of both signs.
for nu in 0.75 0.68 0.705 0.81; do
  awk -F, -v out="$points/$nu" '
    NR == 1 {for (k = 1; k <= NF; ++k) c[$k] = k; next}
    function size(x) {return x < 0 ? -x : x}
    $c["amplitude"] == 0 {B = $c["B"]; G = $c["G_oct"]; next}
    {
      f = out "-" $c["file"]
      if ($c["amplitude"] > 0) {b = $c["B"]; g = $c["G_oct"]; bl = size($c["B_left"]); gl = size($c["G_oct_left"])
        n = $c["changed_by_volume"]; m = $c["changed_by_shear"]; nl = $c["left_by_volume"]; ml = $c["left_by_shear"]; next}
      printf "%g %.6f %.6f %g %g %g %g %.3g %.3g\n", -$c["amplitude"], (b + $c["B"]) / 2 / B, (g + $c["G_oct"]) / 2 / G,
        (n + $c["changed_by_volume"]) / 2, (m + $c["changed_by_shear"]) / 2, (nl + $c["left_by_volume"]) / 2,
        (ml + $c["left_by_shear"]) / 2, (bl + size($c["B_left"])) / 2 / B, (gl + size($c["G_oct_left"])) / 2 / G >f
    }' "data/bench/amplitude-9261/nu-$nu.csv"
  for state in 0 1; do
    echo "nu $nu, $([ $state = 0 ] && echo first || echo sheared): amplitude, B, G_oct, changed (volume, shear), still changed, B left, G_oct left"
    cat "$points/$nu-$state"
  done
done
gnuplot -e "points='$points'" docs/pictures/amplitude.gp >docs/pictures/amplitude.svg
