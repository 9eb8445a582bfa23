# Figures of search.md; made by scripts/figures, which runs the scenarios first.
load "docs/style.gp"
set key autotitle columnhead
unset key
set terminal pngcairo size 1000,560 font "sans,12" background "white"

set output images . "/search_astar.png"
eval map_of("parking\\_lot\\_astar: a path on a grid, rounded")
set xrange [-14:42]
set yrange [-12:17]
set label 1 "A* on its grid" at 22,10.2 center tc rgb red
set label 2 "rounded plan, and driven by MuJoCo's car (dashed)" at 16,13 center tc rgb blue
set label 3 "parked cars" at 19.2,0 center tc rgb gray
plot runs . "/parking_lot_astar/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb", \
     runs . "/parking_lot_astar/grid.csv" using 1:2 with linespoints lw 1.2 pt 7 ps 0.5 lc rgb red, \
     runs . "/parking_lot_astar/plan.csv" using "x_m":"y_m" with lines lw 4 lc rgb light_blue, \
     runs . "/parking_lot_astar/mujoco.csv" using "x_m":"y_m" with lines lw 1.8 dt 2 lc rgb blue
unset label

set output images . "/search_hybrid.png"
eval map_of("parking\\_lot: past the bay, and back into it")
set xrange [-6:38]
set yrange [-12:10]
set label 1 "forwards" at 12,-3.1 center tc rgb blue
set label 2 "backwards" at 24.0,-3.1 left tc rgb red
set label 3 "driven, MuJoCo" at 11.5,-0.9 center tc rgb black
set label 4 "wall" at 19,-10.6 center tc rgb gray
set label 5 "parked cars" at 19.2,3.2 center tc rgb gray
plot runs . "/parking_lot/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb", \
     runs . "/parking_lot/plan.csv" using (column("direction") > 0 ? column("x_m") : NaN):"y_m" with lines lw 4 lc rgb light_blue, \
     runs . "/parking_lot/plan.csv" using (column("direction") < 0 ? column("x_m") : NaN):"y_m" with lines lw 4 lc rgb "#f0b48c", \
     runs . "/parking_lot/mujoco.csv" using "x_m":"y_m" with lines lw 1.5 lc rgb black
