# The figure of robustness.md; made by scripts/figures, which runs the study and sorts its rows first.
load "docs/style.gp"
bins(parameter) = runs . "/" . parameter . ".csv"
set terminal pngcairo noenhanced size 1200,760 font "sans,12" background "white"
set output images . "/robustness.png"
set multiplot layout 2,2 margins 0.06,0.98,0.09,0.92 spacing 0.07,0.14 title "ISO 3888-1: share of the runs that pass" font ",14"
unset title
set format y "%.0f %%"
set yrange [0:100]
set ytics 20
# The first two are one line.
shares(parameter) = sprintf("plot for [i=3:5] '%s' using 1:(100*column(i)) with lines lw 2.4 lc rgb word(colors, i - 2)", \
                            bins(parameter))
colors = sprintf("%s %s %s", blue, purple, green)

set xlabel "speed [m/s]"
set xrange [12:20]
set label 1 "preview, pure_pursuit" at graph 0.66,0.94 textcolor rgb blue
set label 2 "stanley" at graph 0.66,0.87 textcolor rgb purple
set label 3 "lqr" at graph 0.66,0.80 textcolor rgb green
eval shares("speed")
unset label
set xlabel "delay of the steering [s]"
set xrange [0:0.2]
eval shares("delay")
set xlabel "friction, share of the dry road's"
set xrange [0.4:1]
eval shares("friction")
set xlabel "side wind [m/s]"
set xrange [-18:18]
eval shares("wind")
unset multiplot
