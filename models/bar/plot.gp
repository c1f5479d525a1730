# Draws corner.svg and energy.svg from the tables of a run in the folder `dir`:
#   gnuplot -e "dir='out/bar'" plot.gp
set terminal svg size 760,420 enhanced font "Helvetica,13" background "white"
set datafile separator ","
set border 3 linecolor "#555555"
set tics nomirror textcolor "#333333"
set grid linecolor "#dddddd" linewidth 0.6
set xlabel "t [s]"
set style data lines
set style line 1 linewidth 1.8 linecolor "#1f5fa8"
set style line 2 linewidth 1.8 linecolor "#c8571b"
set style line 3 linewidth 1.8 linecolor "#3a8a4d"
set style line 4 linewidth 1.4 linecolor "#333333" dashtype 2

set output dir."/corner.svg"
set title "Displacement of the corner (0.1, 0.1, 0.6) m"
set ylabel "[m]"
set key outside right center
probes = dir."/probes.csv"
plot probes using 1:2 linestyle 1 title "u_x", \
     probes using 1:3 linestyle 2 title "u_y", \
     probes using 1:4 linestyle 3 title "u_z"

set output dir."/energy.svg"
set title "Where the work of the load went"
set ylabel "energy [J]"
energy = dir."/energy.csv"
plot energy using 1:"external_work" linestyle 4 title "work of the load", \
     energy using 1:"elastic" linestyle 1 title "elastic", \
     energy using 1:"kinetic" linestyle 2 title "kinetic", \
     energy using 1:"dissipated" linestyle 3 title "dissipated"
