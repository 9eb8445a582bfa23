# Figure of shortest-curves.md; made by scripts/figures, which runs the plans first.
set datafile separator ","
set terminal pngcairo size 1000,640 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead
set output images . "/shortest_curves.png"
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left
set xrange [-6:44]
set yrange [-16:22]
plot runs . "/dubins/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacle", \
     runs . "/dubins/plan.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#1f77b4" title "dubins", \
     runs . "/reeds_shepp/plan.csv" using (column("direction") > 0 ? column("x_m") : NaN):"y_m" with lines lw 2 lc rgb "#ff7f0e" title "reeds\\_shepp, forwards", \
     runs . "/reeds_shepp/plan.csv" using (column("direction") < 0 ? column("x_m") : NaN):"y_m" with lines lw 2 dt 2 lc rgb "#d62728" title "reeds\\_shepp, backwards", \
     "-" using 1:2:(3*cos($3)):(3*sin($3)) with vectors lw 2 lc rgb "#333333" title "stops with headings"
x,y,yaw
0,0,0
30,10,1.2
20,-5,0
e
