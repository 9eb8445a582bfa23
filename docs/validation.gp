# The figure of the validation in vehicle.md; made by scripts/figures, which runs the scenarios first.
load "docs/style.gp"
reference(name) = "scenarios/validation/" . name . "_bmw320i_" . (name eq "lane_change" ? "15" : "20") . "mps.csv"
car(name, plant) = runs . "/" . name . "/" . plant . ".csv"

set terminal pngcairo noenhanced size 1200,820 font "sans,12" background "white"
set output images . "/vehicle_validation.png"
set multiplot layout 2,2 margins 0.075,0.98,0.075,0.87 spacing 0.09,0.08
set label 1 "The BMW 320i beside CommonRoad's multi-body model" at screen 0.53,0.973 center font ",14"
# What the lines are, above all panels.
array names[4] = ["CommonRoad, multi-body", "kinematic", "single_track", "mujoco:magic_formula"]
array starts[4] = [0.14, 0.39, 0.53, 0.69]
do for [i = 1:4] { set label 1 + i names[i] at screen starts[i] + 0.045,0.935 left }
set arrow 1 from screen starts[1],0.935 to screen starts[1] + 0.035,0.935 nohead lw 6 lc rgb "#c0c0c0"
set arrow 2 from screen starts[2],0.935 to screen starts[2] + 0.035,0.935 nohead lw 1.8 dt 3 lc rgb black
set arrow 3 from screen starts[3],0.935 to screen starts[3] + 0.035,0.935 nohead lw 1.8 dt 2 lc rgb blue
set arrow 4 from screen starts[4],0.935 to screen starts[4] + 0.035,0.935 nohead lw 2 lc rgb red
do for [quantity = 1:2] {
  do for [name in "step_steer lane_change"] {
    set title (quantity == 1 ? (name eq "step_steer" ? "Step steer at 20 m/s" : "Lane change at 15 m/s") : "") font ",12"
    set xlabel (quantity == 2 ? "time [s]" : "")
    set ylabel (name eq "lane_change" ? "" : quantity == 1 ? "yaw rate [rad/s]" : "lateral acceleration [m/s²]")
    column_name = quantity == 1 ? "yaw_rate_radps" : "lateral_acceleration_mps2"
    reference_column = quantity == 1 ? "yaw_rate_radps" : "ay_mps2"
    last = name eq "step_steer" ? 4 : 7
    set xrange [0:last]
    if (name eq "step_steer") {
      if (quantity == 1) { set yrange [-0.02:0.26]; set ytics 0.05 } else { set yrange [-0.4:5.2]; set ytics 1 }
    } else {
      if (quantity == 1) { set yrange [-0.26:0.26]; set ytics 0.1 } else { set yrange [-4.2:4.2]; set ytics 1 }
    }
    shown(t) = t > last ? NaN : t
    plot reference(name) using (shown(column("t_s"))):reference_column with lines lw 6 lc rgb "#c0c0c0", \
         car(name, "kinematic") using (shown(column("t_s"))):column_name with lines lw 1.8 dt 3 lc rgb black, \
         car(name, "single_track") using (shown(column("t_s"))):column_name with lines lw 1.8 dt 2 lc rgb blue, \
         car(name, "mujoco") using (shown(column("t_s"))):column_name with lines lw 2 lc rgb red
    unset label
    unset arrow
  }
}
unset multiplot
