#!/usr/bin/env bash
# Runs the commands of README.md and of all pages of docs/ exactly as they stand there, page by page, each in a folder of its own.
#
#   tests/docs/run.sh PROGRAM FOLDER        FOLDER is emptied first
#
# Only these are tried elsewhere: the cookbook (tests/cookbook), what installs, builds, tests and draws everything (.ci/run,
# tests/package), Slurm (tests/farm) and Blender (tests/blender). In farm.md, /shared stands for a shared folder, and FRAMES for what a manager of
# farms puts in its place.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "$1")
rm -rf "$2" && mkdir -p "$2" && cd "$2"
export BACKLIGHT_MODULE_PATH=${BACKLIGHT_MODULE_PATH:-$(dirname "$program")/../lib/backlight}
elsewhere='scripts/(render|test|gallery|package|install|charts|bench|course)\.sh|apt-get|^man |^blender |scripts/farm/|^cmake |/usr/share/'
ran=0 left_out=0

# What the pages take to be there.
fixtures() {
  mkdir -p bin build/release/bin out shared
  ln -sfn "$top/scenes" scenes
  # `compare` says by its status that images differ, which is no failure of the page.
  printf '#!/bin/sh\n"%s" "$@" || { status=$?; [ "$1 $status" = "compare 1" ] || exit $status; }\n' "$program" >bin/backlight
  chmod +x bin/backlight && cp bin/backlight build/release/bin/
  cat >scene.toml <<'TOML'
[film]
resolution = [640, 400]
[camera]
position = [0, 0, -5]
look_at = [0, 0, 0]
[[object]]
name = "tram"
shape = "sphere"
radius = 1
velocity = [0.5, 0, 0]
[[light]]
type = "point"
position = [0, 3, -3]
intensity = 20
TOML
  cp scene.toml street.toml
  { sed 's/640, 400/64, 40/' scene.toml && printf '[animation]\nfps = 10\nframes = [1, 4]\n'; } >shot.toml
  cp shot.toml shared/
  "$program" shot.toml -q -f 1 -o reference.exr && mv reference.0001.exr reference.exr && cp reference.exr new.exr
}

page() { # PAGE: its blocks that begin with ```sh
  local name=${1%.md} block
  name=${name##*/}
  mkdir "$name" && cd "$name" && fixtures
  awk '/^```sh$/ { n++; inside = 1; next } /^```$/ { inside = 0 } inside { print > ("block-" n ".sh") }' "$top/$1"
  for ((n = 1; ; ++n)); do
    block=block-$n.sh
    [[ -e $block ]] || break
    if grep -qE "$elsewhere" "$block"; then left_out=$((left_out + 1)) && continue; fi
    if grep -q 'references/' "$block"; then  # the images of a suite, with their data
      mkdir references && "$program" shot.toml -q --aov Z,doppler -o references/shot.exr
      rm -f out/*.exr && cp references/*.exr out/
    fi
    sed -i "s|/shared/|shared/|g; s|-f FRAMES|-f 1-2|" "$block"
    echo "--- $1, block $n"
    PATH="$PWD/bin:$PATH" bash -euo pipefail "$block" >"$block.log" 2>&1 || { cat "$block" "$block.log" && echo "$1: block $n failed" >&2 && exit 1; }
    ran=$((ran + 1))
  done
  cd ..
}

page README.md
for file in "$top"/docs/*.md; do
  file=docs/${file##*/}
  [[ $file == docs/cookbook.md ]] || page "$file"
done
for made in README/out/{first,nature,faster,lamp.0005}.exr README/out/faster.png README/out/report.html README/out/backlight.schema.json \
  command-line/scene.exr command-line/report.html farm/frames/shot.0004.exr farm/shared/frames/shot.0004.exr; do
  [[ -s $made ]] || { echo "there is no $made" >&2 && exit 1; }
done
echo "$ran blocks of commands work; $left_out are tried elsewhere."
((ran >= 12))
