#!/usr/bin/env bash
# Measures how many rays a second Backlight traces: scenes/fig7-tram-shadow.toml at 720x526, one sample a pixel, on one and
# on two threads; once as the scene is, and once with the Doppler shift and the searchlight effect, which need
# spectra. Prints the median of several runs, and writes all runs to out/bench.csv. Asserts nothing.
#
#   scripts/bench.sh [RUNS]        (default: 7)
#
# The kernels by themselves:  scripts/install.sh build bench && cmake --preset bench && cmake --build --preset bench &&
# build/bench/bench/kernels
set -euo pipefail
cd "$(dirname "$0")/.."
runs=${1:-7}

scripts/install.sh build
tests=OFF
grep -qs '^BACKLIGHT_TESTS:BOOL=ON' build/release/CMakeCache.txt && tests=ON
cmake --preset release -DBACKLIGHT_TESTS=$tests >/dev/null
cmake --build --preset release --target backlight backlight_oiio

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p out
echo "effects,threads,run,seconds,camera_rays,shadow_rays" >out/bench.csv

member() { sed -n "s/.*\"$1\":\([0-9.eE+-]*\).*/\1/p" "$folder/stats.json"; }
median() { sort -g | awk '{v[NR] = $1} END {print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2}'; }

# measure NAME THREADS [options]
measure() {
  local name=$1 threads=$2 run
  shift 2
  for ((run = 0; run <= runs; run++)); do # run 0 warms up and is not counted
    build/release/bin/backlight render scenes/fig7-tram-shadow.toml -o "$folder/fig7.exr" -r 720x526 -s 1 --aov none \
      --threads "$threads" --quiet --progress none --stats "$folder/stats.json" "$@"
    ((run == 0)) ||
      echo "$name,$threads,$run,$(member seconds),$(member cameraRays),$(member shadowRays)" >>out/bench.csv
  done
  local seconds rays
  seconds=$(awk -F, -v n="$name" -v t="$threads" '$1 == n && $2 == t {print $4}' out/bench.csv | median)
  rays=$(($(member cameraRays) + $(member shadowRays)))
  awk -v n="$name" -v t="$threads" -v s="$seconds" -v c="$(member cameraRays)" -v h="$(member shadowRays)" -v r="$rays" \
    'BEGIN {printf "%-16s %7d %9.4f %12d %12d %14.3f\n", n, t, s, c, h, r / s / 1e6}'
}

echo "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) CPUs; median of $runs runs"
printf '%-16s %7s %9s %12s %12s %14s\n' effects threads seconds "camera rays" "shadow rays" "Mrays/s"
for threads in 1 2; do measure "as in the file" "$threads"; done
for threads in 1 2; do
  measure "all" "$threads" -D effects.doppler=true -D 'effects.searchlight="exact"'
done
