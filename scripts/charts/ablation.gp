# Chart (g): each piece of the model left out of each figure: time that is left, and error made.
set terminal pngcairo size 1500,920
set output folder."/ablation.png"
data = folder."/ablation.csv"
pieces = "'light delay' 'colour shift' 'searchlight effect' 'searchlight: as in the paper' 'shadows' 'retarded shadows: those of one moment' 'robust arithmetic' '40 of 56 wavelengths' 'SIMD: two lanes instead of the widest' 'sheets and cones: every ray asks every frame'"
scenes = system("awk -F, 'NR > 1 && !seen[$1]++ {printf \"%s \", $1}' ".data)
colour(i) = word("#1f5fbf #d9822b #3c9a5f #7d4fb0 #888888 #b03a6b #2aa0a4 #8c6d31 #000000 #e07b91 #5b8c2a", i)
place(p) = (p eq word(pieces,1) ? 1 : p eq word(pieces,2) ? 2 : p eq word(pieces,3) ? 3 : p eq word(pieces,4) ? 4 : p eq word(pieces,5) ? 5 : p eq word(pieces,6) ? 6 : p eq word(pieces,7) ? 7 : p eq word(pieces,8) ? 8 : p eq word(pieces,9) ? 9 : p eq word(pieces,10) ? 10 : NaN)
set multiplot layout 1,2 title "The model, piece by piece: what leaving it out saves, and what it spoils" font ",15"
set yrange [10.6:0.4]
set ytics ("light delay" 1, "colour shift" 2, "searchlight effect" 3, "searchlight as in the paper" 4, "shadows" 5, "retarded shadows" 6, "robust arithmetic" 7, "40 of 56 wavelengths" 8, "SIMD: two lanes" 9, "sheets and cones" 10)
set xlabel "root mean square error of the image (1: from black to white)"
set logscale x
set format x "10^{%T}"
set xrange [3e-7:20]
unset key
set lmargin at screen 0.17; set rmargin at screen 0.56; set bmargin at screen 0.09; set tmargin at screen 0.92
set arrow 1 from 0.004,graph 0 to 0.004,graph 1 nohead dt 3 lc rgb red
set label 1 "a step of an 8-bit picture" at 0.0032,0.6 right font ",10" textcolor rgb red
spread(i) = (i - 6)*0.06
plot for [i=1:words(scenes)] data using (strcol(1) eq word(scenes, i) ? floored(column(5), 5e-7) : NaN):(place(strcol(2)) + spread(i)) \
  with points pt 7 ps 1.3 lc rgb colour(i) title word(scenes, i)
unset arrow 1; unset label 1
set ytics ("" 1, "" 2, "" 3, "" 4, "" 5, "" 6, "" 7, "" 8, "" 9, "" 10)
set lmargin at screen 0.59; set rmargin at screen 0.985
set xlabel "time left / time of everything"
set format x "%g"
set xrange [0.02:60]
set key right center font ",11"
set arrow 2 from 1,graph 0 to 1,graph 1 nohead lc rgb grey
plot for [i=1:words(scenes)] data using (strcol(1) eq word(scenes, i) ? column(4) : NaN):(place(strcol(2)) + spread(i)) \
  with points pt 7 ps 1.3 lc rgb colour(i) title word(scenes, i), \
  for [i=1:words(scenes)] data using (strcol(1) eq word(scenes, i) && column(5) == 0 && column(4) < 0.9 ? column(4) : NaN):(place(strcol(2)) + spread(i)) \
  with points pt 6 ps 2.4 lw 1.5 lc rgb red title (i == 1 ? "slower with it, for nothing" : "")
unset multiplot
