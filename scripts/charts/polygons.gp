# Chart (h): polygons with their corners at their apparent places, against rays.
set terminal pngcairo size 1500,620
set output folder."/polygons.png"
set multiplot layout 1,3 title "Polygons whose corners are sent to their apparent places, beside rays" font ",15"
data = folder."/polygons.csv"
betas = "0 0.5 0.9 0.99"
colour(i) = word("#888888 #3c9a5f #d9822b #7d4fb0", i)
of(i, method) = (strcol(1) eq word(betas, i) && strcol(2) eq method)
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xlabel "triangles"
set key right top
set ylabel "places within bodies: error in pixels (99 % are better)"
set yrange [1e-4:10]
plot for [i=2:4] data using (of(i, "polygons") ? column(3) : NaN):(column(7)) with linespoints pt 7 ps 1 lw 1.8 lc rgb colour(i) title word(betas, i)." c"
set ylabel "outlines: share of pixels that show another body"
set yrange [1e-5:1]
plot for [i=1:4] data using (of(i, "polygons") ? column(3) : NaN):(column(5)) with linespoints pt 7 ps 1 lw 1.8 lc rgb colour(i) title word(betas, i)." c"
set ylabel "CPU seconds"
set yrange [1e-5:1]
set key left top
first(i) = system(sprintf("awk -F, '$1 == \"%s\" && $2 == \"rays\" {print $4}' '%s'", word(betas, i), data))
plot for [i=1:4] data using (of(i, "polygons") ? column(3) : NaN):4 with linespoints pt 7 ps 1 lw 1.8 lc rgb colour(i) title "polygons, ".word(betas, i)." c", \
  for [i=1:4] real(first(i)) with lines dt 2 lw 1.4 lc rgb colour(i) title "rays, ".word(betas, i)." c"
unset multiplot
