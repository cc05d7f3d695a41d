#!/usr/bin/env bash
# Runs the recipes of docs/cookbook.md, in their order, exactly as they stand there, and looks at what they made.
#
#   tests/cookbook/run.sh PROGRAM FOLDER        FOLDER is emptied first
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "$1")
rm -rf "$2" && mkdir -p "$2/scripts" "$2/bin" && cd "$2"
ln -s "$top/scenes" scenes
cp "$top"/scripts/{video,find_program}.sh "$top/scripts/spherical.py" scripts/
# In the PATH and nowhere else: there is no build folder here for a script to fall back on.
ln -s "$program" bin/backlight
export PATH="$PWD/bin:$PATH" BACKLIGHT_MODULE_PATH=${BACKLIGHT_MODULE_PATH:-$(dirname "$program")/../lib/backlight}

# recipe-1.sh, recipe-2.sh...: the blocks that begin with ```sh
awk '/^```sh$/ { n++; inside = 1; next } /^```$/ { inside = 0 } inside { print > ("recipe-" n ".sh") }' "$top/docs/cookbook.md"
recipes=(recipe-*.sh)
((${#recipes[@]} >= 6)) || { echo "found only ${#recipes[@]} recipes" >&2 && exit 1; }
for ((n = 1; n <= ${#recipes[@]}; ++n)); do
  echo "--- recipe $n"
  bash -euo pipefail "recipe-$n.sh" >"recipe-$n.log" 2>&1 || { cat "recipe-$n.log" && echo "recipe $n failed" >&2 && exit 1; }
  cat "recipe-$n.log"
done

size() { ffprobe -v error -select_streams v -count_packets -show_entries stream=width,height,nb_read_packets -of csv=p=0 "$1"; }
expect() { [[ $2 == "$3" ]] || { echo "$1: expected $2, found $3" >&2 && exit 1; }; }
expect out/speeds.png 360,264,1 "$(size out/speeds.png)"
expect out/lamp.mp4 180,132,12 "$(size out/lamp.mp4)"
expect out/wheels.mp4 180,102,12 "$(size out/wheels.mp4)"
expect out/panorama.png 256,256,1 "$(size out/panorama.png)"
cmp -s out/left.png out/right.png && { echo "both eyes see the same" >&2 && exit 1; }
grep -q "2 images, 2 equal" recipe-5.log || { echo "the suite is not equal" >&2 && exit 1; }
[[ -s out/report.html ]] || { echo "no report" >&2 && exit 1; }
awk '/shifted/ { exit !($6 > 500) }' recipe-7.log || { echo "no pixel was shifted out of the visible" >&2 && exit 1; }

# The metadata that players look for, and the pictures as they were.
expect out/around.mp4 256,256,6, "$(size out/around.mp4)"  # and side data
sides=$(ffprobe -v error -select_streams v -show_streams out/around.mp4)
[[ $sides == *"type=top and bottom"* && $sides == *"projection=equirectangular"* ]] || { echo "not spherical: $sides" >&2 && exit 1; }
grep -aq "<GSpherical:StereoMode>top-bottom" out/around.mp4 || { echo "no V1 metadata" >&2 && exit 1; }
ffmpeg -v error -i out/around.mp4 -f null - || { echo "the marked video cannot be decoded" >&2 && exit 1; }
status=0 && message=$(scripts/video.sh out/lamp/*.exr -o out/flat.mp4 --spherical 2>&1) || status=$?
expect "status of a flat video" 2 "$status"
[[ $message == *"the frames are perspective"* && ! -e out/flat.mp4 ]] || { echo "flat: $message" >&2 && exit 1; }

# A cubemap is what ffmpeg takes it for: its panorama is ours, but for edges.
for face in right left up down front back; do expect "out/cube.$face.png" 64,64,1 "$(size "out/cube.$face.png")"; done
backlight scenes/first.toml -q -r 256x128 -s 4 -D 'camera.projection="equirectangular"' -o out/sphere.exr
backlight view out/sphere.exr --tone none -o out/sphere.png
likeness=$(ffmpeg -v info -i out/from-cube.png -i out/sphere.png -lavfi psnr -f null - 2>&1 | sed -n 's/.*average:\([0-9.]*\).*/\1/p')
awk -v p="$likeness" 'BEGIN { exit !(p > 24) }' || { echo "the cubemap is another panorama: PSNR $likeness" >&2 && exit 1; }

expect out/lamps.png 240,420,1 "$(size out/lamps.png)"
expect out/theatre.png 288,192,1 "$(size out/theatre.png)"

# A hole in the sequence is refused, and named; so is a frame there twice.
rm out/lamp/lamp.0005.exr out/lamp/lamp.0007.exr
status=0 && message=$(scripts/video.sh out/lamp/*.exr -o out/hole.mp4 2>&1) || status=$?
expect "status with a hole" 4 "$status"
[[ $message == *"missing between 1 and 12: frame 5 7"* && ! -e out/hole.mp4 ]] || { echo "a hole: $message" >&2 && exit 1; }

# Which program it runs: the one that is named, then the PATH's, then this folder's build.
expect_program() { # STATUS "WORDS" command...: a program that says who it is, instead of a view
  local status=0 message words=$2
  message=$("${@:3}" 2>&1) || status=$?
  [[ $status == "$1" && $message == *"$words"* ]] || { echo "expected '$words' and $1, found '$message' and $status" >&2 && exit 1; }
}
mkdir -p other build/release/bin
for place in other build/release/bin; do
  printf '#!/bin/sh\necho "this is %s"; exit 9\n' "$place" >"$place/backlight" && chmod +x "$place/backlight"
done
bare_path=${PATH#"$PWD/bin:"}
make_video=(scripts/video.sh out/lamp/lamp.0001.exr -o out/who.mp4)
expect_program 9 "this is other" env PATH="$PWD/other:$PATH" "${make_video[@]}"
expect_program 9 "this is other" env BACKLIGHT=other/backlight "${make_video[@]}"
expect_program 9 "this is other" env BACKLIGHT=nowhere "${make_video[@]}" --program other/backlight
expect_program 9 "this is build/release/bin" env -u BACKLIGHT PATH="$bare_path" "${make_video[@]}"
rm build/release/bin/backlight
expect_program 4 "there is no program" env -u BACKLIGHT PATH="$bare_path" "${make_video[@]}"
expect_program 0 "1 frames" "${make_video[@]}"

# What the video shows: a grey of linear 0.18 is the sRGB signal 118.
cat >grey.toml <<'TOML'
[film]
resolution = [31, 17]
[camera]
[background]
color = [0.18, 0.18, 0.18]
[animation]
fps = 1
frames = [1, 3]
TOML
backlight grey.toml -q -o grey/grey.####.exr
scripts/video.sh grey/*.exr -o grey.mp4 --fps 5 --tone none
expect grey.mp4 32,18,3 "$(size grey.mp4)"
ffmpeg -v error -y -i grey.mp4 -frames:v 1 -pix_fmt rgb24 -f rawvideo grey.rgb
for pixel in 0 40 575; do
  value=$(od -An -tu1 -j $((3 * pixel)) -N 1 grey.rgb | tr -d ' ')
  ((value >= 116 && value <= 120)) || { echo "pixel $pixel of the grey video is $value, not 118" >&2 && exit 1; }
done
expect "transfer curve" iec61966-2-1 "$(ffprobe -v error -select_streams v -show_entries stream=color_transfer -of csv=p=0 grey.mp4)"
echo "All recipes work."
