#!/usr/bin/env bash
# Draws docs/pictures/moduli.png from data/moduli, with the fitted numbers of docs/moduli.md.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
fit='p0=0.0412; gamma_p=0.105; a_I=0.727; a_II=1.173; GB_max=0.519; Fv_min=4.38; Fv_alpha=1.56; g_I=129'
gnuplot -e "data='data/moduli'; $fit" docs/pictures/moduli.gp >docs/pictures/moduli.png
