# The figures of real-cars.md; made by scripts/figures, which runs the scenarios and sorts by lateral acceleration first.
load "docs/style.gp"
run(plant) = runs . "/free_driving_b/" . plant . ".csv"
bins(record) = runs . "/" . record . "/bins.csv"

set terminal pngcairo noenhanced size 1200,460 font "sans,12" background "white"
set output images . "/dart_yaw_rate.png"
set title "DART, free driving b: the commands of the recording on three plants"
set xlabel "time [s]"
set ylabel "yaw rate [rad/s]"
set xrange [15.5:27.5]
set yrange [-8.2:7]
set xtics 1
set ytics 2
# Right of a bend to the left, each as high as its curve there; the measured one has an arrow, for MuJoCo's covers it.
set label 1 "kinematic" at 23.3,5.5 textcolor rgb blue
set label 2 "single_track" at 23.3,4.5 textcolor rgb green
set label 3 "mujoco" at 23.3,3.1 textcolor rgb red
set label 4 "measured" at 19.2,-1.7 center textcolor rgb "#606060"
set arrow 4 from 19.2,-2.1 to 19.2,-3.1 nohead lc rgb gray
set arrow 1 from 23.25,5.5 to 22.5,5.0 nohead lc rgb blue
set arrow 2 from 23.25,4.5 to 22.75,4.45 nohead lc rgb green
set arrow 3 from 23.25,3.1 to 22.95,3.1 nohead lc rgb red
plot run("recorded") using "t_s":"yaw_rate_radps" with lines lw 6 lc rgb "#b8b8b8", \
     run("kinematic") using "t_s":"yaw_rate_radps" with lines lw 1.8 lc rgb blue, \
     run("single_track") using "t_s":"yaw_rate_radps" with lines lw 1.8 lc rgb green, \
     run("mujoco") using "t_s":"yaw_rate_radps" with lines lw 2 lc rgb red
unset label
unset arrow

set output images . "/dart_kinematic_validity.png"
set title "DART in steady bends: how far v tan δ / L is above the measured yaw rate"
set xlabel "lateral acceleration [m/s²]"
set ylabel ""
set format y "%.0f %%"
set xrange [0:8.9]
set yrange [0:105]
set xtics 1
set ytics 20
set label 1 "ramp_02" at 5.35,46 right textcolor rgb green
set label 2 "ramp_neg03" at 7.4,97 right textcolor rgb purple
set label 3 "free_driving_b" at 7.65,67.3 left textcolor rgb red
set label 4 "free_driving_a" at 7.65,46.1 left textcolor rgb blue
set label 5 "10 %" at 8.85,12.5 right textcolor rgb "#606060" font ",10"
set label 6 "20 %" at 8.85,22.5 right textcolor rgb "#606060" font ",10"
plot 10 with lines lw 1 dt 2 lc rgb gray, 20 with lines lw 1 dt 2 lc rgb gray, \
     bins("ramp_02") using 1:(100*column(6)) with linespoints pt 7 lw 2 lc rgb green, \
     bins("ramp_neg03") using 1:(100*column(6)) with linespoints pt 7 lw 2 lc rgb purple, \
     bins("free_driving_b") using 1:(100*column(6)) with linespoints pt 7 lw 2 lc rgb red, \
     bins("free_driving_a") using 1:(100*column(6)) with linespoints pt 7 lw 2 lc rgb blue
