# Figures of local-planner.md; made by scripts/figures, which drives the scenarios first.
set datafile separator ","
set grid lt 1 lw 1 lc rgb "#d8d8d8"
set key opaque

set terminal pngcairo size 1100,1080 font "sans,13" background "white"
set output images . "/local_planner_curve.png"
set size ratio -1
set xlabel "x [m]"
set ylabel "y [m]"
set key bottom right
set xrange [10:90]
set yrange [-28:42]
# Beside their points, clear of the lines that meet there.
label_x(n) = n > 4 ? 2.4 : n == 4 ? 2.0 : 0
label_y(n) = n > 4 ? 0 : n >= 3 ? -1.8 : 1.8
plot outer . "/tree.csv" using "parent_x_m":"parent_y_m":(column("x_m") - column("parent_x_m")):(column("y_m") - column("parent_y_m")) \
       with vectors nohead lw 0.6 lc rgb "#b4c4d8" title "tree of RRT*", \
     (x < box_x ? box_y + box_x - x : NaN) with lines lw 2 lc rgb "#8c2d04" title "wall on the inner side", \
     outer . "/reach.csv" using 1:2 with lines lw 1.2 lc rgb "#d62728" title "SD + w_a/2, which RRT* keeps", \
     outer . "/room.csv" using 1:2 with filledcurves closed fs transparent solid 0.25 noborder lc rgb "#d62728" title "nearer than SD = 1.5 m", \
     outer . "/box.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb "#8c2d04" title "obstacle", \
     global . "/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb "#404040" title "global plan", \
     outer . "/way.csv" using 1:2 with linespoints lw 1.8 pt 7 ps 0.6 lc rgb "#1f77b4" title "way found by RRT*", \
     outer . "/control.csv" using 1:2 with linespoints lw 1.5 dt 2 pt 6 ps 1.4 lc rgb "#2ca02c" title "control points P_0 to P_7", \
     outer . "/plan.csv" using (column("s_m") < leave || column("s_m") > back ? NaN : column("x_m")):"y_m" with lines lw 3 lc rgb "#ff7f0e" title "Bezier curve", \
     outer . "/control.csv" using ($1 + label_x($0)):($2 + label_y($0)):(sprintf("P_%d", $0)) with labels tc rgb "#1a661a" notitle

# A corner of the outline when the rear axle is at (x, y).
front = length - overhang
corner_x(x, yaw, ahead, left) = x + ahead*cos(yaw) - left*sin(yaw)
corner_y(y, yaw, ahead, left) = y + ahead*sin(yaw) + left*cos(yaw)
# Its sides in turn: right, front, left, rear; where each begins, and how long it is.
ahead_of(side) = side == 0 || side == 3 ? -overhang : front
left_of(side) = side < 2 ? -width/2 : width/2
along(side) = side == 0 ? length : side == 2 ? -length : 0
across(side) = side == 1 ? width : side == 3 ? -width : 0

set terminal pngcairo size 1100,1000 font "sans,13" background "white"
set output images . "/local_planner_outlines.png"
set key top left
set xrange [30:75]
set yrange [4:45]
drive = appears . "/kinematic.csv"
at(time) = abs(column("t_s") - time) < 1e-6
# Every 33rd control period: 2 m at 3 m/s.
plot appears . "/room.csv" using 1:2 with filledcurves closed fs transparent solid 0.25 noborder lc rgb "#d62728" title "nearer than SD = 1.5 m", \
     appears . "/box.csv" using 1:2 with filledcurves closed fs solid 1 noborder lc rgb "#8c2d04" title "obstacle", \
     for [k = 0:3] drive every 33 \
       using (corner_x(column("x_m"), column("yaw_rad"), ahead_of(k), left_of(k))) \
            :(corner_y(column("y_m"), column("yaw_rad"), ahead_of(k), left_of(k))) \
            :(corner_x(0, column("yaw_rad"), along(k), across(k))):(corner_y(0, column("yaw_rad"), along(k), across(k))) \
       with vectors nohead lw 1 lc rgb "#9a9a9a" title (k == 0 ? "outline every 2 m" : ""), \
     appears . "/plan.csv" using "x_m":"y_m" with lines lw 2 dt 3 lc rgb "#404040" title "global plan", \
     appears . "/kinematic.plan.csv" using (column("s_m") > curve ? NaN : column("x_m")):"y_m" with lines lw 6 lc rgb "#ffc48a" title "Bezier curve", \
     drive using "x_m":"y_m" with lines lw 1.5 lc rgb "#1f77b4" title "driven, kinematic car", \
     drive using (at(replanned - delay) ? column("x_m") : NaN):"y_m" with points pt 7 ps 1.2 lc rgb "#1f77b4" notitle, \
     drive using (at(replanned) ? column("x_m") : NaN):"y_m" with points pt 7 ps 1.2 lc rgb "#ff7f0e" notitle, \
     drive using (at(replanned - delay) ? column("x_m") + 1.9 : NaN):"y_m":("obstacle becomes known") with labels left tc rgb "#1f77b4" notitle, \
     drive using (at(replanned) ? column("x_m") + 1.9 : NaN):"y_m":("t_d later: from here along the curve") with labels left tc rgb "#c05a00" notitle

set terminal pngcairo size 1000,1000 font "sans,13" background "white"
set output images . "/local_planner_steering.png"
set size noratio
set xrange [10:100]
set multiplot layout 3,1 margins 0.09,0.98,0.06,0.985 spacing 0.03
drive = outer . "/kinematic.csv"
set xlabel ""
set format x ""
set arrow 1 from leave, graph 0 to leave, graph 1 nohead dt 3 lc rgb "#606060"
set arrow 2 from back, graph 0 to back, graph 1 nohead dt 3 lc rgb "#606060"

set ylabel "steering [rad]"
set yrange [-0.2:0.4]
set ytics 0.1
plot global . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 2 dt 3 lc rgb "#404040" title "global plan", \
     outer . "/schedule.csv" using "distance_m":"steering_rad" with lines lw 5 lc rgb "#ffc48a" title "plan with the curve", \
     drive using "s_m":"steering_rad" with lines lw 1.5 lc rgb "#1f77b4" title "driven, kinematic car"

set ylabel "steering rate [rad/s]"
set yrange [-0.2:0.4]
# Of the plan at its 3 m/s, of the car over ten control periods of 0.02 s.
planned(angle, distance) = (rate = (angle - angle_before)/(distance - distance_before)*3, angle_before = angle, distance_before = distance, rate)
driven(angle) = (rate = (angle - angle_before)/0.2, angle_before = angle, rate)
angle_before = NaN
distance_before = NaN
plot limit with lines lw 1.5 lc rgb "#d62728" title "limit of the car", \
     -limit with lines lw 1.5 lc rgb "#d62728" notitle, \
     0.9*limit with lines lw 1.5 dt 2 lc rgb "#d62728" title "what the curve may ask for", \
     -0.9*limit with lines lw 1.5 dt 2 lc rgb "#d62728" notitle, \
     outer . "/schedule.csv" using (column("distance_m") > back ? NaN : column("distance_m")):(planned(column("steering_rad"), column("distance_m"))) \
       with lines lw 5 lc rgb "#ffc48a" title "curve", \
     drive every 10 using "s_m":(driven(column("steering_rad"))) with lines lw 1.5 lc rgb "#1f77b4" title "driven, kinematic car"

set xlabel "distance along the path [m]"
set format x "%g"
set ylabel "clearance [m]"
set yrange [0:8]
set ytics 1
set key top left
plot safe with lines lw 1.5 dt 2 lc rgb "#d62728" title "SD", \
     outer . "/kinematic.csv" using "s_m":"clearance_m" with lines lw 2 lc rgb "#1f77b4" title "kinematic car", \
     outer . "/mujoco.csv" using "s_m":"clearance_m" with lines lw 2 dt 2 lc rgb "#2ca02c" title "MuJoCo car"
unset multiplot

# The study listing.yaml: `cases` has the method (0 and 1: bezier, 2 and 3: listing, inner and outer), the number of the
# case, and of both plants the smaller clearance [m] and the larger steering rate [rad/s].
set terminal pngcairo size 1000,760 font "sans,13" background "white"
set output images . "/local_planner_listing.png"
unset arrow
set xrange [-0.7:19.7]
set multiplot layout 2,1 margins 0.095,0.98,0.135,0.925 spacing 0.03
of(method, value) = (column(1) == method ? value : NaN)
do for [k = 1:3] {
  set arrow k from 5*k - 0.5, graph 0 to 5*k - 0.5, graph 1 nohead dt 3 lc rgb "#606060"
}
set xlabel ""
set ylabel "least clearance [m]"
set xtics ("" 0)
set for [k = 0:19] xtics add ("" k)
set yrange [0:7]
set ytics 1
set key at screen 0.98, screen 0.995 right top maxrows 2 samplen 2
plot safe with lines lw 1.5 dt 2 lc rgb "#d62728" title "limit", \
     cases using (of(2, $2)):3 with points pt 5 ps 1.2 lc rgb "#1f77b4" title "listing, inner", \
     cases using (of(3, $2)):3 with points pt 7 ps 1.2 lc rgb "#1f77b4" title "listing, outer", \
     cases using (of(0, $2)):3 with points pt 4 ps 1.4 lw 1.8 lc rgb "#ff7f0e" title "bezier, inner", \
     cases using (of(1, $2)):3 with points pt 6 ps 1.4 lw 1.8 lc rgb "#ff7f0e" title "bezier, outer"
unset key
set ylabel "largest steering rate [rad/s]"
set for [k = 0:19] xtics add (sprintf("%d", k % 5 + 1) k)
set yrange [0:0.17]
set ytics 0.05
set xlabel "sixth of the arc at which the obstacle stands" offset 0,-1.2
set for [k = 0:3] label k + 1 sprintf("%s, %s°", k < 2 ? "left" : "right", k % 2 == 0 ? "90" : "75") \
  at 5*k + 2, graph -0.155 center
plot limit with lines lw 1.5 dt 2 lc rgb "#d62728", \
     cases using (of(2, $2)):4 with points pt 5 ps 1.2 lc rgb "#1f77b4", \
     cases using (of(3, $2)):4 with points pt 7 ps 1.2 lc rgb "#1f77b4", \
     cases using (of(0, $2)):4 with points pt 4 ps 1.4 lw 1.8 lc rgb "#ff7f0e", \
     cases using (of(1, $2)):4 with points pt 6 ps 1.4 lw 1.8 lc rgb "#ff7f0e"
unset multiplot
