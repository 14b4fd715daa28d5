# Three panels over the amplitude of a probe: secant moduli, contacts that changed, and what is left after the way back.
# Wants points (a folder of tables, see amplitude.sh).
set encoding utf8
set terminal svg size 1350,430 font "sans-serif,14" background "#ffffff" linewidth 1.2 enhanced
set multiplot layout 1,3 margins 0.06,0.985,0.17,0.9 spacing 0.085
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set style data linespoints
set pointsize 0.6
set key noautotitle samplen 1.5 spacing 1.1
set logscale x
set format x "10^{%L}"
set xrange [0.7e-7:1.4e-2]
set xlabel "amplitude of the strain"
red = "#b2182b"; blue = "#2166ac"
file(nu, state) = points . "/" . nu . "-" . state

set title "secant modulus over that of linear response"
set yrange [0:1.35]
set key bottom left Left reverse
plot file("0.75", 0) using 1:2 pt 7 lc rgb blue title "B, ν = 0.75", \
     file("0.75", 1) using 1:3 pt 7 lc rgb red title "G_{oct}, ν = 0.75, sheared", \
     file("0.75", 0) using 1:3 pt 6 lc rgb red title "the same, isotropic", \
     file("0.68", 1) using 1:3 pt 7 dt 2 lc rgb red title "G_{oct}, ν = 0.68, sheared", \
     file("0.68", 0) using 1:3 pt 6 dt 2 lc rgb red title "the same, isotropic"

set title "contacts opened or closed by shear"
set logscale y
set yrange [0.3:2e4]
set format y "10^{%L}"
set key top left
plot file("0.75", 1) using 1:5 pt 7 lc rgb red title "ν = 0.75, sheared", \
     file("0.75", 0) using 1:5 pt 6 lc rgb red title "isotropic", \
     file("0.68", 1) using 1:5 pt 7 dt 2 lc rgb red title "ν = 0.68, sheared", \
     file("0.68", 0) using 1:5 pt 6 dt 2 lc rgb red title "isotropic"

set title "share of the shear stress left after the way back"
set yrange [1e-6:2]
plot file("0.75", 1) using 1:9 pt 7 lc rgb red title "ν = 0.75, sheared", \
     file("0.75", 0) using 1:9 pt 6 lc rgb red title "isotropic", \
     file("0.68", 1) using 1:9 pt 7 dt 2 lc rgb red title "ν = 0.68, sheared", \
     file("0.68", 0) using 1:9 pt 6 dt 2 lc rgb red title "isotropic"
unset multiplot
