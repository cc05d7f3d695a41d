#!/usr/bin/env bash
# Measures whole frames beside other tracers, on this machine: POV-Ray 3.7 and Embree 3.13, and Backlight at rest and moving. Runs
# are interleaved, so that whatever else the machine does falls on all alike; the table has medians and their ratios, out/bench.csv
# every run. Asserts nothing. Some three minutes, on a machine that should have nothing else to do.
#
#   scripts/bench.sh [--rounds N] [--quick] [--record] [ROW ...]
#
#   --rounds N   runs of each (default 5)
#   --quick      2 runs, and no row that takes longer than some seconds
#   --record     writes the table into docs/charts/beside.csv too, from which scripts/charts.sh makes that of docs/speed-accuracy.md
#   ROW          only these: spheres torus barth gyroid motion spectral many threads memory startup
#
# The kernels by themselves: build/bench/bench/kernels and build/bench/bench/implicit.
set -euo pipefail
cd "$(dirname "$0")/.."
for argument in "$@"; do [[ $argument == -h || $argument == --help ]] && sed -n '2,14s/^# \{0,1\}//p' "$0" && exit 0; done

scripts/install.sh build bench
cmake --preset bench >/dev/null
cmake --build --preset bench --target backlight backlight_oiio sphere_field embree_spheres
exec python3 scripts/bench.py "$@"
