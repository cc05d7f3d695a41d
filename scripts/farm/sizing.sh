#!/usr/bin/env bash
# How long a film takes on 1, 100 and 10,000 cores: measures the time per pixel of a scene on one core of this machine, and prints the
# table of docs/farm.md for images of 3840x2160, with its arithmetic.
#
#   scripts/farm/sizing.sh [options] [SCENE.toml]        default: scenes/fig7-tram-shadow.toml with all effects
#
#   --samples N          samples in each pixel of the film (default 16)
#   --seconds N          length of the film, at 24 images a second (default 60)
#   --task-seconds X     what Slurm takes for one task besides its work (default 0.85, measured with 40 empty tasks
#                        on the cluster of one-machine.sh)
#   -h, --help           print this help
#
# Measures at 960x540, a sixteenth of the pixels; takes about a minute, on an idle machine. The
# program is $BACKLIGHT, the one in the PATH or build/release/bin/backlight of this clone, the first of them.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=scripts/find_program.sh
source "$top/scripts/find_program.sh"
program=$(find_program) || exit 2

scene='' samples=16 length=60 task=0.85
usage() { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0"; }
while (($#)); do
  case $1 in
    --samples) samples=$2; shift 2 ;;
    --seconds) length=$2; shift 2 ;;
    --task-seconds) task=$2; shift 2 ;;
    -h | --help) usage; exit 0 ;;
    -*) usage >&2; exit 2 ;;
    *) scene=$1; shift ;;
  esac
done
options=()
[[ -n $scene ]] || { scene=$top/scenes/fig7-tram-shadow.toml; options=(-D effects.doppler=true -D 'effects.searchlight="exact"'); }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# wall_time SIZE SAMPLES: seconds of a whole run of the program, from start to end, on one thread
wall_time() {
  local start=$EPOCHREALTIME
  "$program" render "$scene" "${options[@]}" -r "$1" -s "$2" --aov none -t 1 -q --progress none -o "$folder/image.exr"
  awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN {printf "%.4f", b - a}'
}
median_of_three() { for _ in 1 2 3; do wall_time "$@"; echo; done | sort -g | sed -n 2p; }

start_up=$(median_of_three 1x1 1)
one=$(median_of_three 960x540 1)
five=$(wall_time 960x540 5)
bytes=$(($(stat -c %s "$folder/image.exr") * 16))

echo "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1); ${scene##*/} ${options[*]}"
awk -v up="$start_up" -v t1="$one" -v t5="$five" -v bytes="$bytes" -v s="$samples" -v frames="$((length * 24))" -v task="$task" '
function ceil(x) { return x == int(x) ? x : int(x) + 1 }
function text(seconds) {
  if (seconds < 120) return sprintf("%.0f s", seconds)
  if (seconds < 7200) return sprintf("%.0f min", seconds / 60)
  if (seconds < 172800) return sprintf("%.1f h", seconds / 3600)
  return sprintf("%.1f days", seconds / 86400)
}
function row(cores, threads, chunk,    slots, tasks, rounds, seconds) {
  slots = int(cores / threads)
  tasks = ceil(frames / chunk)
  rounds = ceil(tasks / slots)
  seconds = rounds * (task + up + chunk * (fixed + s * sample / threads))
  printf "%6d %8d %6d %6d %7d %12.1f %11s %10.0f%%\n", cores, threads, chunk, tasks, rounds, fixed + s * sample / threads,
    text(seconds), 100 * frames * (fixed + s * sample) / (seconds * cores)
}
BEGIN {
  sample = 16 * (t5 - t1) / 4
  fixed = 16 * (t1 - up - (t5 - t1) / 4)
  if (fixed < 0) fixed = 0
  printf "measured: start-up %.3f s; 960x540 with 1 sample %.2f s, with 5 samples %.2f s, on one core\n", up, t1, t5
  printf "so, at 3840x2160: %.2f s a sample of each pixel (%.0f ns for one pixel), %.2f s and %.1f MB an image for the rest\n",
    sample, sample / (3840 * 2160) * 1e9, fixed, bytes / 1e6
  printf "film: %d images with %d samples = %s of one core, %.0f GB\n\n", frames, s, text(frames * (fixed + s * sample)),
    frames * bytes / 1e9
  printf "%6s %8s %6s %6s %7s %12s %11s %11s\n", "cores", "threads", "chunk", "tasks", "rounds", "s an image", "film", "efficiency"
  row(1, 1, frames)
  row(100, 1, ceil(frames / 100 / 3))
  row(10000, max_threads(10000), 1)
  printf "\nfilm = rounds * (task + start-up + chunk * (rest + samples * sample / threads)), with task = %.2f s;\n", task
  printf "efficiency = one core'"'"'s time for all images / (film * cores). A task'"'"'s threads share its samples, not the rest.\n"
}
function max_threads(cores) { return int(cores / frames) > 1 ? int(cores / frames) : 1 }'
