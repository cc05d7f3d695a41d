#!/usr/bin/env bash
# Makes a video of the frames of an animation.
#
#   scripts/video.sh FRAME.exr... -o VIDEO.mp4 [--fps N] [--spherical] [--program FILE] [options of backlight view]
#
#   scripts/video.sh out/lamp.*.exr -o out/lamp.mp4 --fps 25 --tone drago
#
# The frames are shown as `backlight view` shows them, all with one exposure and tone curve, so that nothing flickers;
# their sRGB values are what the video holds (H.264, Rec.709, marked with the sRGB transfer curve). Frames are ordered by
# the number at the end of their names, and none may be missing between the first and the last: ffmpeg would end the
# video there without a word. Needs ffmpeg.
#
# --spherical marks the video of equirectangular frames, or of cubemaps, as one to look around in: players show it so. With
# --eye top-bottom, it is one for two eyes. (scripts/spherical.py, for which it needs Python 3.)
#
# The program is FILE, $BACKLIGHT, the one in the PATH or build/release/bin/backlight of this clone: the first of them.
set -euo pipefail
# shellcheck source=scripts/find_program.sh
source "$(dirname "$(realpath "$0")")/find_program.sh"

fail() { echo "scripts/video.sh: $1" >&2 && exit "${2:-2}"; }

program=''
fps=25 spherical='' eye=left output='' frames=() view=()
while (($#)); do
  case $1 in
    -o | --output | --fps | --program)
      (($# > 1)) || fail "$1 needs a value"
      case $1 in --fps) fps=$2 ;; --program) program=$2 ;; *) output=$2 ;; esac
      shift 2
      ;;
    --exposure | --tone | --white | --eye | --channel | --range | --label)
      (($# > 1)) || fail "$1 needs a value"
      [[ $1 != --eye ]] || eye=$2
      view+=("$1" "$2") && shift 2
      ;;
    --spherical) spherical=1 && shift ;;
    --why | -q | --quiet) view+=("$1") && shift ;;
    -h | --help) sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "$0" && exit 0 ;;
    -*) fail "unknown option '$1'; see --help" ;;
    *) frames+=("$1") && shift ;;
  esac
done
((${#frames[@]})) || fail "no frames are given"
[[ $output == *.mp4 ]] || fail "name the video with -o; it must end in .mp4"
[[ $fps =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "--fps: expected a number, not '$fps'"
command -v ffmpeg >/dev/null || fail "ffmpeg is not installed" 4
program=$(find_program "$program") || exit 4

declare -A by_number=()
numbers=()
for frame in "${frames[@]}"; do
  [[ -f $frame ]] || fail "there is no file $frame" 4
  [[ $(basename "$frame") =~ ([0-9]+)\.exr$ ]] || fail "$frame: a frame's name ends in its number and .exr"
  number=$((10#${BASH_REMATCH[1]}))
  [[ -z ${by_number[$number]:-} ]] || fail "two frames number $number: ${by_number[$number]} and $frame"
  by_number[$number]=$frame
  numbers+=("$number")
done
mapfile -t numbers < <(printf '%s\n' "${numbers[@]}" | sort -n)

missing=()
for ((number = numbers[0]; number <= numbers[-1]; ++number)); do
  [[ -n ${by_number[$number]:-} ]] || missing+=("$number")
done
((${#missing[@]} == 0)) || fail "missing between ${numbers[0]} and ${numbers[-1]}: frame ${missing[*]}" 4

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ordered=() count=0
for number in "${numbers[@]}"; do
  ln -s "$(realpath "${by_number[$number]}")" "$work/$(printf %08d $count).exr"
  ordered+=("$work/$(printf %08d $count).exr")
  count=$((count + 1))
done
if [[ $spherical ]]; then
  projection=$("$program" info "${ordered[0]}" | awk '$1 == "backlight/projection" { print $2 }')
  [[ $projection == equirectangular || $projection == cubemap ]] ||
    fail "--spherical: the frames are ${projection:-of an unknown projection}, neither equirectangular nor cubemap"
fi
mkdir "$work/png"
"$program" view "${ordered[@]}" -o "$work/png/" "${view[@]}"

# H.264 in 4:2:0 wants even sizes: a row or a column is repeated where needed. The PNGs hold sRGB signals, which go
# through unchanged, but for the matrix to luma and chroma.
mkdir -p "$(dirname "$output")"
IFS=, read -r width height < <(ffprobe -v error -select_streams v -show_entries stream=width,height -of csv=p=0 "$work/png/00000000.png")
ffmpeg -v error -y -nostdin -framerate "$fps" -start_number 0 -i "$work/png/%08d.png" \
  -vf "pad=ceil(iw/2)*2:ceil(ih/2)*2,fillborders=right=$((width % 2)):bottom=$((height % 2)):mode=smear,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p" \
  -c:v libx264 -crf 16 -preset medium -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 \
  -color_range tv -movflags +faststart "$work/video.mp4"
made=$(ffprobe -v error -count_packets -select_streams v -show_entries stream=nb_read_packets -of csv=p=0 "$work/video.mp4")
if [[ $spherical ]]; then
  stereo=none && [[ $eye != top-bottom ]] || stereo=top-bottom
  "$(dirname "$(realpath "$0")")/spherical.py" "$work/video.mp4" --projection "$projection" --stereo "$stereo" || exit 4
fi
[[ $made == "$count" ]] || fail "the video has $made images instead of $count" 4
mv "$work/video.mp4" "$output.partial.$$" && mv "$output.partial.$$" "$output"
echo "$output: $count frames"
