# The figure of control.md; made by scripts/figures, which drives the courses first.
set datafile separator ","
set grid lt 1 lw 1 lc rgb "#d8d8d8"
set key opaque

set terminal pngcairo size 1100,1100 font "sans,13" background "white"
set output images . "/control_courses.png"
set multiplot layout 4,1 margins 0.09,0.98,0.06,0.985 spacing 0.04
courses = "s_course step_course"
methods = "preview preview_integral pure_pursuit stanley lqr mpc"
colors = "#2ca02c #98df8a #9467bd #8c564b #1f77b4 #d62728"
file_of(course, method) = out . "/" . course . "_" . method . "/mujoco.csv"
set xlabel ""
do for [course in courses] {
  set xrange [30:260]
  unset key
  set ylabel "cross-track error [m]"
  set yrange [-0.6:0.6]
  plot for [i = 1:words(methods)] file_of(course, word(methods, i)) using "s_m":"cross_track_m" \
       with lines lw (i == words(methods) ? 1.5 : 2.5) lc rgb word(colors, i) notitle
  set ylabel "steering [rad]"
  set yrange [-0.08:0.08]
  if (course eq "step_course") { set xlabel "s [m]" } else { set key bottom left noenhanced maxrows 3 samplen 2 }
  plot for [i = 1:words(methods)] file_of(course, word(methods, i)) using "s_m":"steering_rad" \
       with lines lw (i == words(methods) ? 1.5 : 2.5) lc rgb word(colors, i) title word(methods, i)
}
unset multiplot
