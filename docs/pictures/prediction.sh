#!/usr/bin/env bash
# Draws docs/pictures/prediction.png from a finished quick campaign.
# Usage: docs/pictures/prediction.sh [DIR, default out/quick]
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
dir=${1:-out/quick}
curves=$(mktemp -d)
trap 'rm -rf "$curves"' EXIT
for test in d2-0.68-s1 d2-0.72-s1 d2-0.78-s1; do
  ./grainlaw predict "$dir/parameters.json" "$dir/records/$test" -o "$curves/$test.csv" 2>"$curves/$test.log"
done
gnuplot -e "dir='$dir'; curves='$curves'" docs/pictures/prediction.gp >docs/pictures/prediction.png
