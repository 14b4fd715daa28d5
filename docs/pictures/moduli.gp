# Figs. 4.10 to 4.13 of the thesis from data/moduli, and the law with the prestress taken out.
# Wants data, the folder of the tables. Lines: fits of docs/moduli.md (red), the thesis's Table 4.1 (dashed).
set encoding utf8
set terminal pngcairo size 1500,900 font "sans-serif,14" background "#ffffff" linewidth 1.3 enhanced
set datafile separator comma
set datafile columnheaders
set multiplot layout 2,3 margins 0.065,0.985,0.085,0.97 spacing 0.078,0.12
set border 3 lc "#444444"
set tics nomirror textcolor "#222222"
set pointsize 0.5
set key noautotitle samplen 1.2 spacing 1.05
nus = "0.68 0.705 0.725 0.75 0.81"
colours = "#440154 #3b528b #21918c #5ec962 #e08214"
tables = system("ls " . data . "/d2-*.csv")
n = words(tables)
red = "#b2182b"
nu_of(k) = system(sprintf("basename %s | cut -d- -f2", word(tables, k)))
place(k) = (sum [i=1:words(nus)] (word(nus, i) eq nu_of(k) ? i : 0))
colour(k) = word(colours, int(place(k)))
# Only rows of linear response.
only(x) = column("amplitude") == 0 ? x : NaN
# Without prestress: derivatives of the energy.
B0(x) = (column("E_xx_xx") + column("E_yy_yy") + column("E_zz_zz") + 2*(column("E_xx_yy") + column("E_xx_zz") + column("E_yy_zz")))/9
A0(x) = (column("E_yy_yy") - column("E_xx_xx") + column("E_yy_zz") - column("E_xx_zz"))/(3*sqrt(3))
# Means over the states before shear, of one table.
stat(name, what) = system(sprintf("awk -F, -v want=%s 'NR==1{for(i=1;i<=NF;i++)c[$i]=i} NR>1&&$c[\"amplitude\"]==0&&$c[\"eps_dev\"]<=0.008{n++;f+=$c[\"F_v\"];g+=$c[\"G_oct\"]/$c[\"B\"]} END{print (want==\"F\"?f:g)/n}' '%s'", what, name)) + 0.0

# Eq. 4.11 with the contacts of Table 2.1, D2.
excess(v) = v/0.6601 - 1
contacts(v) = 6 + 7.9219*excess(v)**0.5769
bearing(v) = 1 - 0.1363*exp(-15.001*excess(v))
F_v(v) = 1.22475*v*contacts(v)*bearing(v)
slope(v) = 1 + v*(7.9219*0.5769/0.6601*excess(v)**(0.5769 - 1)/contacts(v) + 15.001/0.6601*(1 - bearing(v))/bearing(v))
bulk(v, p0, gamma, nu_c) = (e = log(v/nu_c), p0*F_v(v)/(1.22475*nu_c)*(1 - 2*gamma*e + e*(1 - gamma*e)*slope(v)))

set xlabel "isotropic fabric F_v"; set ylabel "bulk modulus B/k*" offset 1,0
set key top left reverse Left
plot sample [v=0.675:0.815] "+" using (F_v($1)):(bulk($1, p0, gamma_p, 0.6581)) with lines lc rgb red lw 2 title "Eq. 4.11, fit", \
     [v=0.675:0.815] "+" using (F_v($1)):(bulk($1, 0.0425, 0.2, 0.658)) with lines dt 2 lc "black" title "thesis", \
     for [k=1:n] word(tables, k) using (only(column("F_v"))):"B" with points pt 7 lc rgb colour(k) \
       title (k == 1 || nu_of(k) ne nu_of(k - 1) ? "ν = ".nu_of(k) : "")

set xlabel "deviatoric fabric F_{dev}"; set ylabel "A_1/B"
set xrange [-0.01:0.18]; set xtics 0.04
plot for [k=1:n] word(tables, k) using (only(column("F_dev"))):(column("A1")/column("B")) with points pt 7 lc rgb colour(k), \
     a_I*x lc rgb red lw 2 title sprintf("%.3f F_{dev}", a_I), 0.66*x dt 2 lc "black" title "0.66 F_{dev}, thesis"

set ylabel "A_2/B"
plot for [k=1:n] word(tables, k) using (only(column("F_dev"))):(column("A2")/column("B")) with points pt 7 lc rgb colour(k), \
     a_II*x lc rgb red lw 2 title sprintf("%.3f F_{dev}", a_II), 1.0*x dt 2 lc "black" title "F_{dev}, thesis"

set xlabel "isotropic fabric F_v"; set ylabel "(G/B)_{ini}"
set xrange [4:10]; set xtics 1; set yrange [0:0.6]
set key bottom right noreverse Right
set samples 200
plot for [k=1:n] "+" using (stat(word(tables, k), "F")):(stat(word(tables, k), "G")) every ::0::0 with points pt 7 ps 1 lc rgb colour(k), \
     GB_max*(1 - exp(-(x - Fv_min)/Fv_alpha)) lc rgb red lw 2 title "fit", \
     0.51*(1 - exp(-(x - 4.2)/1.9)) dt 2 lc "black" title "thesis"

set xlabel "σ*_{dev} F_{dev} · 10^4"; set ylabel "G/B − (G/B)_{ini}"
set xrange [-0.5:10]; set xtics 2; set yrange [-0.15:0.1]
set key bottom left reverse Left
do for [k=1:n] { eval sprintf("ini_%d = stat(word(tables, k), 'G')", k) }
ini(k) = value(sprintf("ini_%d", k))
plot for [k=1:n] word(tables, k) using (only(1e4*column("sigma_dev")*column("F_dev"))):(column("G_oct")/column("B") - ini(k)) with points pt 7 lc rgb colour(k), \
     -g_I*x*1e-4 lc rgb red lw 2 title sprintf("−%.0f σ*_{dev} F_{dev}", g_I), -86*x*1e-4 dt 2 lc "black" title "−86 σ*_{dev} F_{dev}, thesis"

set xlabel "3.52 F_{dev}/F_v + 0.158 s_{dev}"; set ylabel "A_1/B = ⅔ A_2/B, prestress taken out"
set xrange [-0.01:0.14]; set xtics 0.04; set yrange [-0.02:0.16]
set key top left reverse Left
plot for [k=1:n] word(tables, k) using (only(3.52*column("F_dev")/column("F_v") + 0.158*column("sigma_dev")/column("P"))):(A0(0)/B0(0)) with points pt 7 lc rgb colour(k), \
     x lc rgb red lw 2 title "equal"
unset multiplot
