# Figures of replanning.md; made by scripts/figures, which runs the drives first.
set datafile separator ","
set terminal pngcairo size 1000,430 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left

set output images . "/replanning.png"
set xrange [-5:115]
set yrange [-12:24]
plot runs . "/blocked_road/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/blocked_road/plan.csv" using "x_m":"y_m" with lines lw 1 dt 3 lc rgb "#555555" title "route", \
     runs . "/blocked_road/motions.csv" using 1:2 with lines lw 2 lc rgb "#1f77b4" title "plans taken up", \
     runs . "/blocked_road/mujoco.csv" using "x_m":"y_m" with lines lw 1 dt 2 lc rgb "#2ca02c" title "driven, MuJoCo"

set terminal pngcairo size 1000,680 font "sans,11" background "white"
set output images . "/grand_tour.png"
set xrange [-110:150]
set yrange [-12:145]
plot runs . "/grand_tour/boxes.csv" using 1:2 with filledcurves lc rgb "#d62728" title "obstacles", \
     runs . "/grand_tour/plan.csv" using "x_m":"y_m" with lines lw 1 dt 3 lc rgb "#555555" title "route", \
     runs . "/grand_tour/motions.csv" using 1:2 with lines lw 1 lc rgb "#9ecae1" title "plans taken up", \
     runs . "/grand_tour/mujoco.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#2ca02c" title "driven, MuJoCo"
