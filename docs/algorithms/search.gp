# Figures of search.md; made by scripts/figures, which runs the plans and drives first.
set datafile separator ","
set terminal pngcairo size 1000,640 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left

set output images . "/search_astar.png"
set xrange [-8:42]
set yrange [-12:22]
plot runs . "/parking_lot_astar/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/parking_lot_astar/grid.csv" using 1:2 with linespoints lw 1 pt 7 ps 0.4 lc rgb "#d62728" title "A* on its grid", \
     runs . "/parking_lot_astar/plan.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#1f77b4" title "rounded", \
     runs . "/parking_lot_astar/mujoco.csv" using "x_m":"y_m" with lines lw 1 dt 2 lc rgb "#2ca02c" title "driven, MuJoCo"

set output images . "/search_hybrid.png"
set xrange [-8:38]
set yrange [-12:14]
plot runs . "/parking_lot/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb" title "obstacles", \
     runs . "/parking_lot/plan.csv" using (column("direction") > 0 ? column("x_m") : NaN):"y_m" with lines lw 2 lc rgb "#1f77b4" title "forwards", \
     runs . "/parking_lot/plan.csv" using (column("direction") < 0 ? column("x_m") : NaN):"y_m" with lines lw 2 dt 2 lc rgb "#d62728" title "backwards", \
     runs . "/parking_lot/mujoco.csv" using "x_m":"y_m" with lines lw 1 lc rgb "#2ca02c" title "driven, MuJoCo"
