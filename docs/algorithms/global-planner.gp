# Figures of global-planner.md; made by scripts/figures, which makes the plans first.
load "docs/style.gp"
set key autotitle columnhead
unset key

set terminal pngcairo size 1000,760 font "sans,12" background "white"
set output images . "/global_planner_route.png"
eval map_of("Route A with the radii of three rules")
set xrange [-5:90]
set yrange [-5:85]
# From a label to the middle of the arc of radius r in the first turn, or in the third.
x_of(r) = 40 - r*(1 - sqrt(0.5))
y_of(r) = r*(1 - sqrt(0.5))
set label 1 "steering\\_room: r = 16.83 m" at 50,6 left tc rgb blue
set arrow 1 from 49.5,6 to x_of(16.83) + 0.4,y_of(16.83) - 0.1 nohead lc rgb blue
set label 2 "half\\_leg: r = 20 m" at 27,14 right tc rgb red
set arrow 2 from 27.3,13.4 to x_of(20) - 0.3,y_of(20) + 0.3 nohead lc rgb red
set label 3 "turn\\_local: r = 13.06 m" at 50,1 left tc rgb green
set arrow 3 from 49.5,1 to x_of(13.06) + 0.4,y_of(13.06) - 0.2 nohead lc rgb green
set label 4 "waypoints" at 42,-2 left tc rgb gray
$waypoints << end
x,y
0,0
40,0
40,40
80,40
80,80
end
plot $waypoints using 1:2 with linespoints lc rgb "#bbbbbb" pt 7 ps 1, \
     largest . "/plan.csv" using "x_m":"y_m" with lines lw 2.5 lc rgb blue, \
     half_leg . "/plan.csv" using "x_m":"y_m" with lines lw 2.5 dt 2 lc rgb red, \
     local . "/plan.csv" using "x_m":"y_m" with lines lw 2.5 dt 3 lc rgb green
unset label
unset arrow

set terminal pngcairo size 1000,560 font "sans,12" background "white"
set output images . "/global_planner_steering.png"
set title "Steering along route A"
set size noratio
set xlabel "distance driven [m]"
set ylabel "steering [rad]"
set xrange [15:120]
set yrange [-0.2:0.2]
set label 1 "steering\\_room" at 36.5,0.172 center tc rgb blue
set label 2 "half\\_leg:\nramps back to back" at 36,0.119 center tc rgb red
set label 3 "driven: starts and holds shifted" at 102,0.172 center tc rgb orange
plot largest . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2.5 lc rgb blue, \
     half_leg . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2.5 dt 2 lc rgb red, \
     driven . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2.5 dt 4 lc rgb orange
unset label

set output images . "/global_planner_convergence.png"
set title "Best radius of the first turn while the search goes on"
set xlabel "evaluations"
set ylabel "radius [m]"
set xrange [0:10000]
set yrange [*:*]
set offsets 0, 0, 0.6, 0.2
set label 1 "isres, literal: ends on the constraint" at 9900,17.05 right tc rgb blue
set label 2 "isres, turn\\_local" at 9900,13.35 right tc rgb green
set label 3 "esch, turn\\_local" at 2750,12.75 left tc rgb purple
plot local . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2.5 lc rgb green, \
     literal . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2.5 lc rgb blue, \
     esch . "/convergence.csv" using ($1 == 1 ? $2 : NaN):4 with lines lw 2.5 dt 3 lc rgb purple
