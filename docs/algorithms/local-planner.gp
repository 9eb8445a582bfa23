# Figures of local-planner.md; made by scripts/figures, which runs the scenarios first.
load "docs/style.gp"
obstacle_color = "#8c2d04"
near_color = "#f0c0b4"

set terminal pngcairo size 760,960 font "sans,12" background "white"
set output images . "/local_planner_curve.png"
eval map_of("obstacle\\_outer\\_left: the tree, its path and the curve around the box")
set xrange [10:70]
set yrange [-16:64]
set tmargin 3
set bmargin 9
set key at screen 0.5, screen 0.053 center horizontal samplen 2
# Beside their points, clear of the lines that meet there.
label_x(n) = n > 4 ? 2.4 : n == 4 ? 2.0 : 0
label_y(n) = n > 4 ? 0 : n >= 3 ? -1.8 : 1.8
plot outer . "/tree.csv" using "parent_x_m":"parent_y_m":(column("x_m") - column("parent_x_m")):(column("y_m") - column("parent_y_m")) \
       with vectors nohead lw 0.6 lc rgb "#b4c4d8" title "tree of RRT*", \
     (x > 11 && x < box_x ? box_y + box_x - x : NaN) with lines lw 2 lc rgb obstacle_color title "wall on the inner side", \
     outer . "/reach.csv" using 1:2 with lines lw 1.5 lc rgb red title "SD + w_a/2, which RRT* keeps", \
     outer . "/room.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb near_color title "nearer than SD = 1.5 m", \
     outer . "/box.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb obstacle_color title "obstacle", \
     global . "/plan.csv" using (column("x_m") < 11 ? NaN : column("x_m")):"y_m" with lines lw 2 dt 3 lc rgb black title "global plan", \
     outer . "/path.csv" using 1:2 with linespoints lw 1.8 pt 7 ps 0.6 lc rgb blue title "path of the tree", \
     outer . "/control.csv" using 1:2 with linespoints lw 1.5 dt 2 pt 6 ps 1.4 lc rgb green title "control points P_0 to P_7", \
     outer . "/plan.csv" using (column("s_m") < leave || column("s_m") > back ? NaN : column("x_m")):"y_m" with lines lw 3 lc rgb orange title "Bezier curve", \
     outer . "/control.csv" using ($1 + label_x($0)):($2 + label_y($0)):(sprintf("P_%d", $0)) with labels tc rgb green notitle

# A corner of the footprint when the rear axle is at (x, y).
front = length - overhang
corner_x(x, yaw, ahead, left) = x + ahead*cos(yaw) - left*sin(yaw)
corner_y(y, yaw, ahead, left) = y + ahead*sin(yaw) + left*cos(yaw)
# Its sides in turn: right, front, left, rear; where each begins, and how long it is.
ahead_of(side) = side == 0 || side == 3 ? -overhang : front
left_of(side) = side < 2 ? -width/2 : width/2
along(side) = side == 0 ? length : side == 2 ? -length : 0
across(side) = side == 1 ? width : side == 3 ? -width : 0

set terminal pngcairo size 1000,960 font "sans,12" background "white"
set output images . "/local_planner_outlines.png"
eval map_of("obstacle\\_appears: footprints of the kinematic car, one every 2 m")
unset key
set tmargin
set bmargin
stats appears . "/box.csv" using 1:2 nooutput
box_x = STATS_mean_x
box_y = STATS_mean_y
set xrange [28:76]
set yrange [0:46]
drive = appears . "/kinematic.csv"
at(time) = abs(column("t_s") - time) < 1e-6
# Where a whole footprint is within the picture.
shown(x, y) = x > 33.5 && x < 70.5 && y > 5.5 && y < 42.5 ? x : NaN
set label 1 "obstacle" at box_x,box_y + 3.2 center tc rgb obstacle_color
set label 2 "nearer than\n1.5 m" at box_x - 3,box_y + 0.5 right tc rgb red
set label 3 "global plan" at 50.5,40.7 right tc rgb black
set label 4 "Bezier curve (broad), and driven (thin)" at 54,31.5 left tc rgb blue
set arrow 4 from 53.7,31.8 to 49.6,34 nohead lc rgb blue
# Every 33rd control period: 2 m at 3 m/s.
plot appears . "/room.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb near_color, \
     appears . "/box.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb obstacle_color, \
     for [k = 0:3] drive every 33 \
       using (shown(column("x_m"), column("y_m")) + corner_x(0, column("yaw_rad"), ahead_of(k), left_of(k))) \
            :(corner_y(column("y_m"), column("yaw_rad"), ahead_of(k), left_of(k))) \
            :(corner_x(0, column("yaw_rad"), along(k), across(k))):(corner_y(0, column("yaw_rad"), along(k), across(k))) \
       with vectors nohead lw 1 lc rgb "#9a9a9a", \
     appears . "/plan.csv" using (shown(column("x_m"), column("y_m"))):"y_m" with lines lw 2 dt 3 lc rgb black, \
     appears . "/kinematic.plan.csv" using (column("s_m") > curve ? NaN : column("x_m")):"y_m" with lines lw 6 lc rgb light_orange, \
     drive using (shown(column("x_m"), column("y_m"))):"y_m" with lines lw 1.5 lc rgb blue, \
     drive using (at(replanned - delay) ? column("x_m") : NaN):"y_m" with points pt 7 ps 1.4 lc rgb blue, \
     drive using (at(replanned) ? column("x_m") : NaN):"y_m" with points pt 7 ps 1.4 lc rgb red, \
     drive using (at(replanned - delay) ? column("x_m") + 1.9 : NaN):"y_m":("obstacle becomes known") with labels left tc rgb blue, \
     drive using (at(replanned) ? column("x_m") + 1.9 : NaN):"y_m":("t_d later: from here along the curve") with labels left tc rgb red
unset label
unset arrow

set terminal pngcairo size 1000,1000 font "sans,12" background "white"
set output images . "/local_planner_steering.png"
set size noratio
set xrange [10:100]
set multiplot layout 3,1 margins 0.09,0.97,0.06,0.955 spacing 0.03
drive = outer . "/kinematic.csv"
set title "obstacle\\_outer\\_left: steering, steering rate and clearance along the curve"
set xlabel ""
set format x ""
set arrow 1 from leave, graph 0 to leave, graph 1 nohead dt 3 lc rgb "#606060"
set arrow 2 from back, graph 0 to back, graph 1 nohead dt 3 lc rgb "#606060"

set ylabel "steering [rad]"
set yrange [-0.1:0.25]
set ytics 0.1
set label 1 "global plan" at 71.5,0.125 left tc rgb black
set label 2 "plan with the curve (broad), and driven by the kinematic car" at 55,0.215 center tc rgb blue
set label 3 "leaves" at leave + 0.5,-0.085 left tc rgb gray
set label 4 "returns" at back - 0.5,-0.085 right tc rgb gray
plot global . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2 dt 3 lc rgb black, \
     outer . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 6 lc rgb light_orange, \
     drive using (column("s_m") < 10 || column("s_m") > 100 ? NaN : column("s_m")):"steering_rad" with lines lw 1.5 lc rgb blue
unset label
unset title

set ylabel "steering rate [rad/s]"
set yrange [-0.2:0.2]
# Of the plan at its 3 m/s, of the car over ten control periods of 0.02 s.
planned(angle, distance) = (rate = (angle - angle_before)/(distance - distance_before)*3, angle_before = angle, distance_before = distance, rate)
driven(angle) = (rate = (angle - angle_before)/0.2, angle_before = angle, rate)
angle_before = NaN
distance_before = NaN
set label 1 "limit of the car" at 99,limit + 0.013 right tc rgb red
set label 2 "what the curve may use" at 99,0.9*limit - 0.018 right tc rgb red
plot limit with lines lw 1.8 lc rgb red, -limit with lines lw 1.8 lc rgb red, \
     0.9*limit with lines lw 1.8 dt 2 lc rgb red, -0.9*limit with lines lw 1.8 dt 2 lc rgb red, \
     outer . "/schedule.csv" using (column("distance_m") > back ? NaN : column("distance_m")):(planned(column("steering_rad"), column("distance_m"))) \
       with lines lw 6 lc rgb light_orange, \
     drive every 10 using (column("s_m") < 10 || column("s_m") > 100 ? NaN : column("s_m")):(driven(column("steering_rad"))) with lines lw 1.5 lc rgb blue
unset label

set xlabel "distance along the path [m]"
set format x "%g"
set ylabel "clearance [m]"
set yrange [0:8]
set ytics 1
set label 1 "safe distance SD" at 99,safe + 0.35 right tc rgb red
set label 2 "kinematic car,\nand MuJoCo's (dashed)" at 71,6.3 left tc rgb blue
near(clearance) = clearance > 7.8 ? NaN : clearance
plot safe with lines lw 1.8 dt 2 lc rgb red, \
     outer . "/kinematic.csv" using "s_m":(near(column("clearance_m"))) with lines lw 4 lc rgb light_blue, \
     outer . "/mujoco.csv" using "s_m":(near(column("clearance_m"))) with lines lw 1.8 dt 2 lc rgb blue
unset multiplot
