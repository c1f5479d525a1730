# Draws corner.svg and energy.svg from the tables of a run in the folder `dir`:
#   gnuplot -e "dir='out/bar'" plot.gp
set terminal svg size 760,420 enhanced font "Helvetica,13" background "white"
set datafile separator ","
set border 3 linecolor "#555555"
set tics nomirror textcolor "#333333"
set grid linecolor "#cccccc" linewidth 0.6 dashtype 3
set xlabel "t [s]"
set style data lines
set style line 1 linewidth 1.8 linecolor "#1f5fa8"
set style line 2 linewidth 1.8 linecolor "#c8571b"
set style line 3 linewidth 1.8 linecolor "#3a8a4d"
set style line 4 linewidth 1.2 linecolor "#888888"

probes = dir."/probes.csv"
set output dir."/corner.svg"
set title "Displacement of the corner (0.1, 0.1, 0.6) m"
set ylabel "[m]"
set key right center
plot probes using 1:2 linestyle 1 title "u_x", \
     probes using 1:3 linestyle 2 title "u_y", \
     probes using 1:4 linestyle 3 title "u_z"

energy = dir."/energy.csv"
set output dir."/energy.svg"
set title "Where the work of the load went"
set ylabel "energy [J]"
set logscale y
set format y "10^{%T}"
set yrange [1e-8:1]
set key outside bottom center horizontal
plot energy using 1:"elastic" linestyle 1 title "elastic", \
     energy using 1:"kinetic" linestyle 2 title "kinetic", \
     energy using 1:"dissipated" linestyle 3 title "dissipated", \
     energy using 1:(abs(column("balance"))) linestyle 4 title "error of the balance"
