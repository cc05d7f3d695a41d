# Figure 4: equation (1) for v/c = 0, 0.75 and 0.99, with the edges of the balls of scenes/fig4-aberration.toml as rendered.
# Called by scripts/gallery.sh:  gnuplot -e "data='out/gallery/fig4-aberration.dat'; picture='fig4-aberration.png'" fig4_aberration.gp
set terminal pngcairo size 720,600 font "sans,12"
set output picture
beta(a, v) = 2*atan(sqrt((1 - v)/(1 + v))*tan(a/2))
deg = pi/180
set xrange [0:pi]
set yrange [0:pi]
set xtics ("0" 0, "30°" 30*deg, "60°" 60*deg, "90°" 90*deg, "120°" 120*deg, "150°" 150*deg, "180°" pi)
set ytics ("0" 0, "30°" 30*deg, "60°" 60*deg, "90°" 90*deg, "120°" 120*deg, "150°" 150*deg, "180°" pi)
set grid lc rgb "#dddddd"
set size ratio 1
set samples 2000
set key left top Left reverse
set title "Aberration: where a moving camera sees what is at {/Symbol a}"
set xlabel "{/Symbol a}, angle from the direction of flight at rest"
set ylabel "{/Symbol b}, the same as the camera sees it"
# Left of this angle the slope is below 1: what is there is shrunk. For v = 0.99c it is 2.6 rad, as the paper says.
magnified(v) = 2*atan(((1 + v)/(1 - v))**0.25)
set arrow 1 from magnified(0.99),0 to magnified(0.99),pi nohead dt 3 lc rgb "#888888"
set label 1 "shrunk at 0.99c" at magnified(0.99) - 0.04, 5*deg right textcolor rgb "#666666"
set label 2 "enlarged" at magnified(0.99) + 0.04, 5*deg left textcolor rgb "#666666"
plot for [i=0:2] v = word("0 0.75 0.99", i+1)+0 beta(x, v) lw 2 lc i+1 title sprintf("equation (1), v = %s c", word("0 0.75 0.99", i+1)), \
     for [i=0:2] data index i using ($2*deg):($3*deg) with points pt 6 ps 0.7 lc i+1 notitle, \
     NaN with points pt 6 ps 0.7 lc rgb "black" title "edges of balls in rendered images"
