# Fig. 5.4 of the thesis by the minimal model, and two tests of grains beside three forms of the law. Wants
# curves, the folder of predictions, and records.
set encoding utf8
set terminal pngcairo size 1300,900 font "sans-serif,14" background "#ffffff" linewidth 1.3 enhanced
set datafile separator comma
set datafile columnheaders
set multiplot layout 2,2 margins 0.085,0.9,0.08,0.95 spacing 0.15,0.14
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set pointsize 0.5
set style data lines
set key noautotitle samplen 1.5 spacing 1.1
red = "#b2182b"; blue = "#2166ac"; orange = "#e08214"; green = "#1b7837"
curve(name) = curves . "/" . name . ".csv"

set title "minimal, thesis: compression to 0.73, M = 1 and 300"
set xlabel "volume fraction ν"; set ylabel "pressure P*" offset 2,0
set key top left reverse Left
set xrange [0.65:0.73]; set xtics 0.02
last(y) = column("segment") >= 598 ? y : NaN
plot curve("iso-1") using "nu":"P" lw 2 lc rgb red title "M = 1", \
     curve("iso-300") using "nu":(last(column("P"))) lw 2 lc rgb blue title "M = 300"

set title "minimal, thesis: D2 at 0.6584, φ_J(0) = 0.6652"
set xlabel "deviatoric strain along the path"; set ylabel "s_{dev}, F_{dev}"; set y2label "jamming density φ_J" offset -1,0
set y2tics 0.002; set ytics nomirror
set xrange [0:2.1]; set xtics 0.5; set yrange [-0.3:0.3]; set y2range [0.655:0.667]
set key top right horizontal
legs(s, e) = s == 0 ? e : 0.28 + (s - 1)*0.44 + (int(s) % 2 ? 0.28 - e : e + 0.16)
plot curve("shear") using (legs(column("segment"), column("eps_dev"))):(column("P") > 0 ? column("s_dev") : NaN) lw 2 lc rgb red title "s_{dev}", \
     curve("shear") using (legs(column("segment"), column("eps_dev"))):"F_dev" lw 2 lc rgb blue title "F_{dev}", \
     curve("shear") using (legs(column("segment"), column("eps_dev"))):"phi_J" axes x1y2 lw 2 lc rgb green title "φ_J"
unset y2label; unset y2tics; set autoscale y

set title "first compression of grains (dots) and back"
set xlabel "volume fraction ν"; set ylabel "pressure P*"
set key top left reverse Left
set xrange [0.65:0.75]; set xtics 0.02; set yrange [0:0.06]
plot records . "/iso-s1/record.csv" using "nu":"P" with points pt 7 lc rgb "#777777", \
     curve("oc-coupled") using "nu":"P" lw 2 lc rgb orange title "coupled", \
     curve("oc-memory") using "nu":"P" lw 3 lc rgb green title "memory", \
     curve("oc-minimal") using "nu":"P" dt 2 lw 2 lc rgb blue title "minimal"

set title "D2 of grains (dots) between ±0.4 at ν = 0.685"
set xlabel "deviatoric strain along the path"; set ylabel "pressure P*"
set key bottom right
set xrange [0:2]; set xtics 0.5; set yrange [0:0.016]
way(s, e) = s == 0 ? e : s == 1 ? 0.8 - e : 1.6 + e
plot records . "/d2-cycle-0.685-s1/record.csv" using (way(column("segment"), column("eps_dev"))):"P" with points pt 7 lc rgb "#777777", \
     curve("d2-coupled") using (way(column("segment"), column("eps_dev"))):"P" lw 2 lc rgb orange title "coupled", \
     curve("d2-memory") using (way(column("segment"), column("eps_dev"))):"P" lw 2 lc rgb green title "memory", \
     curve("d2-minimal") using (way(column("segment"), column("eps_dev"))):"P" dt 2 lw 2 lc rgb blue title "minimal"
