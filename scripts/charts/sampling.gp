# Chart (d): error against time, uniform samples and adaptive ones, each figure. A red ring: the error is more than what was asked for.
set terminal pngcairo size 1500,1500
set output folder."/sampling.png"
data = folder."/dial.csv"
scenes = system("awk -F, 'NR > 1 && !seen[$1]++ {printf \"%s \", $1}' ".data)
set multiplot layout 4,3 title "Sampling: error against time (better: down and to the left)" font ",15"
set logscale xy
set format y "10^{%T}"
set format x "10^{%T}"
set xlabel "CPU seconds"
set ylabel "root mean square error"
do for [i=1:words(scenes)] {
  name = word(scenes, i)
  set title name font ",12"
  if (i == 1) { set key left bottom } else { unset key }
  plot data using (strcol(1) eq name && strcol(2) eq "uniform" ? column(4) : NaN):(floored(column(6), 1e-6)) with linespoints pt 5 ps 1.1 lw 1.8 lc rgb orange title "uniform", \
    data using (strcol(1) eq name && strcol(2) eq "tolerance" ? column(4) : NaN):(floored(column(6), 1e-6)) with linespoints pt 7 ps 1.1 lw 1.8 lc rgb blue title "adaptive, by tolerance", \
    data using (strcol(1) eq name && strcol(2) eq "tolerance" && column(6) > column(3) ? column(4) : NaN):6 with points pt 6 ps 2.6 lw 1.6 lc rgb red title "misses what was asked for"
}
unset multiplot
