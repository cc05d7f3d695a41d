#!/usr/bin/env bash
# Installs what is missing, builds Backlight and renders a scene to EXR, with a PNG beside it.
#
#   scripts/render.sh [SCENE.toml] [more options of "backlight render"]
#
# The default scene is scenes/default.toml; the pictures go to out/ of this clone, under the scene's name. Paths are taken from the current folder,
# and a scene that is not there from this clone.
set -euo pipefail
start_folder=$PWD
cd "$(dirname "$0")/.."
top=$PWD

scene=$top/scenes/default.toml
if (($#)) && [[ $1 != -* ]]; then
  scene=$1
  [[ $scene == /* || -e $start_folder/$scene ]] || scene=$top/$scene
  shift
fi

output=(-o "$top/out/")
for option in "$@"; do
  case $option in -o | -o?* | --output | --output=*) output=() ;; esac
done

scripts/install.sh build
# The tests are left out, unless this build folder has them already.
tests=OFF
grep -qs '^BACKLIGHT_TESTS:BOOL=ON' build/release/CMakeCache.txt && tests=ON
cmake --preset release -DBACKLIGHT_TESTS=$tests
cmake --build --preset release --target backlight backlight_oiio backlight_models

cd "$start_folder"
"$top/build/release/bin/backlight" render "$scene" "${output[@]}" "$@" --png
echo "Rendered:"
"$top/build/release/bin/backlight" render "$scene" "${output[@]}" "$@" --dry-run | while IFS= read -r exr; do
  [[ $exr == /* ]] || exr=$PWD/$exr
  printf '  %s\n' "$exr" "${exr%.exr}.png"
done
