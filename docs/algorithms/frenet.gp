# The figure of frenet.md; made by scripts/figures, which runs the drives first.
set datafile separator ","
set terminal pngcairo size 1000,560 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left

set output images . "/frenet_slalom.png"
set xrange [30:190]
set yrange [-8:76]
plot runs . "/slalom_road/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/slalom_road/plan.csv" using "x_m":"y_m" with lines lw 1 dt 3 lc rgb "#555555" title "route", \
     runs . "/slalom_road/motions.csv" using 1:2 with lines lw 1 lc rgb "#9ecae1" title "motions, one every half second", \
     runs . "/slalom_road/mujoco.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#2ca02c" title "driven, MuJoCo"
