# Figures of rrt.md; made by scripts/figures, which runs the plans and drives first.
set datafile separator ","
set terminal pngcairo size 1000,640 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left

set xrange [-6:66]
set yrange [-30:36]
set key bottom right
set object 1 rectangle from 0,19 to 60,33 fc rgb "#eaf3fb" fs solid noborder behind
set label 1 "12 m/s along x" at 42,31.5 tc rgb "#6699bb"
set output images . "/rrt_field.png"
plot runs . "/windy_field/tree.csv" using "x_m":"y_m":(column("parent_x_m") - column("x_m")):(column("parent_y_m") - column("y_m")) with vectors nohead lw 1 lc rgb "#9ecf9e" title "tree", \
     runs . "/windy_field/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/windy_field/way.csv" using 1:2 with lines lw 1 lc rgb "#d62728" title "way of the tree", \
     runs . "/windy_field/smooth.csv" using 1:2 with linespoints lw 1 pt 7 ps 0.4 lc rgb "#ff9933" title "smoothed", \
     runs . "/windy_field/plan.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#1f77b4" title "plan", \
     runs . "/windy_field/mujoco.csv" using "x_m":"y_m" with lines lw 1 dt 2 lc rgb "#000000" title "driven, MuJoCo", \
     runs . "/windy_field_calm/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb "#9467bd" title "plan that does not look at the wind"
