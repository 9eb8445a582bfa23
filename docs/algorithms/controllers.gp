# The figure of the tournament in control.md; made by scripts/figures, which drives the study first: `table` has
# plant, controller, disturbance (by number) and the worse of both routes' cross-track RMS [m].
set terminal pngcairo size 1280,1000 font "sans,12" background "white"
set output images . "/controllers.png"
plants = "kinematic single_track mujoco:contact mujoco:magic_formula"
methods = "schedule preview preview_integral optimal_steering pure_pursuit stanley rear_axle_feedback lqr mpc"
set datafile separator ","
set multiplot layout 2,2 margins 0.155,0.90,0.13,0.95 spacing 0.015,0.06
set logscale cb
set cbrange [0.005:2]
set palette defined (0 "#1a9850", 1 "#a6d96a", 2 "#ffffbf", 3 "#fdae61", 4 "#d73027")
set xrange [-0.5:12.5]
set yrange [8.5:-0.5]
unset key
unset colorbox
set tics scale 0
at(plant, method, which) = sprintf("< awk -F, '$1 == \"%s\"' %s", plant, table)
do for [p = 1:4] {
  plant = word(plants, p)
  set title plant offset 0,-0.6 noenhanced
  set xtics rotate by 50 right noenhanced ("" 0)
  if (p > 2) {
    set xtics ("none" 0, "3 to 1 m/s" 1, "wheelbase x 0.9" 2, "wheelbase x 1.1" 3, "steering x 0.9" 4, \
      "steering x 1.1" 5, "0.1 s late" 6, "play 0.5 deg" 7, "noise" 8, "wind 15 m/s" 9, "friction 0.4" 10, \
      "payload 30 %%" 11, "kick 0.5 m" 12)
  }
  set ytics noenhanced ("" 0)
  if (p % 2 == 1) {
    set for [m = 1:words(methods)] ytics add (word(methods, m) m - 1)
  }
  if (p == 4) {
    set colorbox user origin 0.915,0.13 size 0.018,0.82
    set cblabel "cross-track RMS, worse of two routes [m]"
  }
  plot at(plant, "", 0) using 3:2:4 with image, \
       at(plant, "", 0) using 3:2:($4 < 9.995 ? sprintf($4 < 0.0995 ? "%.3f" : "%.2f", $4) : sprintf("%.0f", $4)) \
         with labels font ",8"
}
unset multiplot
