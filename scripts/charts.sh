#!/usr/bin/env bash
# Measures and draws the charts of docs/speed-accuracy.md, and writes that page: docs/charts/*.csv, *.png. Every point is measured in
# the run. Some nine minutes; the machine should have nothing else to do.
#
#   scripts/charts.sh [--quick] [--draw] [--smoke FOLDER] [CHART ...]
#
#   --quick   smaller pictures and fewer points, some two minutes: into out/charts/, which leaves docs/ alone
#   --smoke   one small picture or surface of each, some seconds, into FOLDER: to see that everything works
#   --draw    measures nothing: draws the charts and writes the page from the CSV files that are there
#   CHART     only these (default: all of them), then the page:
#             a  root finders: speed, error and missed roots, beside POV-Ray's
#             b  arithmetic: float, double, double-double, by Lorentz factor
#             c  wavelengths: colour error and cost
#             d  sampling: uniform and adaptive
#             e  the dial: tolerance asked for, error delivered, time (measured together with d)
#             f  cost by the number of objects, pixels and threads, and of real scenes
#             g  each piece of the model left out: cost and error
#             h  polygons with their corners at their apparent places, beside rays
#
# MEASURE_WITH, if set, is a command to be put before each measuring program, such as 'nice -n -5'; CHART_PROGRAMS a folder with the
# measuring programs, which are then not built.
set -euo pipefail
cd "$(dirname "$0")/.."

quick=no
smoke=
draw_only=no
charts=()
while (($#)); do
  argument=$1
  shift
  case $argument in
    --quick) quick=yes ;;
    --smoke)
      smoke=${1:?a folder}
      quick=yes
      shift
      ;;
    --draw) draw_only=yes ;;
    [a-h]) charts+=("$argument") ;;
    -h | --help) sed -n '2,21s/^# \{0,1\}//p' scripts/charts.sh; exit 0 ;;
    *) sed -n '2,21s/^# \{0,1\}//p' scripts/charts.sh >&2; exit 2 ;;
  esac
done
((${#charts[@]})) || charts=(a b c d e f g h)

out=docs/charts
flag=()
surfaces=(sphere torus Steiner Barth Klein composed expanded gyroid)
[[ $quick == yes ]] && out=out/charts && flag=(--quick)
mkdir -p "$out"
figures=(fig1-tram-interior fig2a-tram-rest fig2b-tram-terrell fig2c-tram-no-light-delay fig3-earth
  fig5a-street-mercator-rest fig5b-street-mercator-0.9c fig6-starfield fig6b-real-stars fig7-tram-shadow)
fast=(bench/yardsticks/ahead.toml)  # the one scene of chart g that is no figure: none of these flies at a γ above 30
if [[ -n $smoke ]]; then
  out=$smoke
  flag=(--smoke)
  figures=(fig3-earth)
  surfaces=(sphere)
  mkdir -p "$out"
fi
bench=${CHART_PROGRAMS:-build/bench/bench}
begin=$SECONDS

if [[ $draw_only == no ]]; then
  [[ -n ${CHART_PROGRAMS:-} ]] || scripts/install.sh build bench charts || echo "charts.sh: going on without what is missing" >&2
  [[ -n ${CHART_PROGRAMS:-} ]] || cmake --preset bench >/dev/null
  [[ -n ${CHART_PROGRAMS:-} ]] || cmake --build --preset bench --target chart_ablation chart_arithmetic chart_dial chart_polygons chart_roots chart_scaling chart_wavelengths
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

[[ $draw_only == yes ]] || {
  echo "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) CPUs; $(${CXX:-c++} --version | head -n 1); $(uname -sr)"
} >"$out/machine.txt"

is_wanted() { [[ " ${charts[*]} " == *" $1 "* ]]; }

# measure PROGRAM ARGUMENTS...: its CSV, on stdout; what the run is, on stderr
measure() {
  echo "  $*" >&2
  # shellcheck disable=SC2086  # a command with its options
  ${MEASURE_WITH:-} "$bench/$@"
}

# joined FILE: several CSVs on stdin as one, with one heading, into a file that appears when it is whole
joined() {
  awk 'NR == 1 {heading = $0} NR == 1 || $0 != heading' >"$1.new"
  mv "$1.new" "$1"
}

measure_chart() {
  case $1 in
    a)
      for surface in "${surfaces[@]}"; do
        measure chart_roots "$work" "${flag[@]}" "$surface"
      done | joined "$out/roots.csv"
      ;;
    b) measure chart_arithmetic $([[ $quick == yes ]] && echo 150 || echo 2000) | joined "$out/arithmetic.csv" ;;
    c)
      measure chart_wavelengths error | joined "$out/wavelengths.csv"
      measure chart_wavelengths cost "${flag[@]}" | joined "$out/wavelengths-cost.csv"
      ;;
    d)
      for figure in "${figures[@]}"; do measure chart_dial "${flag[@]}" "$figure"; done | joined "$out/dial.csv"
      ;;
    e) is_wanted d || measure_chart d ;;
    f)
      measure chart_scaling objects "${flag[@]}" | joined "$out/objects.csv"
      measure chart_scaling pixels "${flag[@]}" | joined "$out/pixels.csv"
      measure chart_scaling scenes "${flag[@]}" | joined "$out/scenes.csv"
      measure chart_scaling threads "${flag[@]}" | joined "$out/threads.csv"
      ;;
    g)
      for figure in "${figures[@]}" "${fast[@]}"; do measure chart_ablation "${flag[@]}" "$figure"; done | joined "$out/ablation.csv"
      ;;
    h) measure chart_polygons "${flag[@]}" | joined "$out/polygons.csv" ;;
  esac
}

declare -A drawing=([a]=roots [b]=arithmetic [c]=wavelengths [d]=sampling [e]=dial [f]=scaling [g]=ablation [h]=polygons)
for chart in "${charts[@]}"; do
  echo "chart $chart: ${drawing[$chart]}" >&2
  [[ $draw_only == yes ]] || measure_chart "$chart"
  command -v gnuplot >/dev/null || { echo "charts.sh: gnuplot is not installed: no picture of chart $chart" >&2; continue; }
  # It warns of each series that has no point in a panel, as most have not.
  gnuplot -e "folder='$out'; load 'scripts/charts/style.gp'" "scripts/charts/${drawing[$chart]}.gp" 2>"$work/gnuplot.log" ||
    { cat "$work/gnuplot.log" >&2; exit 1; }
  grep -v 'no valid points' "$work/gnuplot.log" >&2 || true
  echo "$out/${drawing[$chart]}.png"
done

page=$([[ $quick == yes ]] && echo "$out/speed-accuracy.md" || echo docs/speed-accuracy.md)
python3 scripts/charts/page.py "$out" scripts/charts/speed-accuracy.md.in "$page"
echo "$page: $((SECONDS - begin)) s"
