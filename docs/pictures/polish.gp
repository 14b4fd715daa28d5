# What a fit of whole paths gains and loses. Wants dir (of the tables that polish.sh makes).
set encoding utf8
set terminal pngcairo size 1500,480 font "sans-serif,14" background "#ffffff" linewidth 1.4 enhanced
set multiplot
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set key noautotitle samplen 1.5 spacing 1.1
red = "#b2182b"; blue = "#2166ac"; orange = "#e08214"; grey = "#888888"

set lmargin at screen 0.055; set rmargin at screen 0.30; set tmargin at screen 0.88; set bmargin at screen 0.16
set title "fitted tests: stress against fabric"
set xlabel "misfit of P and σ_{dev}, in errors"
set ylabel "misfit of F_{dev}, in errors" offset 1
set logscale x
set xrange [0.8:10]
set yrange [1:8]
set xtics (1, 2, 3, 5, 7, 10)
set key top right
plot dir."/scatter-trade-off.dat" with linespoints pt 7 lc rgb blue title "errors: scatter of seeds", \
     dir."/size-trade-off.dat" with linespoints pt 5 lc rgb orange title "errors: 5 % of the size", \
     dir."/scatter-start.dat" with points pt 6 ps 1.6 lc rgb blue title "law by law", \
     dir."/size-start.dat" with points pt 4 ps 1.6 lc rgb orange

unset logscale x
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.85 border -1
set boxwidth 0.9
set xrange [-0.6:6.6]
set xtics rotate by 35 right scale 0 font ",11" autofreq
unset xlabel
set key top right
set yrange [0:*]
do for [i=1:3] {
  left = 0.365 + (i - 1) * 0.22
  set lmargin at screen left; set rmargin at screen left + 0.18; set bmargin at screen 0.27
  set title word("P σ_{dev} F_{dev}", i).", held out: relative error"
  unset ylabel
  if (i > 1) { unset key }
  plot dir."/held-".word("P sigma_dev F_dev", i).".dat" using 2:xtic(1) lc rgb grey title "law by law", \
       "" using 3 lc rgb blue title "polished, scatter", "" using 4 lc rgb orange title "polished, size"
}
unset multiplot
