#!/usr/bin/env bash
# Draws docs/pictures/moduli.png from data/moduli, with the fitted numbers of docs/moduli.md.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
fit='p0=0.0412; gamma_p=0.107; a_I=0.729; a_II=1.173; GB_max=0.511; Fv_min=4.47; Fv_alpha=1.44; g_I=124'
gnuplot -e "data='data/moduli'; $fit" docs/pictures/moduli.gp >docs/pictures/moduli.png
