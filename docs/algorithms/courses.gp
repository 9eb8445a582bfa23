# The figure of the courses in control.md; made by scripts/figures, which runs them first.
load "docs/style.gp"
set terminal pngcairo size 1100,1200 font "sans,12" background "white"
set output images . "/control_courses.png"
set multiplot layout 4,1 margins 0.09,0.97,0.05,0.905 spacing 0.055
courses = "s_course step_course"
title_of(course) = course eq "s_course" ? "s\\_course: two opposed arcs of 0.4 g" : "step\\_course: a turn of 0.4 g whose curvature steps"
methods = "preview preview_integral pure_pursuit stanley lqr mpc"
colors = green . " " . orange . " " . purple . " " . gray . " " . sky . " " . red
dashes = "1 1 1 1 1 2"
file_of(course, method) = out . "/" . course . "_" . method . "/mujoco.csv"
start = 30
end = 300
shown(s) = s < start || s > end ? NaN : s
set xrange [start:end]
set label 1 "The Prius at 20 m/s" at screen 0.53,0.985 center font ",14"
do for [course in courses] {
  set title title_of(course) offset 0,-0.5 font ",12"
  set xlabel ""
  # Linear up to a few centimeters, then logarithmic: all errors are seen, large and small.
  set nonlinear y via asinh(y/0.02) inverse 0.02*sinh(y)
  set yrange [-4:4]
  set ytics (-3, -1, -0.3, -0.1, -0.03, 0, 0.03, 0.1, 0.3, 1, 3)
  set ylabel "cross-track error [m]\n(asinh scale)"
  if (course eq "s_course") {
    set key at screen 0.53, screen 0.968 center top horizontal maxrows 1 noenhanced samplen 2
  } else {
    unset key
  }
  plot for [i = 1:words(methods)] file_of(course, word(methods, i)) using (shown(column("s_m"))):"cross_track_m" \
       with lines lw 2 dt int(word(dashes, i)) lc rgb word(colors, i) title word(methods, i)
  unset label 1
  unset key
  unset title
  unset nonlinear y
  set ylabel "steering [rad]"
  set yrange [-0.15:0.15]
  set ytics 0.05
  if (course eq "step_course") { set xlabel "station [m]" }
  plot for [i = 1:words(methods)] file_of(course, word(methods, i)) using (shown(column("s_m"))):"steering_rad" \
       with lines lw 2 dt int(word(dashes, i)) lc rgb word(colors, i) notitle
}
unset multiplot
