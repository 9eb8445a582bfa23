# Figures of speed-profile.md; made by scripts/figures, which prints the diagrams and runs the scenario first.
load "docs/style.gp"
set terminal pngcairo size 1000,520 font "sans,12" background "white"
set output images . "/ggv_diagrams.png"
set multiplot layout 1,2 margins 0.08,0.98,0.12,0.9 spacing 0.1
set xrange [0:11]
set yrange [-10:7]
set xlabel "lateral acceleration [m/s^2]"
set ylabel "longitudinal acceleration [m/s^2]"
speeds = "0 20 40 60"
colors = blue . " " . green . " " . orange . " " . red
set key top right samplen 1.5
array names[2] = ["prius", "bmw320i"]
array titles[2] = ["Prius, front-wheel drive", "BMW 320i, rear-wheel drive"]
do for [car = 1:2] {
  set title titles[car]
  plot for [i = 1:words(speeds)] runs . "/ggv_" . names[car] . ".csv" \
       using (column("speed_mps") == real(word(speeds, i)) ? column("lateral_acceleration_mps2") : NaN):"longitudinal_acceleration_mps2" \
       with lines lw 2 lc rgb word(colors, i) title word(speeds, i) . " m/s"
}
unset multiplot

set terminal pngcairo size 1000,620 font "sans,12" background "white"
set output images . "/speed_at_limit.png"
set multiplot layout 2,1 margins 0.08,0.98,0.1,0.93 spacing 0.09
run = runs . "/at_the_limit"
set xrange [0:*]
set yrange [0:*]
set xlabel ""
set ylabel "speed [m/s]"
set title "at\\_the\\_limit: nine tenths of the diagram"
set key top left samplen 2
plot run . "/plan.csv" using "s_m":"speed_mps" with lines lw 5 lc rgb light_blue title "plan", \
     run . "/kinematic.csv" using "s_m":"speed_mps" with lines lw 1.5 lc rgb blue title "kinematic", \
     run . "/mujoco.csv" using "s_m":"speed_mps" with lines lw 1.5 lc rgb red title "MuJoCo, Magic Formula"
unset title
unset key
set yrange [-10:10]
set xlabel "station [m]"
set ylabel "acceleration [m/s^2]"
set label 1 "lateral" at graph 0.02,0.92 tc rgb red
set label 2 "longitudinal" at graph 0.02,0.08 tc rgb black
plot run . "/mujoco.csv" using "s_m":"lateral_acceleration_mps2" with lines lw 1.2 lc rgb red, \
     run . "/mujoco.csv" using "s_m":"longitudinal_acceleration_mps2" with lines lw 1.2 lc rgb black
