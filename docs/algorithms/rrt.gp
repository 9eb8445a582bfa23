# The figure of rrt.md; made by scripts/figures, which runs the scenario first.
load "docs/style.gp"
set key autotitle columnhead
unset key
set terminal pngcairo size 1000,840 font "sans,12" background "white"
set output images . "/rrt_field.png"
eval map_of("windy\\_field: a path of random trees, smoothed in the wind")
set xrange [-4:66]
set yrange [-20:36]
set object 1 rectangle from 0,19 to 60,33 fc rgb "#eaf3fb" fs solid noborder behind
set label 1 "12 m/s along x" at 45,31.5 tc rgb blue
set tmargin 3
set bmargin 7
set key at screen 0.5, screen 0.045 center horizontal maxrows 2 samplen 2
plot runs . "/windy_field/tree.csv" using "x_m":"y_m":(column("parent_x_m") - column("x_m")):(column("parent_y_m") - column("y_m")) with vectors nohead lw 1.2 lc rgb light_green title "tree", \
     runs . "/windy_field/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/windy_field/path.csv" using 1:2 with lines lw 1.5 lc rgb red title "path of the tree", \
     runs . "/windy_field/smooth.csv" using 1:2 with linespoints lw 1.5 pt 7 ps 0.5 lc rgb orange title "smoothed", \
     runs . "/windy_field/plan.csv" using "x_m":"y_m" with lines lw 4 lc rgb light_blue title "plan", \
     runs . "/windy_field/mujoco.csv" using "x_m":"y_m" with lines lw 1.8 dt 2 lc rgb blue title "driven, MuJoCo", \
     runs . "/windy_field_calm/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb purple title "plan ignoring the wind"
