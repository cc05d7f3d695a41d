#!/usr/bin/env bash
# Measures whole frames beside other tracers, on this machine: POV-Ray 3.7 and Embree 3.13, and Backlight at rest and moving. Runs
# are interleaved, so that whatever else the machine does falls on all alike; the table has medians and their ratios, out/bench.csv
# every run. Asserts nothing. Some five minutes, on a machine that should have nothing else to do.
#
#   scripts/bench.sh [--rounds N] [--quick] [--record] [ROW ...]
#
#   --rounds N   runs of each (default 5)
#   --quick      2 runs, and no row that takes longer than some seconds
#   --record     writes the table into docs/charts/beside.csv too, from which scripts/charts.sh makes that of docs/speed-accuracy.md
#   ROW          only these:
#
#     spheres      200 spheres that all move otherwise, and at rest, beside POV-Ray and Embree
#     torus, barth, gyroid        one curved surface at 0.8c beside POV-Ray's at rest
#     motion       the cost of motion: the spheres, and those of the three above that are measured too
#     spectral     the spheres with shifted colours, beside red, green and blue
#     many         10 000 spheres beside 200
#     circling     1000 spheres on circles beside 1000 on straight ways, with shadows and without
#     threads      the spheres on two threads beside one, at 2880x2104
#     fig2a fig2b fig7 fig1 default flicker
#                  real scenes (scenes/, all effects that they have, one sample) beside their twins at rest in POV-Ray, which
#                  bench/povray_twin.py writes: the same shapes, lamps and shadows. Any other scene's twin: python3 bench/povray_twin.py
#     algebraic    formulas at 0.9c: millions of camera rays a second
#     big-fig7     fig7 on two threads beside one, 1920x1080, 16 samples
#     process      200 moving spheres at 2880x2104: the whole process beside POV-Ray's
#     memory, startup             of the whole process
#
# The kernels by themselves: build/bench/bench/kernels and build/bench/bench/implicit.
set -euo pipefail
cd "$(dirname "$0")/.."
for argument in "$@"; do [[ $argument == -h || $argument == --help ]] && sed -n '2,28s/^# \{0,1\}//p' scripts/bench.sh && exit 0; done

scripts/install.sh build bench
cmake --preset bench >/dev/null
cmake --build --preset bench --target backlight backlight_oiio backlight_models sphere_field embree_spheres
exec python3 scripts/bench.py "$@"
