#!/usr/bin/env bash
# Renders every picture of docs/gallery.md: EXR and PNG files in out/gallery/.
#
#   scripts/gallery.sh [--refresh-docs] [NAME ...]
#
#   NAME             only these, by the name of the PNG without .png; the default is all (some minutes on two CPUs)
#   --refresh-docs   copy the PNG files to docs/images/ as well
#
# Builds the program unless it is built; BACKLIGHT=/path/to/backlight uses another one. Figure 4 is drawn by gnuplot.
set -euo pipefail
# shellcheck source=scripts/find_program.sh
source "$(dirname "$0")/find_program.sh"
[[ -z ${BACKLIGHT:-} ]] || BACKLIGHT=$(find_program) || exit 2
cd "$(dirname "$0")/.."

refresh=no
wanted=()
for argument in "$@"; do
  case $argument in
    --refresh-docs) refresh=yes ;;
    -*) sed -n '2,9s/^# \{0,1\}//p' scripts/gallery.sh >&2; exit 2 ;;
    *) wanted+=("$argument") ;;
  esac
done

out=out/gallery
known=()
mkdir -p "$out"
if [[ -z ${BACKLIGHT:-} ]]; then
  BACKLIGHT=build/release/bin/backlight
  scripts/install.sh build charts
  if [[ ! -x $BACKLIGHT ]]; then
    cmake --preset release -DBACKLIGHT_TESTS=OFF
    cmake --build --preset release --target backlight backlight_oiio backlight_models
  fi
fi

is_wanted() {
  known+=("$1")
  ((${#wanted[@]} == 0)) && return 0
  local name
  for name in "${wanted[@]}"; do [[ $name == "$1" ]] && return 0; done
  return 1
}

publish() {
  echo "$out/$1.png"
  if [[ $refresh == yes ]]; then
    mkdir -p docs/images
    cp "$out/$1.png" "docs/images/$1.png"
  fi
}

# figure NAME SCENE [render options ...] [-- view options ...]: one picture
figure() {
  local name=$1 scene=$2
  shift 2
  is_wanted "$name" || return 0
  local render=()
  while (($#)) && [[ $1 != -- ]]; do render+=("$1"); shift; done
  (($#)) && shift
  "$BACKLIGHT" render "scenes/$scene.toml" -o "$out/$name.exr" "${render[@]}"
  "$BACKLIGHT" view "$out/$name.exr" -o "$out/$name.png" -q "$@"
  publish "$name"
}

# sheet NAME SCENE FRAMES COLUMNS [render options ...]: some images of an animation side by side
sheet() {
  local name=$1 scene=$2 frames=$3 columns=$4
  shift 4
  is_wanted "$name" || return 0
  rm -f "$out/$name".[0-9][0-9][0-9][0-9].exr
  "$BACKLIGHT" render "scenes/$scene.toml" -f "$frames" -o "$out/$name.####.exr" "$@"
  "$BACKLIGHT" view "$out/$name".[0-9][0-9][0-9][0-9].exr --columns "$columns" -o "$out/$name.png" -q
  publish "$name"
}

all_effects=(-D effects.doppler=true -D 'effects.searchlight="exact"')

figure default default
figure fig1-tram-interior fig1-tram-interior -- --tone reinhard --white 60
figure fig2a-tram-rest fig2a-tram-rest
figure fig2b-tram-terrell fig2b-tram-terrell
figure fig2b-tram-all-effects fig2b-tram-terrell "${all_effects[@]}"
figure fig2c-tram-no-light-delay fig2c-tram-no-light-delay
figure fig3-earth fig3-earth
if is_wanted fig4-aberration; then
  scripts/install.sh charts
  scripts/fig4_aberration.py "$BACKLIGHT" "$out"
  gnuplot -e "data='$out/fig4-aberration.dat'; picture='$out/fig4-aberration.png'" scripts/fig4_aberration.gp
  publish fig4-aberration
fi
figure fig5a-street-mercator-rest fig5a-street-mercator-rest
figure fig5b-street-mercator-0.9c fig5b-street-mercator-0.9c
figure fig6-starfield fig6-starfield
figure fig6b-real-stars-rest fig6b-real-stars -D params.v=0
figure fig6b-real-stars fig6b-real-stars
figure cosmic-background cosmic-background
figure fig7-tram-shadow fig7-tram-shadow -- --tone reinhard --white 8 --exposure 0.5
figure terrell-row terrell-row
figure teapot-0.9c teapot-0.9c
figure algebraic-rest algebraic-rest -- --exposure 0 --tone none
figure algebraic-0.9c algebraic-0.9c -- --exposure 0 --tone none
figure stability-nodes stability-nodes -- --exposure 0 --tone none
figure stability-shell stability-shell -- --exposure 0 --tone none
if is_wanted stability-unresolved; then # beside it, white where the channel `unresolved` is 1
  scripts/install.sh charts
  "$BACKLIGHT" render scenes/stability-unresolved.toml -o "$out/stability-unresolved.exr"
  "$BACKLIGHT" view "$out/stability-unresolved.exr" -o "$out/stability-unresolved-left.png" -q --exposure 0 --tone none
  oiiotool "$out/stability-unresolved-left.png" "$out/stability-unresolved.exr" --ch unresolved.V,unresolved.V,unresolved.V \
    --chnames R,G,B --mosaic 2x1 -o "$out/stability-unresolved.png"
  publish stability-unresolved
fi
sheet street-lamp-flicker street-lamp-flicker 1-16x5 2 -r 380x253
figure headlights headlights
sheet rocket rocket 1,31,46,61,91,121 3 -r 345x194 -s 4
sheet lattice-superluminal lattice-superluminal 1-6 3 -r 345x230

# Matter that turns, swings and accelerates
figure rolling-wheel rolling-wheel
figure rolling-wheel-colours rolling-wheel "${all_effects[@]}"
figure rolling-wheel-0.9c rolling-wheel -D params.v=0.9
sheet rolling-wheels rolling-wheels 1 1
sheet wheel-ant wheel-ant 1-61x12 3 -r 240x175
figure ehrenfest ehrenfest
figure turning-earth turning-earth
figure saturn saturn
figure mirror-hall mirror-hall
figure einstein-mirror einstein-mirror
figure mirror-ball-street mirror-ball-street
figure glass-ball-and-slab glass-ball-and-slab
figure michelson michelson
sheet mirror-clock mirror-clock 1,4,10,18 4 -r 240x360
sheet mirror-clock-aboard mirror-clock 1,4,10,18 4 -r 240x360 --camera aboard
figure fizeau-along fizeau -D params.v=-0.5
figure fizeau-against fizeau
sheet circling-lamp circling-lamp 1-131x26 3 -r 240x175
sheet bell-rockets bell-rockets 1-37x12 2 -r 360x131 -s 4
figure rindler-bow rindler-rocket -r 360x263 --camera bow
figure rindler-stern rindler-rocket -r 360x263 --camera stern
sheet clock-dice clock-dice 1-25x12 1 -r 720x270
sheet light-clock light-clock 19-43x8 2 -r 360x203
sheet ladder-barn ladder-barn 5,15,25,35 2 -r 360x203 --camera road
sheet ladder-barn-aboard ladder-barn 4,18,32,45 2 -r 360x203 --camera ladder

for name in "${wanted[@]}"; do
  case " ${known[*]} " in
    *" $name "*) ;;
    *) echo "scripts/gallery.sh: no picture '$name'; there are: ${known[*]}" >&2; exit 2 ;;
  esac
done
