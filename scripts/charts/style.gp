# What all charts share. Colours: blue is Backlight, orange and green are others, red marks where a method fails.
set datafile separator ","
set datafile missing NaN
set terminal pngcairo size 1400,1000 font "DejaVu Sans,12" background rgb "white"
set grid lc rgb "#e4e4e4" lw 1
set border lc rgb "#777777"
set tics textcolor rgb "#333333"
set key font ",11" Left reverse textcolor rgb "#333333"
blue = "#1f5fbf"; sky = "#6fa8e8"; orange = "#d9822b"; amber = "#f0b860"; green = "#3c9a5f"; grey = "#888888"; red = "#d62728"; violet = "#7d4fb0"
# A value to draw on a logarithmic scale: never below the floor.
floored(x, low) = x > low ? x : low
