# Draws shearing.svg and rotating.svg (figures 5 and 6) from the tables of errors in the folder `dir`:
#   gnuplot -e "dir='out/bar/figures-bdf2'" errors.gp
set terminal svg size 760,760 enhanced font "Helvetica,13" background "white"
set datafile separator ","
set border 3 linecolor "#555555"
set tics nomirror textcolor "#333333"
set grid linecolor "#cccccc" linewidth 0.6 dashtype 3
set xrange [0:40]
set style data lines
set style line 1 linewidth 1.6 linecolor "#8a4fa8"
set style line 2 linewidth 1.6 linecolor "#3a8a4d"
set style line 3 linewidth 1.6 linecolor "#1f5fa8"
set ylabel "|u_z - u_z^G| / |u_z^G|"
set format y "%g %%"

n = 2 # of how many outputs one is drawn
set macros
CURVES = 'every n using 1:(100 * column("warp.z")) linestyle 1 title "warp", \
  "" every n using 1:(100 * column("polar.z")) linestyle 2 title "polar", \
  "" every n using 1:(100 * column("hybrid.z")) linestyle 3 title "hybrid"'

set output dir."/shearing.svg"
set multiplot layout 3,1
set yrange [0:16]
set title "Steps of 20 ms, frames held 20 ms"
plot dir."/shear-20.csv" @CURVES
set title "Steps of 20 ms, frames held 200 ms"
plot dir."/shear-200.csv" @CURVES
set title "Error control, exact frames"
set xlabel "t [s]"
plot dir."/shear-exact.csv" @CURVES
unset multiplot

n = 1
set terminal svg size 760,520
set output dir."/rotating.svg"
set multiplot layout 2,1
unset xlabel
set yrange [0:40]
set title "Turned once in 10 s; steps of 60 ms, frames held 300 ms"
plot dir."/turn-300.csv" @CURVES
set title "Turned once in 10 s; error control, exact frames"
set xlabel "t [s]"
plot dir."/turn-exact.csv" @CURVES
unset multiplot
