#!/usr/bin/env bash
# Draws docs/pictures/memory.png from data/memory, with the fitted numbers of docs/memory.md.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
fit='phi_SJ=0.6567; alpha_max=0.0206; alpha_phi=0.395; mu=1; beta=0.384; alpha=2.09; eps0=0.114; eps0_R=0.231; phi_cr=0.6621'
gnuplot -e "data='data/memory'; $fit" docs/pictures/memory.gp >docs/pictures/memory.png
