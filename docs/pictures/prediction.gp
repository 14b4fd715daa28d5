# Three panels for the README: what the law is fitted to, and two tests that it predicts.
# Wants dir (of a finished quick campaign) and curves (of predictions along fitted tests).
set encoding utf8
set terminal pngcairo size 1500,480 font "sans-serif,15" background "#ffffff" linewidth 1.4 enhanced
set datafile separator comma
set datafile columnheaders
set multiplot layout 1,3 margins 0.065,0.985,0.17,0.88 spacing 0.085
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set style data lines
set pointsize 0.5
set key noautotitle samplen 1.5 spacing 1.1
record(test) = dir . "/records/" . test . "/record.csv"
law(test) = dir . "/predictions/" . test . ".coupled.csv"
fitted(test) = curves . "/" . test . ".csv"
red = "#b2182b"; blue = "#2166ac"; orange = "#e08214"

set title "fitted: plane shear D2 (three of seven)"
set xlabel "deviatoric strain ε_{dev}"
set ylabel "shear stress ratio s_{dev}"
set key bottom right
set xtics 0.1
set yrange [-0.05:0.3]
plot for [i=1:3] record(word("d2-0.68-s1 d2-0.72-s1 d2-0.78-s1", i)) using "eps_dev":"s_dev" \
       with points pt 7 lc rgb word(red." ".orange." ".blue, i), \
     for [i=1:3] fitted(word("d2-0.68-s1 d2-0.72-s1 d2-0.78-s1", i)) using "eps_dev":"s_dev" \
       lw 2 lc rgb word(red." ".orange." ".blue, i) title "ν = ".word("0.68 0.72 0.78", i)

set title "predicted: uniaxial, from ν = 0.695"
set xlabel "volumetric strain ε_{vol}"
set ylabel "stress, in units of k/(2⟨r⟩)"
set key top left reverse Left
set xtics 0.04
set yrange [0:0.12]
plot record("uni-0.695-s1") using "eps_vol":"P" with points pt 7 lc rgb blue, \
     record("uni-0.695-s1") using "eps_vol":"sigma_dev" with points pt 7 lc rgb red, \
     law("uni-0.695-s1") using "eps_vol":"P" lw 2 lc rgb blue title "pressure P*", \
     law("uni-0.695-s1") using "eps_vol":"sigma_dev" lw 2 lc rgb red title "deviatoric stress"

set title "predicted: D2 reversed, ν = 0.711"
set xlabel "deviatoric strain ε_{dev}"
set ylabel "deviatoric stress and fabric"
set key at graph 0.55,0.56
set xtics 0.2
set yrange [-0.3:0.3]
plot record("d2-cycle-s1") using "eps_dev":"s_dev" with points pt 7 lc rgb red, \
     record("d2-cycle-s1") using "eps_dev":"F_dev" with points pt 7 lc rgb blue, \
     law("d2-cycle-s1") using "eps_dev":"s_dev" lw 2 lc rgb red title "s_{dev}", \
     law("d2-cycle-s1") using "eps_dev":"F_dev" lw 2 lc rgb blue title "F_{dev}"
unset multiplot
