# Chart (a): rays a second against the worst error of a hit. A red ring: roots missed or invented.
set terminal pngcairo size 1500,1560
set output folder."/roots.png"
data = folder."/roots.csv"
surfaces = "sphere|torus|Steiner's surface|Barth's sextic|Klein bottle|Chmutov's octic (composed)|Chmutov's octic (expanded)|gyroid"
surface(i) = system(sprintf("echo \"%s\" | cut -d'|' -f%d", surfaces, i))
set multiplot layout 3,3 title "Root finders: how many rays a second, and how far off the worst hit is (better: up and to the left)" font ",15"
set logscale xy
set format x "10^{%T}"
set format y "10^{%T}"
set xrange [1e-17:5]
set yrange [50:1e8]
set ytics 1e2,10
set xtics 1e-16,1e4,1
set xlabel "worst error of a hit / size"
set ylabel "rays a second, one thread"
unset key
wrong(i) = (strcol(1) eq name ? column(6) + column(7) : 0)
# Where every root was missed there is no error to show: at the right edge.
at(text) = (text eq "nan" || text eq "-nan" ? 1.5 : floored(real(text), 1e-17))
begins(a, b) = (strlen(a) >= strlen(b) && a[1:strlen(b)] eq b)
is(method) = (strcol(1) eq name && strcol(2) eq method)
own(m, finder) = begins(m, "Backlight: ".finder)
own_closed(m) = (m eq "Backlight: torus" || m eq "Backlight: sphere" || m eq "Backlight: quartic")
iso(m) = begins(m, "POV-Ray: isosurface 1")
do for [i=1:8] {
  name = surface(i)
  set title name font ",13"
  plot data using (strcol(1) eq name && column(6) + column(7) > 0 ? at(strcol(4)) : NaN):3 with points pt 6 ps 3.4 lw 2 lc rgb red notitle, \
    data using (strcol(1) eq name && column(6) + column(7) > 0 ? at(strcol(4)) : NaN):3:(sprintf("%d wrong", column(6) + column(7))) \
      with labels offset 0,-1.5 font ",9" textcolor rgb red notitle, \
    data using (strcol(1) eq name && iso(strcol(2)) ? at(strcol(4)) : NaN):3 with linespoints pt 9 ps 1.6 lw 1.5 lc rgb green notitle, \
    data using (strcol(1) eq name && iso(strcol(2)) ? at(strcol(4)) : NaN):3:(substr(strcol(2), 21, 24)) with labels offset 0,0.9 font ",9" textcolor rgb green notitle, \
    data using (is("POV-Ray: isosurface as it comes") ? at(strcol(4)) : NaN):3 with points pt 8 ps 1.6 lw 1.5 lc rgb green notitle, \
    data using (is("POV-Ray: polynomial") ? at(strcol(4)) : NaN):3 with points pt 5 ps 1.5 lc rgb orange notitle, \
    data using (is("POV-Ray: polynomial sturm") ? at(strcol(4)) : NaN):3 with points pt 4 ps 1.5 lw 2 lc rgb orange notitle, \
    data using (is("POV-Ray: torus") || is("POV-Ray: sphere") ? at(strcol(4)) : NaN):3 with points pt 13 ps 1.9 lc rgb amber notitle, \
    data using (is("POV-Ray: torus sturm") ? at(strcol(4)) : NaN):3 with points pt 12 ps 1.9 lw 2 lc rgb amber notitle, \
    data using (is("64 samples and bisection") ? at(strcol(4)) : NaN):3 with points pt 2 ps 1.5 lw 2 lc rgb grey notitle, \
    data using (strcol(1) eq name && own(strcol(2), "interval") ? at(strcol(4)) : NaN):3 with points pt 6 ps 2.1 lw 2 lc rgb blue notitle, \
    data using (strcol(1) eq name && own(strcol(2), "reduced affine") ? at(strcol(4)) : NaN):3 with points pt 10 ps 2.1 lw 2 lc rgb blue notitle, \
    data using (strcol(1) eq name && own(strcol(2), "polynomial") ? at(strcol(4)) : NaN):3 with points pt 12 ps 2.1 lw 2 lc rgb blue notitle, \
    data using (strcol(1) eq name && strstrt(strcol(2), "(chosen)") > 0 ? at(strcol(4)) : NaN):3 with points pt 7 ps 0.9 lc rgb blue notitle, \
    data using (strcol(1) eq name && own_closed(strcol(2)) ? at(strcol(4)) : NaN):3 with points pt 15 ps 2.1 lc rgb sky notitle
}
unset title; unset xlabel; unset ylabel; unset tics; unset border; unset grid
unset logscale; set xrange [0:1]; set yrange [0:1]
set key at graph 0.0,0.95 left top Left reverse font ",13" spacing 1.5
plot NaN with points pt 6 ps 2 lw 2 lc rgb blue title "Backlight, formula: intervals and slopes", NaN with points pt 10 ps 2 lw 2 lc rgb blue title "Backlight, formula: reduced affine forms", \
  NaN with points pt 12 ps 2 lw 2 lc rgb blue title "Backlight, formula: polynomial along the ray", NaN with points pt 7 ps 0.9 lc rgb blue title "the one of these that is chosen", NaN with points pt 15 ps 2 lc rgb sky title "Backlight, sphere and torus shapes", \
  NaN with points pt 5 ps 1.5 lc rgb orange title "POV-Ray polynomial", NaN with points pt 4 ps 1.5 lw 2 lc rgb orange title "POV-Ray polynomial sturm", \
  NaN with points pt 13 ps 1.9 lc rgb amber title "POV-Ray sphere, torus", NaN with points pt 12 ps 1.9 lw 2 lc rgb amber title "POV-Ray torus sturm", \
  NaN with points pt 9 ps 1.6 lc rgb green title "POV-Ray isosurface, by its accuracy", NaN with points pt 8 ps 1.6 lw 1.5 lc rgb green title "POV-Ray isosurface, gradient not told", \
  NaN with points pt 2 ps 1.5 lw 2 lc rgb grey title "64 samples and bisection", NaN with points pt 6 ps 3 lw 2 lc rgb red title "misses roots or invents them"
unset multiplot
