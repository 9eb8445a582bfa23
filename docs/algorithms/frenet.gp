# The figure of frenet.md; made by scripts/figures, which runs the scenario first.
load "docs/style.gp"
set key autotitle columnhead
unset key
set terminal pngcairo size 1100,440 font "sans,12" background "white"
set output images . "/frenet_slalom.png"
eval map_of("slalom\\_road: motions through a lattice, one every half second")
set xrange [-5:285]
set yrange [-10:75]
set label 1 "route" at 121,24 left tc rgb gray
set label 2 "motions" at 118,40 right tc rgb blue
set label 3 "driven, MuJoCo" at 92,3 left tc rgb red
set label 4 "broken-down cars" at 64,9 center tc rgb black
plot run . "/boxes.csv" using 1:2 with filledcurves lc rgb "#606060", \
     run . "/motions.csv" using 1:2 with lines lw 1.2 lc rgb sky, \
     run . "/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb gray, \
     run . "/mujoco.csv" using "x_m":"y_m" with lines lw 2 lc rgb red
