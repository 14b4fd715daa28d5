# Figs. 5.1, 5.6, 5.2 and 5.13 of the thesis from data/memory. Wants data, the folder of the tables, and the fitted
# numbers. Red: fits of docs/memory.md; dashed: the thesis.
set encoding utf8
set terminal pngcairo size 1300,900 font "sans-serif,14" background "#ffffff" linewidth 1.3 enhanced
set datafile separator comma
set datafile columnheaders
set multiplot layout 2,2 margins 0.075,0.985,0.08,0.975 spacing 0.09,0.11
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set pointsize 0.6
set key noautotitle samplen 1.2 spacing 1.05
amplitudes = "0.66 0.67 0.68 0.70 0.73 0.77 0.82 0.90"
colours = "#440154 #46327e #365c8d #277f8e #1fa187 #4ac16d #a0da39 #e08214"
n = words(amplitudes)
red = "#b2182b"
cycles = data . "/over_compression.csv"
shear = data . "/shear_jamming.csv"
# Eqs. 5.1 and 5.5.
share(M, m, b) = 1 - exp(-(M/m)**b)
J(phi, M, SJ, a, f, m, b) = phi > SJ ? SJ + a*(phi/SJ - 1)**f*share(M, m, b) : SJ
ours(phi, M) = J(phi, M, phi_SJ, alpha_max, alpha_phi, mu, beta)
theirs(phi, M) = J(phi, M, 0.6567, 0.02, 0.3, 1, 0.3)
at(phi, y) = abs(column("phi_max") - phi) < 1e-4 ? y : NaN

set logscale x; set xrange [0.9:70]; set yrange [0.651:0.671]
set xlabel "cycles M"; set ylabel "jamming density φ_J" offset 1,0
set key bottom right maxrows 4
plot for [i=1:n] cycles using "M":(at(word(amplitudes, i) + 0.0, column("phi_J"))) with points pt 7 lc rgb word(colours, i) \
       title "φ_{max} = " . word(amplitudes, i), \
     for [i=1:n] ours(word(amplitudes, i) + 0.0, x) lc rgb word(colours, i) lw 1.5

unset logscale x; set xrange [0.65:0.91]; set xtics 0.05
set xlabel "largest volume fraction φ_{max}"
set key bottom right maxrows 7
set samples 400
of(M, y) = column("M") == M ? y : NaN
plot cycles using "phi_max":(of(1, column("phi_J"))) with points pt 7 lc "#365c8d" title "M = 1", \
     cycles using "phi_max":(of(3, column("phi_J"))) with points pt 7 lc "#4ac16d" title "M = 3", \
     data . "/over_compression-base.csv" using "phi_max":(of(1, column("phi_J"))) with points pt 6 ps 1.2 lc "#365c8d" title "M = 1, N = 9261", \
     ours(x, 1) lc rgb "#365c8d" lw 2, ours(x, 3) lc rgb "#4ac16d" lw 2, ours(x, 1e12) lc rgb red lw 2 title "M → ∞", \
     theirs(x, 1) dt 2 lc "#365c8d", theirs(x, 3) dt 2 lc "#4ac16d", theirs(x, 1e12) dt 2 lc "black" title "thesis"

set xrange [0:1]; set yrange [0:0.3]; set xtics 0.2
set xlabel "(φ − φ_{SJ})/(φ_J − φ_{SJ})"; set ylabel "strain to jam ε_{SJ}"
set key top right maxrows 8
scaled(v, J0) = (v - phi_SJ)/(J0 - phi_SJ)
first(phi, y) = column("reversals") == 0 ? at(phi, y) : NaN
plot for [phi in "0.82"] shear using (scaled(column("nu"), column("phi_J0"))):(first(phi + 0.0, column("eps_contacts"))) \
       with points pt 7 ps 0.9 lc rgb (phi eq "0.68" ? "#440154" : phi eq "0.73" ? "#21918c" : "#e08214") title "C* ≥ 6, φ_{max} = " . phi, \
     shear using (scaled(column("nu"), column("phi_J0"))):(first(column("phi_max"), column("eps_pressure"))) \
       with points pt 1 ps 0.9 lc "#555555" title "P* ≥ 2·10^{−4}", \
     shear using (scaled(column("nu"), column("phi_J0"))):(first(column("phi_max"), column("eps_percolation"))) \
       with points pt 2 ps 0.9 lc "#888888" title "percolates first", \
     eps0*(-log(x))**(1/alpha) lc rgb red lw 2 title "fit", 0.102*(-log(x))**(1/1.37) dt 2 lc "black" title "thesis"

set xrange [0.654:0.665]; set yrange [0:0.45]; set xtics 0.002
set xlabel "volume fraction φ"; set ylabel "strain to jam again ε_{SJ,R}"
back(y) = column("reversals") == 1 && column("jammed_before") == 1 ? y : NaN
again(x) = x >= phi_cr ? 0 : eps0_R*(-log((x - phi_SJ)/(phi_cr - phi_SJ)))**(1/alpha)
plot for [phi in "0.82"] shear using "nu":(back(at(phi + 0.0, column("eps_contacts")))) \
       with points pt 7 ps 0.9 lc rgb (phi eq "0.68" ? "#440154" : phi eq "0.73" ? "#21918c" : "#e08214") title "φ_{max} = " . phi, \
     again(x) lc rgb red lw 2 title "fit"
unset multiplot
