# Figures of global-planner.md; made by scripts/figures, which runs the plans first.
set datafile separator ","
set terminal pngcairo size 1000,640 font "sans,11" background "white"
set grid lt 1 lw 1 lc rgb "#c8c8c8"
set key autotitle columnhead

set output images . "/global_planner_route.png"
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key top left
set xrange [-5:90]
set yrange [-5:85]
plot "-" using 1:2 with linespoints lc rgb "#bbbbbb" pt 7 ps 0.8 title "waypoints", \
     largest . "/plan.csv" using "x_m":"y_m" with lines lw 2 lc rgb "#1f77b4" title "largest under C.40, r = 16.83 m", \
     half_leg . "/plan.csv" using "x_m":"y_m" with lines lw 2 dt 2 lc rgb "#d62728" title "largest under C.34, r = 20 m", \
     local . "/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb "#2ca02c" title "turn-local, r = 13.06 m"
0,0
40,0
40,40
80,40
80,80
e

set output images . "/global_planner_steering.png"
set size noratio
set xlabel "distance driven [m]"
set ylabel "steering [rad]"
set key top right
set xrange [15:130]
set yrange [-0.3:0.35]
plot largest . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2 lc rgb "#1f77b4" title "largest under C.40", \
     half_leg . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2 dt 2 lc rgb "#d62728" title "largest under C.34: ramps back to back", \
     driven . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2 dt 4 lc rgb "#ff7f0e" title "driven: starts and holds shifted"

set output images . "/global_planner_convergence.png"
set xlabel "evaluations"
set ylabel "best radius of the first turn [m]"
set key top right
set xrange [0:10000]
set yrange [12.5:17.5]
plot local . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2 lc rgb "#2ca02c" title "isres, turn-local", \
     literal . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2 lc rgb "#1f77b4" title "isres, literal (ends on C.40)", \
     esch . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2 dt 3 lc rgb "#9467bd" title "esch, turn-local"
