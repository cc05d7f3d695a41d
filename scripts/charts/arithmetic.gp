# Chart (b): errors of D, direction and hit, and the cost, by Lorentz factor. A red ring: more than 1 % off, or the sphere missed.
set output folder."/arithmetic.png"
data = folder."/arithmetic.csv"
set multiplot layout 2,2 title "Arithmetic: the worst of a boost, by the Lorentz factor of the motion" font ",15"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xlabel "{/Symbol g}"
set xrange [1:2e8]
methods = "'float' 'double from velocity' 'double' 'Backlight' 'double-double'"
colour(i) = word("#888888 #3c9a5f #d9822b #1f5fbf #7d4fb0", i)
point(i) = int(word("4 8 5 7 12", i))
error(m, c) = (strcol(1) eq m && !(c == 5 && column(6) == column(7)) ? floored(column(c), 3e-17) : NaN)
failed(m, c) = (strcol(1) eq m && (column(c) > 0.01 || column(c) != column(c)) ? (column(c) < 30 ? column(c) : 30) : NaN)
top(m, c) = (error(m, c) > 30 ? 30 : error(m, c))
set yrange [2e-17:100]
set arrow 1 from 30,graph 0 to 30,graph 1 nohead dt 3 lc rgb grey
set label 1 "{/Symbol g} = 30" at 36,graph 0.96 font ",10" textcolor rgb grey
do for [panel=1:3] {
  column = panel + 2
  set ylabel word("'relative error of D' 'error of the direction (radians)' 'distance from the true hit / radius'", panel)
  unset key
  plot for [i=1:5] data using 2:(failed(word(methods, i), column)) with points pt 6 ps 2.6 lw 1.6 lc rgb red notitle, \
    for [i=1:5] data using 2:(top(word(methods, i), column)) with linespoints pt point(i) ps 1.2 lw 1.8 lc rgb colour(i) title word(methods, i), \
    data using 2:(panel == 3 && column(6) > 0 ? 30 : NaN) with points pt 6 ps 2.6 lw 1.6 lc rgb red notitle
}
set ylabel "nanoseconds a boost, one thread"
set yrange [0.01:500]
set format y "%g"
unset arrow 1
set key at graph 0.97,0.47 right top
plot for [i=1:5] data using 2:(strcol(1) eq word(methods, i) ? column(8) : NaN) with linespoints pt point(i) ps 1.2 lw 1.8 lc rgb colour(i) title word(methods, i), \
  NaN with points pt 6 ps 2.2 lw 1.6 lc rgb red title "more than 1 % off; at the top: hits lost"
unset multiplot
