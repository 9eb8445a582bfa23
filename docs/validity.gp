# The maps of the study validity in vehicle.md; made by scripts/figures, which runs it first. One panel for each tyre law
# and friction. A run without a yaw-rate ratio failed wholly.
load "docs/style.gp"
$taghia << end
3,0.0085
3,0.118
end
$werner << end
4.5,0.0085
4.5,0.118
end
sweep = study . "/sweep.csv"
unset key
set border lc rgb black
set logscale xy
set xrange [1.7:35]
set yrange [0.0085:0.118]
set xtics (2, 3, 4.5, 6, 8, 10, 13, 16, 20, 25, 30)
# Half the step of the study's grid in log speed and in log curvature.
half_v = log(30/2.)/39/2
half_k = log(10.)/20/2
curvatures = '("1/100" 0.01, "1/63" 1/63., "1/40" 0.025, "1/25" 0.04, "1/16" 1/16., "1/10" 0.1)'
set datafile missing NaN
set samples 1000
polack(v, mu) = (curvature = 0.5*friction*mu*9.81/v**2, curvature < 0.0085 || curvature > 0.118 ? NaN : curvature)
in_panel(tyre, mu) = strcol("vehicle.tyre") eq tyre && abs(column("world.friction") - mu) < 1e-9
number(name) = (text = strcol(name), strlen(text) > 0 ? real(text) : NaN)
wrong(unused) = (ratio = number("metrics.mujoco.yaw_rate_ratio"), ratio == ratio ? abs(1 - ratio) : 1)
off_path(unused) = (off = number("metrics.mujoco.cross_track.max"), off == off ? off : 1000)
# Where a quantity that rises with the speed passes a limit; runs of one radius follow each other.
passes(v, e, limit) = (before_v = last_v, before_e = last_e, last_v = v, last_e = e, \
  v > before_v && before_e < limit && e >= limit ? \
  exp(log(before_v) + (log(v) - log(before_v))*(limit - before_e)/(e - before_e)) : NaN)

array names[5] = ["0.5 µ g (Polack)", "3 m/s (Taghia)", "4.5 m/s (Werner)", "", ""]
array starts[5] = [0.1, 0.28, 0.44, 0.62, 0.76]
do for [what = 1:2] {
  set output images . (what == 1 ? "/vehicle_validity_yaw_rate.png" : "/vehicle_validity_cross_track.png")
  set terminal pngcairo noenhanced size 1400,920 font "sans,12" background "white"
  set multiplot layout 2,3 margins 0.065,0.9,0.125,0.885 spacing 0.03,0.09
  set label 1 (what == 1 ? "How far the yaw rate is off the kinematic prediction" : "How far the car leaves its path") \
    at screen 0.4825,0.967 center font ",15"
  # What the lines are, below all panels.
  names[4] = what == 1 ? "5 % off" : "0.3 m off"
  names[5] = what == 1 ? "10 % off" : "1 m off"
  do for [i = 1:5] { set label 1 + i names[i] at screen starts[i] + 0.045,0.025 left }
  set arrow 1 from screen starts[1],0.025 to screen starts[1] + 0.035,0.025 nohead lw 2 dt 3 lc rgb "#000000"
  set arrow 2 from screen starts[2],0.025 to screen starts[2] + 0.035,0.025 nohead lw 2 dt 2 lc rgb "#1b7837"
  set arrow 3 from screen starts[3],0.025 to screen starts[3] + 0.035,0.025 nohead lw 2 dt 4 lc rgb "#762a83"
  set arrow 4 from screen starts[4],0.025 to screen starts[4] + 0.035,0.025 nohead lw 3 lc rgb "#08519c"
  set arrow 5 from screen starts[5],0.025 to screen starts[5] + 0.035,0.025 nohead lw 3 lc rgb "#000000"
  if (what == 1) {
    set palette defined (0 "#f7fbff", 0.05 "#c6dbef", 0.0501 "#fdd49e", 0.1 "#fdbb84", 0.1001 "#ef6548", 0.3 "#990000")
    set cbrange [0:0.3]
    set cblabel "yaw rate off the kinematic prediction"
    set format cb "%.2f"
    low = 0.05; high = 0.1
  } else {
    set palette defined (0 "#f7fbff", 0.3 "#c6dbef", 0.301 "#fdd49e", 1 "#fdbb84", 1.01 "#ef6548", 3 "#990000")
    set cbrange [0:3]
    set cblabel "largest cross-track error [m]"
    set format cb "%.1f"
    low = 0.3; high = 1
  }
  do for [tyre in "contact magic_formula"] {
    do for [mu in "1 0.5 0.2"] {
      set title tyre . ", friction " . mu font ",12"
      set xlabel (tyre eq "magic_formula" ? "speed [m/s]" : "")
      set ylabel (mu eq "1" ? "curvature [1/m]" : "")
      if (mu eq "1") { set ytics @curvatures } else { set ytics ("" 0.01, "" 1/63., "" 0.025, "" 0.04, "" 1/16., "" 0.1) }
      if (mu eq "0.2" && tyre eq "contact") { set colorbox user origin 0.925,0.125 size 0.015,0.76 } else { unset colorbox }
      last_v = 1e9; last_e = 0
      plot sweep using (in_panel(tyre, real(mu)) ? column("mission.speed") : NaN):(1/column("plan.radius")) \
             :(column("mission.speed")*exp(-half_v)):(column("mission.speed")*exp(half_v)) \
             :(exp(-half_k)/column("plan.radius")):(exp(half_k)/column("plan.radius")) \
             :(what == 1 ? wrong(0) : off_path(0)) with boxxyerror fs solid noborder lc palette, \
           [1.7:35] polack(x, real(mu)) with lines lw 2 dt 3 lc rgb "#000000", \
           $taghia using 1:2 with lines lw 2 dt 2 lc rgb "#1b7837", \
           $werner using 1:2 with lines lw 2 dt 4 lc rgb "#762a83", \
           sweep using (in_panel(tyre, real(mu)) ? passes(column("mission.speed"), what == 1 ? wrong(0) : off_path(0), low) : NaN) \
             :(1/column("plan.radius")) with lines lw 3 lc rgb "#08519c", \
           sweep using (in_panel(tyre, real(mu)) ? passes(column("mission.speed"), what == 1 ? wrong(0) : off_path(0), high) : NaN) \
             :(1/column("plan.radius")) with lines lw 3 lc rgb "#000000"
      unset label
      unset arrow
    }
  }
  unset multiplot
}
