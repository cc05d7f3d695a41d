# Chart (f): time of a frame by objects, pixels and threads.
set terminal pngcairo size 1500,620
set output folder."/scaling.png"
set multiplot layout 1,3 title "Whole frames, one shadowing lamp: what more objects, pixels and threads cost" font ",15"
data = folder."/objects.csv"
scenes = "fig2b-tram-terrell fig7-tram-shadow fig1-tram-interior default"
kinds = "'at rest' '1 moving frame' '8 moving frames' '64 moving frames' 'every one its own'"
colour(i) = word("#888888 #3c9a5f #7d4fb0 #d9822b #1f5fbf", i)
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xlabel "spheres (360x263 pixels)"
set ylabel "CPU seconds"
set xrange [8:1.3e5]
set key left top font ",10"
set yrange [1e-3:1e3]
plot for [i=1:5] data using (strcol(1) eq word(kinds, i) && strcol(2) eq "sheets" ? column(3) : NaN):4 \
    with linespoints pt 7 ps 1 lw 1.8 lc rgb colour(i) title word(kinds, i), \
  data using (strcol(2) eq "one by one" ? column(3) : NaN):4 with linespoints pt 6 ps 1.6 lw 1.4 dt 2 lc rgb red title "every ray asks every frame: fails to scale"
set xlabel "pixels (200 spheres, and real scenes)"
set xrange [*:*]
set yrange [*:*]
plot for [kind in "at_rest moving"] folder."/pixels.csv" using (strcol(1) eq (kind eq "moving" ? "moving" : "at rest") ? column(4) : NaN):5 \
    with linespoints pt 7 ps 1 lw 1.8 lc rgb (kind eq "moving" ? blue : grey) title (kind eq "moving" ? "spheres, every one its own velocity" : "spheres at rest"), \
  for [i=1:words(scenes)] folder."/scenes.csv" using (strcol(1) eq word(scenes, i) ? column(7) : NaN):8 \
    with linespoints pt 6 ps 1 lw 1.4 lc rgb word("#3c9a5f #d9822b #7d4fb0 #d62728", i) title word(scenes, i)
unset logscale
set format "%g"
set xlabel "threads"
set ylabel "times as fast as one thread"
set xrange [0.8:*]
set yrange [0:*]
set xtics 1
plot x with lines dt 2 lc rgb grey title "in proportion", \
  folder."/threads.csv" using (strcol(1) eq "200 moving spheres" ? column(2) : NaN):4 with linespoints pt 7 ps 1.4 lw 1.8 lc rgb blue title "200 moving spheres", \
  folder."/threads.csv" using (strcol(1) eq "fig7-tram-shadow" ? column(2) : NaN):4 with linespoints pt 6 ps 1.4 lw 1.8 lc rgb orange title "fig7-tram-shadow"
unset multiplot
