# Chart (c): colour error by rule and number of wavelengths, over what a frame costs in multiples of its RGB version.
set terminal pngcairo size 1400,620
set output folder."/wavelengths.png"
data = folder."/wavelengths.csv"
cost = folder."/wavelengths-cost.csv"
# What a frame costs with n wavelengths: of the file, in between straight lines are not needed since both have the same n.
times(n) = real(system(sprintf("awk -F, -v n=%d '$1 == n {print $3} END {}' %s", n, cost)))
set multiplot layout 1,2 title "Wavelengths: what a colour is off, and what a frame of figure 7 costs" font ",15"
rules = "'Backlight' 'midpoints' 'trapezia' 'Gauss-Legendre'"
colour(i) = word("#1f5fbf #d9822b #3c9a5f #7d4fb0", i)
point(i) = int(word("7 5 9 12", i))
set logscale y
set xlabel "CPU time / that of red, green and blue"
set xrange [0.9:*]
set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead dt 3 lc rgb red
set label 1 "just noticeable" at graph 0.98,first 1.25 right font ",10" textcolor rgb red
do for [panel=1:2] {
  set ylabel word("'worst CIEDE2000' 'mean CIEDE2000'", panel)
  if (panel == 1) { set key left bottom } else { unset key }
  c = panel == 1 ? 5 : 3
  plot for [i=1:4] data using (strcol(1) eq word(rules, i) ? times(column(2)) : NaN):(strcol(1) eq word(rules, i) ? column(c) : NaN) \
      with linespoints pt point(i) ps 1.3 lw 1.8 lc rgb colour(i) title word(rules, i), \
    data using (strcol(1) eq "Backlight" && (int(column(2)) % 16 == 0 || int(column(2)) == 56 || int(column(2)) == 8) ? times(column(2)) : NaN):(column(c)):(sprintf("%d", column(2))) \
      with labels offset 0,-1 font ",10" textcolor rgb "#1f5fbf" notitle, \
    data using (strcol(1) eq "three lines" ? 1 : NaN):(column(c)) with points pt 3 ps 2 lw 2 lc rgb red title "three lines instead of spectra: fails", \
    data using (strcol(1) ne "three lines" && panel == 1 && column(5) > 5 ? times(column(2)) : NaN):(column(c)) with points pt 6 ps 2.6 lw 1.6 lc rgb red title "plainly wrong somewhere"
}
unset multiplot
