# What the figures of docs/ have in common; each loads it. The colors are those of Okabe and Ito, which color-blind
# readers tell apart: blue for the kinematic car, vermilion for MuJoCo's.
set datafile separator ","
set encoding utf8
set border lc rgb "#606060"
set tics nomirror textcolor rgb "#303030"
set grid lt 1 lw 1 lc rgb "#e0e0e0"
set title font ",14"
unset key
black = "#202020"
gray = "#8a8a8a"
blue = "#0072b2"
sky = "#56b4e9"
green = "#009e73"
orange = "#c07c00"
red = "#d55e00"
purple = "#a2528a"
light_blue = "#b7d5e8"
light_orange = "#f7d9a0"
light_green = "#a8d9c8"
# A picture in meters, with equal scales.
map_of(title) = sprintf("set title '%s'; set size ratio -1; set xlabel 'x [m]'; set ylabel 'y [m]'", title)
