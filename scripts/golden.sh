#!/usr/bin/env bash
# The project's own pictures, small ones of every scene and feature, compared with those in tests/golden/reference.
#
#   scripts/golden.sh [--program FILE] [--out FOLDER]            exits with 0 when all are equal
#   scripts/golden.sh [--program FILE] [--out FOLDER] --update   takes the new ones as references, and says which
#
# FOLDER (out/golden) is emptied first, and holds the new pictures and report.html afterwards. An update is a decision:
# look at the report first, and say in the commit why the pictures changed.
#
# Thresholds. Colour is stored in 11 bits: a value counts as different when it is off by more than 1e-4 and by more than
# two units of that, 2e-3 of itself. Data channels: by more than 1e-5 and more than 1e-5 of itself, some 100 roundings of
# float. On one machine the pictures are the same bits; the thresholds are for another libm or compiler.
set -euo pipefail
start_folder=$PWD
cd "$(dirname "$0")/.."
source scripts/find_program.sh

# This clone's own, whatever is in the PATH: it is what is tested.
program=build/release/bin/backlight
out=out/golden
update=()
while (($#)); do
  case $1 in
    --program) program=$(cd "$start_folder" && find_program "$2") && shift 2 ;;
    --out) out=$(cd "$start_folder" && realpath -m "$2") && shift 2 ;;
    --update) update=(--update) && shift ;;
    *) echo "scripts/golden.sh: unknown option '$1'; see the head of the file" >&2 && exit 2 ;;
  esac
done

program=$(find_program "$program") || exit 2

rm -rf "$out"
mkdir -p "$out/new"
render() { "$program" render "$1" -q -r "${3:-64x36}" -s 4 --aov "$aovs" -o "$out/new/$2" "${@:4}"; }

aovs=Z,doppler,emissionTime,objectId,light
for scene in scenes/*.toml tests/golden/scenes/*.toml; do
  name=$(basename "$scene" .toml)
  case $name in
    street-lamp-flicker) render "$scene" "$name.####.exr" 64x36 -f 1-2 ;;  # by the lamp's own clock
    rocket) render "$scene" "$name.####.exr" 64x36 -f 61,121 ;;  # on its way, and at 0.96 c
    wheel-ant) render "$scene" "$name.####.exr" 64x36 -f 1,37 ;;  # at the top and at the bottom of the wheel
    circling-lamp) render "$scene" "$name.####.exr" 64x36 -f 1,131 ;;  # rings on the wall, and a new one
    bell-rockets) render "$scene" "$name.####.exr" 64x36 -f 1,25 ;;  # with the string, and without
    clock-dice | light-clock | rolling-wheels) render "$scene" "$name.####.exr" 64x36 -f 13 ;;
    cubemap) render "$scene" "$name.exr" 60x40 ;;  # six faces
    mirror-clock) render "$scene" "$name.####.exr" 64x36 -f 4 ;;  # the first reflections
    ladder-barn) render "$scene" "$name.####.exr" 64x36 -f 25 ;;  # both doors are shut
    *) render "$scene" "$name.exr" ;;
  esac
done
render scenes/first.toml first-cropped.exr 64x36 --crop 20,5,50,30
aovs=all
render scenes/first.toml first-all-channels.exr 64x36

status=0
"$program" compare tests/golden/reference "$out/new" --html "$out/report.html" "${update[@]}" \
  --channels R,G,B,A --fail 1e-4 --failrelative 2e-3 || status=$?
((status < 2)) || exit "$status"
# An update has put whole files in place, data channels included: then these are equal.
"$program" compare tests/golden/reference "$out/new" --html "$out/report-data.html" "${update[@]}" \
  --channels Z,doppler,emissionTime,objectId,light --fail 1e-5 --failrelative 1e-5 || status=$?
exit "$status"
