#!/usr/bin/env bash
# Draws docs/pictures/moduli.png from data/moduli, with the fitted numbers of docs/moduli.md.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
fit='p0=0.0412; gamma_p=0.104; a_I=0.727; a_II=1.174; GB_max=0.518; Fv_min=4.44; Fv_alpha=1.51; g_I=128'
gnuplot -e "data='data/moduli'; $fit" docs/pictures/moduli.gp >docs/pictures/moduli.png
