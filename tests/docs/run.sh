#!/usr/bin/env bash
# Runs the commands of README.md and of all pages of docs/ exactly as they stand there, page by page, each in a folder of its own.
#
#   tests/docs/run.sh PROGRAM FOLDER        FOLDER is emptied first
#
# The cookbook has a test of its own (tests/cookbook), as the lessons have (tests/course) and what is Python (tests/python). Of all other
# blocks those that begin with a line of `elsewhere`, and no others, are tried where it says. In farm.md, /shared stands for a shared folder, and
# FRAMES for what a manager of farms puts in its place; the package's folder is this clone.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "$1")
rm -rf "$2" && mkdir -p "$2" && cd "$2"
export BACKLIGHT_MODULE_PATH=${BACKLIGHT_MODULE_PATH:-$(dirname "$program")/../lib/backlight}
ran=0 left_out=0

# What a block begins with that is not run here, and where it is tried.
elsewhere=(
  "apt-get install ./out/backlight_|installs: tests/package/run.sh --clean-root"
  "apt-get install python3-numpy|installs: scripts/install.sh test, for tests/python"
  "scripts/render.sh|builds: .ci/run"
  "scripts/gallery.sh|all pictures at their full size, by hand; every scene: tests/package and tests/golden"
  "scripts/farm/submit.sh|Slurm: tests/farm/run.sh, with other numbers"
  "scripts/install.sh build farm|Slurm: tests/farm/run.sh"
  "blender |Blender: tests/blender"
)
tried_elsewhere() { # FILE: where
  local line=''
  IFS= read -r line <"$1"
  for one in "${elsewhere[@]}"; do
    [[ $line != "${one%|*}"* ]] || { echo "${one##*|}" && return 0; }
  done
  return 1
}

# What the pages take to be there.
fixtures() {
  mkdir -p bin build/release/bin out shared man/man1
  "$program" manual >man/man1/backlight.1
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
    if where=$(tried_elsewhere "$block"); then
      echo "--- $1, block $n: not here; $where"
      left_out=$((left_out + 1)) && continue
    fi
    if grep -q 'references/' "$block"; then  # the images of a suite, with their data
      mkdir references && "$program" shot.toml -q --aov Z,doppler -o references/shot.exr
      rm -f out/*.exr && cp references/*.exr out/
    fi
    sed -i "s|/shared/|shared/|g; s|-f FRAMES|-f 1-2|; s|/usr/share/backlight/|$top/|" "$block"
    echo "--- $1, block $n"
    PATH="$PWD/bin:$PATH" MANPATH="$PWD/man" bash -euo pipefail "$block" >"$block.log" 2>&1 || { cat "$block" "$block.log" && echo "$1: block $n failed" >&2 && exit 1; }
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
((ran >= 14 && left_out <= 10))
