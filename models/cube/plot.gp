# Draws pressure.svg and shear.svg (figures 3 and 4) from compare.csv of a run in the folder `dir`:
#   gnuplot -e "dir='out/cube'" plot.gp
set terminal svg size 760,420 enhanced font "Helvetica,13" background "white"
set datafile separator ","
set border 3 linecolor "#555555"
set tics nomirror textcolor "#333333"
set grid linecolor "#cccccc" linewidth 0.6 dashtype 3
set xlabel "t [s]"
set xrange [10:30]
set style data lines
set style line 1 linewidth 1.8 linecolor "#8a4fa8"
set style line 2 linewidth 1.8 linecolor "#3a8a4d"
set style line 3 linewidth 1.8 linecolor "#1f5fa8"
set style line 4 linewidth 1.2 linecolor "#c0392b"
set key outside bottom center horizontal
compared = dir."/compare.csv"
set arrow 1 from 20, graph 0 to 20, graph 1 nohead linecolor "#999999" dashtype 2
set label 1 "sheared" at 15, graph 0.96 center textcolor "#777777"
set label 2 "second turn" at 25, graph 0.96 center textcolor "#777777"

do for [part in "pressure shear"] {
  set output dir."/".part.".svg"
  set title sprintf("Force of each measure against Green's on the same states: %s", part)
  set ylabel sprintf("|f - f^G| / |f^G|, %s", part)
  set yrange [0:part eq "pressure" ? 0.35 : 0.08]
  plot compared using 1:"warp.".part linestyle 1 title "warp", \
       compared using 1:"polar.".part linestyle 2 title "polar", \
       compared using 1:"hybrid.".part linestyle 3 title "hybrid", \
       compared using 1:($1 <= 20 ? column("cauchy.".part) : NaN) linestyle 4 \
         title "cauchy (until it turns)"
}
