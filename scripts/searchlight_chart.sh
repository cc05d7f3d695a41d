#!/usr/bin/env bash
# Draws docs/images/searchlight.png: the exact searchlight factor against the seed paper's, over angle and speed.
# The curves are equation (7) of docs/physics.md; needs gnuplot (Debian package gnuplot-nox).
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p docs/images
gnuplot <<'GNUPLOT'
set terminal pngcairo size 1200,520 font "sans,12"
set output "docs/images/searchlight.png"
set multiplot layout 1,2
g(v) = 1/sqrt(1 - v*v)
# D for an object that moves with speed v at angle a (degrees) between its velocity and the line towards the camera, as seen by the camera.
D(v, a) = 1/(g(v)*(1 - v*cos(a*pi/180)))
exact(v, a) = D(v, a)**4
paper(v, a) = g(v)*D(v, a)**3
set logscale y
set format y "10^{%T}"
set grid lc rgb "#dddddd"
set xrange [0:180]
set xtics 30
set xlabel "angle between velocity and line of sight (degrees): 0 = approaching"
set ylabel "radiance / radiance at rest"
set key top right
set title "Searchlight factor F: exact (lines), paper (dashes)"
set samples 400
plot for [i=1:3] v = word("0.5 0.9 0.99", i)+0 exact(v, x) lw 2 lc i title sprintf("v = %s c", word("0.5 0.9 0.99", i)), \
     for [i=1:3] v = word("0.5 0.9 0.99", i)+0 paper(v, x) lw 2 lc i dt 2 notitle
unset logscale y
set format y "%g"
set logscale y
set title "paper / exact = {/Symbol g}/D"
set ylabel "ratio"
set xrange [0:0.99]
set xtics 0.2
set xlabel "speed v/c"
set key top left
plot for [i=1:4] a = word("0 60 90 180", i)+0 g(x)/D(x, a) lw 2 lc i title sprintf("%s degrees", word("0 60 90 180", i))
unset multiplot
GNUPLOT
echo "docs/images/searchlight.png"
