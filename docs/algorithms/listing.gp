# The figure of the study listing in local-planner.md; made by scripts/figures, which runs the study first: `cases` has
# the method (0 and 1: bezier, 2 and 3: listing, inner and outer), the number of the case, and of both plants the
# smaller clearance [m] and the larger steering rate [rad/s].
load "docs/style.gp"
set terminal pngcairo size 1000,780 font "sans,12" background "white"
set output images . "/local_planner_listing.png"
set xrange [-0.7:19.7]
set multiplot layout 2,1 margins 0.085,0.97,0.125,0.885 spacing 0.03
of(method, value) = (column(1) == method ? value : NaN)
do for [k = 1:3] {
  set arrow k from 5*k - 0.5, graph 0 to 5*k - 0.5, graph 1 nohead dt 3 lc rgb "#606060"
}
set label 10 "Both methods in 20 turns: clearance and steering rate" at screen 0.5275,0.972 center font ",14"
set xlabel ""
set ylabel "least clearance [m]"
set xtics ("" 0)
set for [k = 0:19] xtics add ("" k)
set yrange [0:7]
set ytics 1
set label 5 "safe distance" at -0.5,1.05 left tc rgb red
set key at screen 0.5275, screen 0.95 center top horizontal samplen 1 width 3
plot safe with lines lw 1.8 dt 2 lc rgb red notitle, \
     cases using (of(2, $2)):3 with points pt 5 ps 1.3 lc rgb blue title "listing, inner", \
     cases using (of(3, $2)):3 with points pt 7 ps 1.3 lc rgb blue title "listing, outer", \
     cases using (of(0, $2)):3 with points pt 4 ps 1.5 lw 1.8 lc rgb orange title "bezier, inner", \
     cases using (of(1, $2)):3 with points pt 6 ps 1.5 lw 1.8 lc rgb orange title "bezier, outer"
unset key
unset label 10
set label 5 "limit of the car" at 19.6,limit + 0.006 right tc rgb red
set ylabel "largest steering rate [rad/s]"
set for [k = 0:19] xtics add (sprintf("%d", k % 5 + 1) k)
set yrange [0:0.17]
set ytics 0.05
set xlabel "sixth of the arc at which the obstacle is" offset 0,-1.2
set for [k = 0:3] label k + 1 sprintf("%s, %s°", k < 2 ? "left" : "right", k % 2 == 0 ? "90" : "75") \
  at 5*k + 2, graph -0.145 center
plot limit with lines lw 1.8 dt 2 lc rgb red, \
     cases using (of(2, $2)):4 with points pt 5 ps 1.3 lc rgb blue, \
     cases using (of(3, $2)):4 with points pt 7 ps 1.3 lc rgb blue, \
     cases using (of(0, $2)):4 with points pt 4 ps 1.5 lw 1.8 lc rgb orange, \
     cases using (of(1, $2)):4 with points pt 6 ps 1.5 lw 1.8 lc rgb orange
unset multiplot
