# The figure of the study controllers in control.md; made by scripts/figures, which runs it first: `table` has
# plant, controller, disturbance (by number) and the worse of both routes' cross-track RMS [m].
load "docs/style.gp"
set terminal pngcairo size 1280,1020 font "sans,12" background "white"
set output images . "/controllers.png"
plants = "kinematic single_track mujoco:contact mujoco:magic_formula"
methods = "schedule preview preview_integral optimal_steering pure_pursuit stanley rear_axle_feedback lqr mpc"
set multiplot layout 2,2 margins 0.155,0.90,0.13,0.905 spacing 0.015,0.06
set label 1 "Every controller on every plant under every disturbance" at screen 0.53,0.972 center font ",14"
set logscale cb
set cbrange [0.005:2]
# Cividis, the light end for small errors.
set palette defined (0 "#fee838", 1 "#cbba69", 2 "#8e8978", 3 "#5b5f70", 4 "#1a3a6c", 5 "#00224e")
set xrange [-0.5:12.5]
set yrange [8.5:-0.5]
unset grid
unset colorbox
set tics scale 0
at(plant) = sprintf("< awk -F, '$1 == \"%s\"' %s", plant, table)
do for [p = 1:4] {
  set title word(plants, p) offset 0,-0.6 noenhanced font ",12"
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
    set colorbox user origin 0.915,0.13 size 0.018,0.775
    set cblabel "cross-track RMS, worse of two routes [m]"
  }
  plot at(word(plants, p)) using 3:2:4 with image, \
       at(word(plants, p)) using 3:2:($4 < 9.995 ? sprintf($4 < 0.0995 ? "%.3f" : "%.2f", $4) : sprintf("%.0f", $4)):($4 > 0.06 ? 0xffffff : 0x000000) \
         with labels font ",8" tc rgb variable
  unset label 1
}
unset multiplot
