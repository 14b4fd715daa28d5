#!/usr/bin/env bash
# Draws docs/pictures/memory.png from data/memory, with the fitted numbers of docs/memory.md.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
fit='phi_SJ=0.6572; alpha_max=0.0211; alpha_phi=0.422; mu=1.78; beta=0.377; alpha=1.516; eps0=0.1133; eps0_R=0.1998; phi_cr=0.6629'
# Relaxed steady states: where their stresses vanish, and the slopes there.
rest='phi_rest=0.6572; p0_rest=0.0342; phi_tau=0.6569; p0_tau=0.0054'
gnuplot -e "data='data/memory'; $fit; $rest" docs/pictures/memory.gp >docs/pictures/memory.png
