#!/usr/bin/env bash
# Draws docs/pictures/polish.png from data/records/base: fits them, polishes with both weightings.
# Usage: docs/pictures/polish.sh [DIR with fitted.json, scatter.json and size.json (accounts), made if missing]
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
dir=${1:-$(mktemp -d)}
[ -e "$dir/fitted.json" ] || ./grainlaw fit data/records/base -o "$dir/fitted.json" >/dev/null
for weights in scatter size; do
  [ -e "$dir/$weights.json" ] || ./grainlaw polish "$dir/fitted.json" data/records/base --weights $weights \
    -o "$dir/polished-$weights.json" --account "$dir/$weights.json" >/dev/null
done
python3 - "$dir" <<'PYTHON'
import json, sys
from collections import defaultdict
dir = sys.argv[1]
errors = defaultdict(dict)
for weights in ("scatter", "size"):
    account = json.load(open(f"{dir}/{weights}.json"))
    with open(f"{dir}/{weights}-trade-off.dat", "w") as out:
        for point in account["trade_off"]:
            print(point["stress"], point["fabric"], point["part_of_fabric"], file=out)
    with open(f"{dir}/{weights}-start.dat", "w") as out:
        print(account["misfit_before"]["stress"], account["misfit_before"]["fabric"], file=out)
    sums = defaultdict(list)
    for entry in account["held_out"]:
        for column, error in entry["errors"].items():
            sums[entry["test"], column].append((error["before"], error["after"]))
    for key, pairs in sums.items():
        errors[key]["before"] = sum(p[0] for p in pairs) / len(pairs)
        errors[key][weights] = sum(p[1] for p in pairs) / len(pairs)
for column in ("P", "sigma_dev", "F_dev"):
    with open(f"{dir}/held-{column}.dat", "w") as out:
        for test, of in sorted(errors):
            if of == column:
                e = errors[test, of]
                print(test, e["before"], e["scatter"], e["size"], file=out)
PYTHON
gnuplot -e "dir='$dir'" docs/pictures/polish.gp >docs/pictures/polish.png
