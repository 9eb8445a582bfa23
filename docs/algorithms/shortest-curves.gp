# Figure of shortest-curves.md; made by scripts/figures, which makes the plans first.
load "docs/style.gp"
set key autotitle columnhead
unset key
set terminal pngcairo size 1000,800 font "sans,12" background "white"
set output images . "/shortest_curves.png"
eval map_of("heading\\_goal: the shortest curves through three poses")
set xrange [-4:46]
set yrange [-9:27]
set label 1 "dubins" at 8,14 center tc rgb blue
set label 2 "reeds\\_shepp, forwards" at 20,-0.4 center tc rgb orange
set label 3 "reeds\\_shepp, backwards" at 29,-2 left tc rgb red
set label 4 "obstacle" at 16.5,11.6 center tc rgb gray
set label 5 "start" at 0,-1.3 left tc rgb black
set label 6 "stop" at 32.8,12.4 center tc rgb black
set label 7 "goal" at 21.3,-6.3 left tc rgb black
$stops << end
x,y,yaw
0,0,0
30,10,1.2
20,-5,0
end
plot runs . "/boxes.csv" using 1:2 with filledcurves lc rgb "#bbbbbb", \
     runs . "/dubins/plan.csv" using "x_m":"y_m" with lines lw 2.5 lc rgb blue, \
     runs . "/reeds_shepp/plan.csv" using (column("direction") > 0 ? column("x_m") : NaN):"y_m" with lines lw 2.5 lc rgb orange, \
     runs . "/reeds_shepp/plan.csv" using (column("direction") < 0 ? column("x_m") : NaN):"y_m" with lines lw 2.5 dt 2 lc rgb red, \
     $stops using 1:2:(3*cos($3)):(3*sin($3)) with vectors lw 2 lc rgb black
