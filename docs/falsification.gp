# The picture of falsification.md; made by scripts/figures from the grids in tests/data/falsification.
load "docs/style.gp"
set terminal pngcairo noenhanced size 1400,860 font "sans,12" background "white"
set output images . "/falsification.png"
studies = "lane_change gust pedestrian delay split_friction payload"
array x_labels[6] = ["speed [m/s]", "gust begins at [s]", "pedestrian is seen from [m]", "steering delay [s]", \
                     "friction under the left wheels", "payload ahead of the rear axle [m]"]
array y_labels[6] = ["friction", "gust to the left [m/s]", "he starts beside the path at [m]", "preview distance [m]", \
                     "braking [m/s²]", "steering amplitude [rad]"]
# Where nothing is wrong: `nominal` of the study.
array nominal_x[6] = [13, 5, 40, 0, 1, 1.4]
array nominal_y[6] = [1, 0, -12, 3, 3, 0.03]
unset grid
unset colorbox
set border lc rgb black
set palette defined (-1 "#8c2d04", -0.001 "#d55e00", 0 "#0072b2", 0.35 "#56b4e9", 1 "#eef6fb")
set cbrange [-1:1]
set multiplot layout 2,3 margins 0.056,0.987,0.075,0.9 spacing 0.075,0.13
set label 1 "Runs that fail (red) and pass (blue, the paler the further from failing); the ring is where nothing is wrong" \
  at screen 0.5,0.965 center font ",14"
do for [i = 1:6] {
  set autoscale xy
  file = grids . "/falsify_" . word(studies, i) . ".csv"
  stats file using 1 every ::1 name "X" nooutput
  stats file using 2 every ::1 name "Y" nooutput
  stats file using (column(4) > 0 ? column(4) : NaN) every ::1 name "PASSED" nooutput
  stats file using (column(4) < 0 ? -column(4) : NaN) every ::1 name "FAILED" nooutput
  # Points of a regular grid, the second key fastest.
  stats file using (column(1) == X_min ? column(2) : NaN) every ::1 name "COLUMN" nooutput
  half_y = 0.5*(Y_max - Y_min)/(COLUMN_records - 1)
  half_x = 0.5*(X_max - X_min)/(X_records/COLUMN_records - 1)
  set title word(studies, i) font ",13"
  set xlabel x_labels[i]
  set ylabel y_labels[i]
  set xrange [X_min - half_x:X_max + half_x]
  set yrange [Y_min - half_y:Y_max + half_y]
  plot file every ::1 using 1:2:(1.03*half_x):(1.03*half_y):(column(4) < 0 ? -sqrt(-column(4)/FAILED_max) : sqrt(column(4)/PASSED_max)) \
         with boxxyerror fs solid noborder lc palette, \
       "+" every ::0::0 using (nominal_x[i]):(nominal_y[i]) with points pt 6 ps 2 lw 2.5 lc rgb black
  unset label 1
}
unset multiplot
