# Chart (e): the error delivered by the error asked for, and what it takes.
set terminal pngcairo size 1500,700
set output folder."/dial.png"
data = folder."/dial.csv"
scenes = system("awk -F, 'NR > 1 && !seen[$1]++ {printf \"%s \", $1}' ".data)
colour(i) = word("#1f5fbf #d9822b #3c9a5f #7d4fb0 #888888 #b03a6b #2aa0a4 #8c6d31 #000000 #e07b91 #5b8c2a", i)
set multiplot layout 1,2 title "The dial: what --tolerance asks for, delivers and takes" font ",15"
set logscale xy
set format x "%g"
set format y "10^{%T}"
set xrange [0.003:0.15]
set xlabel "tolerance"
set ylabel "root mean square error delivered"
set yrange [1e-5:1]
set key left top font ",10"
plot x with lines lw 1.5 dt 2 lc rgb grey title "as asked", \
  for [i=1:words(scenes)] data using (strcol(1) eq word(scenes, i) && strcol(2) eq "tolerance" ? column(3) : NaN):(floored(column(6), 2e-5)) \
    with linespoints pt 7 ps 0.9 lw 1.6 lc rgb colour(i) title word(scenes, i), \
  data using (strcol(2) eq "tolerance" && column(6) > column(3) ? column(3) : NaN):6 with points pt 6 ps 2.6 lw 1.6 lc rgb red title "more than what was asked"
set ylabel "CPU seconds, 128x94"
set yrange [*:*]
unset key
plot for [i=1:words(scenes)] data using (strcol(1) eq word(scenes, i) && strcol(2) eq "tolerance" ? column(3) : NaN):4 \
    with linespoints pt 7 ps 0.9 lw 1.6 lc rgb colour(i) notitle
unset multiplot
