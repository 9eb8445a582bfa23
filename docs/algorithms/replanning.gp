# Figures of replanning.md; made by scripts/figures, which runs the scenarios first.
load "docs/style.gp"
set key autotitle columnhead
unset key
set terminal pngcairo size 1000,370 font "sans,12" background "white"

set output images . "/replanning.png"
eval map_of("blocked\\_road: a detour when the fence is seen")
set xrange [-3:113]
set yrange [-12:18]
set label 1 "fence" at 50,7 center tc rgb gray
set label 2 "obstacle" at 68,8 left tc rgb gray
set label 3 "route" at 3,2 left tc rgb black
set label 4 "plan adopted, and driven by MuJoCo's car (dashed)" at 50,-9 center tc rgb blue
plot runs . "/blocked_road/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb", \
     runs . "/blocked_road/plan.csv" using "x_m":"y_m" with lines lw 1.5 dt 3 lc rgb black, \
     runs . "/blocked_road/motions.csv" using 1:2 with lines lw 4 lc rgb light_blue, \
     runs . "/blocked_road/mujoco.csv" using "x_m":"y_m" with lines lw 1.8 dt 2 lc rgb blue
unset label

set terminal pngcairo size 1000,700 font "sans,12" background "white"
set output images . "/grand_tour.png"
eval map_of("grand\\_tour: a box, a van, and a road that is closed")
set xrange [-110:150]
set yrange [-10:140]
set label 1 "box, passed on a Bezier curve" at 57,50 right tc rgb black
set label 2 "van, passed by\nmotions in a lattice" at 114,49 center tc rgb black
set label 3 "closed: a detour that RRT found" at 82,132 center tc rgb black
set label 4 "start" at 0,-4 center tc rgb black
set label 5 "goal" at -100,15 center tc rgb black
set label 6 "driven, MuJoCo" at -26,60 left tc rgb red
set label 7 "motions planned" at 108,68 center tc rgb blue
set label 8 "route" at 90,123.5 left tc rgb gray
plot runs . "/grand_tour/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb gray, \
     runs . "/grand_tour/motions.csv" using 1:2 with lines lw 1.2 lc rgb sky, \
     runs . "/grand_tour/boxes.csv" using 1:2 with filledcurves lc rgb "#606060", \
     runs . "/grand_tour/mujoco.csv" using "x_m":"y_m" with lines lw 2 lc rgb red
