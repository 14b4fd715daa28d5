# Figs. 5.1, 5.6, 5.2, 5.13, 5.7 and 5.12 of the thesis, and tapping, from data/memory. Wants data, the folder of the
# tables, and the fitted numbers. Red: fits of docs/memory.md; dashed: the thesis.
set encoding utf8
set terminal pngcairo size 1650,1350 font "sans-serif,14" background "#ffffff" linewidth 1.3 enhanced
set datafile separator comma
set datafile columnheaders
set multiplot layout 3,3 margins 0.052,0.99,0.05,0.985 spacing 0.068,0.075
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set pointsize 0.6
set key noautotitle samplen 1.2 spacing 1.05
amplitudes = "0.66 0.67 0.68 0.70 0.73 0.77 0.82 0.90"
colours = "#440154 #46327e #365c8d #277f8e #1fa187 #4ac16d #a0da39 #e08214"
n = words(amplitudes)
red = "#b2182b"; blue = "#365c8d"; green = "#4ac16d"; orange = "#e08214"; violet = "#440154"; teal = "#21918c"
cycles = data . "/over_compression.csv"
shear = data . "/shear_jamming.csv"
# Eqs. 5.1 and 5.5.
share(M, m, b) = 1 - exp(-(M/m)**b)
J(phi, M, SJ, a, f, m, b) = phi > SJ ? SJ + a*(phi/SJ - 1)**f*share(M, m, b) : SJ
ours(phi, M) = J(phi, M, phi_SJ, alpha_max, alpha_phi, mu, beta)
theirs(phi, M) = J(phi, M, 0.6567, 0.02, 0.3, 1, 0.3)
at(phi, y) = abs(column("phi_max") - phi) < 1e-4 ? y : NaN
of(M, y) = column("M") == M ? y : NaN

set label 1 "N = 1000" at graph 0.02,0.96
set logscale x; set xrange [0.9:330]; set yrange [0.65:0.672]
set xlabel "cycles M"; set ylabel "jamming density φ_J" offset 1,0
set key inside bottom right maxrows 4
plot for [i=1:n] cycles using "M":(at(word(amplitudes, i) + 0.0, column("phi_J"))) with points pt 7 ps 0.4 lc rgb word(colours, i) \
       title "φ_{max} = " . word(amplitudes, i), \
     for [i=1:n] ours(word(amplitudes, i) + 0.0, x) lc rgb word(colours, i) lw 1.5

set label 1 "N = 9261"
set xrange [0.9:60]; set yrange [0.656:0.6695]
set key inside bottom right maxrows 4
large = data . "/over_compression-9261.csv"
plot large using "M":(at(0.82, column("phi_J"))) with linespoints pt 7 lc rgb "#a0da39" title "φ_{max} = 0.82", \
     for [seed=1:2] large using "M":(column("seed") == seed ? at(0.68, column("phi_J")) : NaN) with linespoints pt 7 lc rgb blue title (seed == 1 ? "0.68, two packings" : ""), \
     ours(0.82, x) lc rgb red title "law", ours(0.68, x) lc rgb red, \
     theirs(0.82, x) dt 2 lc "black" title "thesis", theirs(0.68, x) dt 2 lc "black"

unset label 1
unset logscale x; set xrange [0.65:0.91]; set xtics 0.05; set yrange [0.654:0.672]
set xlabel "largest volume fraction φ_{max}"
set key inside bottom right maxrows 8
set samples 400
plot cycles using "phi_max":(of(1, column("phi_J"))) with points pt 7 lc rgb blue title "M = 1", \
     cycles using "phi_max":(of(50, column("phi_J"))) with points pt 7 lc rgb green title "M = 50", \
     data . "/over_compression-base.csv" using "phi_max":(of(1, column("phi_J"))) with points pt 6 ps 1.2 lc rgb blue title "M = 1, N = 9261", \
     ours(x, 1) lc rgb blue lw 2, ours(x, 50) lc rgb green lw 2, ours(x, 1e12) lc rgb red lw 2 title "M → ∞", \
     theirs(x, 1) dt 2 lc rgb blue, theirs(x, 50) dt 2 lc rgb green, theirs(x, 1e12) dt 2 lc "black" title "thesis"

colour_of(phi) = phi eq "0.68" ? violet : phi eq "0.73" ? teal : orange
set xrange [0:1]; set yrange [0:0.3]; set xtics 0.2
set xlabel "(φ − φ_{SJ})/(φ_J − φ_{SJ})"; set ylabel "strain to jam ε_{SJ}"
set key inside top right maxrows 8
scaled(v, J0) = (v - phi_SJ)/(J0 - phi_SJ)
first(phi, y) = column("reversals") == 0 ? at(phi, y) : NaN
plot for [phi in "0.82 0.73 0.68"] shear using (scaled(column("nu"), column("phi_J0"))):(first(phi + 0.0, column("eps_contacts"))) \
       with points pt 7 ps 0.9 lc rgb colour_of(phi) title "C* ≥ 6, φ_{max} = " . phi, \
     shear using (scaled(column("nu"), column("phi_J0"))):(first(column("phi_max"), column("eps_pressure"))) \
       with points pt 1 ps 0.9 lc "#555555" title "P* ≥ 2·10^{−4}", \
     shear using (scaled(column("nu"), column("phi_J0"))):(first(column("phi_max"), column("eps_percolation"))) \
       with points pt 2 ps 0.9 lc "#888888" title "percolates first", \
     eps0*(-log(x))**(1/alpha) lc rgb red lw 2 title "fit", 0.102*(-log(x))**(1/1.37) dt 2 lc "black" title "thesis"

set xrange [0.654:0.665]; set yrange [0:0.45]; set xtics 0.002
set xlabel "volume fraction φ"; set ylabel "strain to jam again ε_{SJ,R}"
set key inside top right maxrows 8
back(y) = column("reversals") > 0 && column("jammed_before") == 1 ? y : NaN
again(x) = x >= phi_cr ? 0 : eps0_R*(-log((x - phi_SJ)/(phi_cr - phi_SJ)))**(1/alpha)
plot for [phi in "0.82 0.73 0.68"] shear using "nu":(back(at(phi + 0.0, column("eps_contacts")))) \
       with points pt 7 ps 0.9 lc rgb colour_of(phi) title "φ_{max} = " . phi, \
     again(x) lc rgb red lw 2 title "fit"

relaxed = data . "/relaxed.csv"
pushes = 2e-4
unjammed(y) = column("P_flow") < pushes && column("P") < pushes ? y : NaN
fragile(y) = column("P_flow") >= pushes && column("P") < pushes ? y : NaN
jammed(y) = column("P") >= pushes ? y : NaN
set xrange [0.654:0.669]; set yrange [0:0.52]; set xtics 0.004
set xlabel "volume fraction φ"; set ylabel "strain ε_{dev} of first shear"
set key inside top right maxrows 8
line(phi, SJ, J0, a, e) = phi > SJ && phi < J0 ? e*(-log((phi - SJ)/(J0 - SJ)))**(1/a) : NaN
plot relaxed using "nu":(unjammed(column("eps_dev"))) with points pt 6 ps 1.1 lc rgb blue title "pushes neither in flow nor at rest", \
     relaxed using "nu":(fragile(column("eps_dev"))) with points pt 8 ps 1.2 lc rgb orange title "in flow only (fragile)", \
     relaxed using "nu":(jammed(column("eps_dev"))) with points pt 7 ps 0.9 lc rgb "#222222" title "at rest (jammed)", \
     line(x, phi_SJ, 0.6649, alpha, eps0) lc rgb red lw 2 title "Eq. 5.2", line(x, 0.6567, 0.6652, 1.37, 0.102) dt 2 lc "black" title "thesis"

set xrange [0.655:0.678]; set yrange [0:17]; set xtics 0.005
set xlabel "volume fraction φ"; set ylabel "10^4 × stress at rest/(φC)" offset 0,0
set key inside top left maxrows 8
steady(y) = column("eps_dev") > 0.18 && column("P") >= pushes ? y*1e4/(column("nu")*column("C")) : NaN
flow(phi, SJ, p0) = phi > SJ ? 1e4*p0/SJ*log(phi/SJ) : NaN
plot relaxed using "nu":(steady(column("P"))) with points pt 7 ps 0.9 lc rgb blue title "P*", \
     relaxed using "nu":(steady(abs(column("s_dev"))*column("P"))) with points pt 7 ps 0.9 lc rgb green title "σ*_{dev}", \
     flow(x, phi_rest, p0_rest) lc rgb blue lw 1.5, flow(x, phi_tau, p0_tau) lc rgb green lw 1.5

set xtics auto; set ylabel "jamming density φ_J" offset 1,0
set logscale x; set xrange [400:25000]; set xtics auto; set yrange [0.657:0.668]
set xlabel "number of grains N"
set key inside bottom right maxrows 8
sizes = "500 1000 2000 4000 20000"
plot for [i=1:words(sizes)] data . "/over_compression-N" . word(sizes, i) . ".csv" using (word(sizes, i) + 0.0):"phi_J" with points pt 7 ps 0.8 lc rgb blue title (i == 1 ? "one cycle to 0.82" : ""), \
     data . "/over_compression-base.csv" using (9261):"phi_J" with points pt 6 ps 1 lc rgb blue title "the same at a third of the rate", \
     data . "/over_compression-prepared-slowly.csv" using (1200):"phi_J" with points pt 2 ps 0.8 lc rgb orange title "prepared 10 times slower", \
     data . "/over_compression-prepared-fast.csv" using (1350):"phi_J" with points pt 1 ps 0.8 lc rgb teal title "5 times faster", \
     0.6652 dt 2 lc "black" title "thesis"
unset logscale x

set xrange [-0.004:0.155]; set yrange [0.655:0.6695]; set xtics 0.05
set xlabel "amplitude of shear at φ = 0.68"; set ylabel "jamming density φ_J" offset 1,0
set key inside bottom left maxrows 8
set label 2 "one way, to 0.3" at 0.151,0.6592 right
tapped = data . "/tapped.csv"; untapped = data . "/over_compression-untapped.csv"
last(y) = (abs(column("amplitude") - 0.005) < 1e-6 && column("strain") < 0.15) || (abs(column("amplitude") - 0.005) > 1e-6 && abs(column("amplitude") - 0.15) > 1e-6 && column("strain") < 0.7) ? NaN : y
once(phi, y) = abs(column("phi_max") - phi) < 1e-4 && column("M") == (phi < 0.7 ? 1 : 3) ? y : NaN
plot untapped using (0):(once(0.68, column("phi_J"))) with points pt 6 ps 1 lc rgb violet, \
     untapped using (0):(once(0.82, column("phi_J"))) with points pt 6 ps 1 lc rgb orange, \
     tapped using "amplitude":(last(at(0.68, column("phi_J")))) with points pt 7 ps 0.9 lc rgb violet title "after one compression to 0.68", \
     tapped using "amplitude":(last(at(0.82, column("phi_J")))) with points pt 7 ps 0.9 lc rgb orange title "after three to 0.82"
unset multiplot
