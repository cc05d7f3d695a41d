#!/usr/bin/env bash
# Renders an animation, or one great image in parts, as an array job of a Slurm cluster.
#
#   scripts/farm/submit.sh [options] SCENE.toml [options of "backlight render"]
#
#   --chunk N            frames (or parts) in one task; default: as few as keep the array within 1000 tasks.
#                        A task costs Slurm about a second: give it at least ten seconds of work
#   --parts N            render one image as N bands of rows, and put them together at the end
#   --cpus N             CPUs of each task, and threads of its renderer; default 1
#   --mem-per-cpu SIZE   memory for each CPU, as in 500M or 2G
#   --time LIMIT         longest time of a task, as sbatch takes it: minutes, or hours:minutes:seconds
#   --at-once N          most tasks that run at one time
#   --sbatch OPTION      one more option for sbatch, such as --partition=cpu; may be repeated
#   --video FILE.mp4     make a video of the images when all of them are there (needs ffmpeg on the nodes)
#   --fps N              images a second of the video; default: 25
#   --dry-run            prepare and check everything, print what would be submitted, and submit nothing
#   -h, --help           print this help
#
# Name the images with -o, as in -o frames/shot.####.exr, in a folder that all nodes share. The options of "backlight render"
# are those of that command: -f 1-240 -r 1280x720 -s 16 -D params.v=0.9 and so on.
#
# Prints the number of the array job and that of the gather job, which checks that every image is there and complete, puts
# the parts together and makes the video. It runs only if every task succeeded.
#
# Nothing is lost, nothing is done twice: images that are complete and made from the same scene and settings are skipped, and
# a task that is stopped (preempted, requeued, cancelled, out of time) leaves a partial image, which the next run finishes. So after any
# trouble: the same command again.
#
# The program is $BACKLIGHT, the one in the PATH or build/release/bin/backlight of this clone, the first of them; the nodes must see
# it under the same path.
set -euo pipefail
here=$(cd "$(dirname "$(realpath "$0")")" && pwd)
# shellcheck source=scripts/find_program.sh
source "$here/../find_program.sh"

usage() { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0"; }
fail() { echo "scripts/farm/submit.sh: $*" >&2; exit 2; }

chunk='' parts='' cpus=1 memory='' limit='' at_once='' video='' fps='' dry_run=no
sbatch_options=()
scene='' arguments=()
while (($#)); do
  case $1 in
    --chunk | --parts | --cpus | --mem-per-cpu | --time | --at-once | --sbatch | --video | --fps)
      # "--time" and the like after the scene are options of the renderer.
      [[ -z $scene ]] || { arguments+=("$1"); shift; continue; }
      (($# > 1)) || fail "$1 needs a value"
      case $1 in
        --chunk) chunk=$2 ;; --parts) parts=$2 ;; --cpus) cpus=$2 ;; --mem-per-cpu) memory=$2 ;; --time) limit=$2 ;;
        --at-once) at_once=$2 ;; --sbatch) sbatch_options+=("$2") ;; --video) video=$2 ;; --fps) fps=$2 ;;
      esac
      shift 2 ;;
    --dry-run) dry_run=yes; shift ;;
    -h | --help) usage; exit 0 ;;
    -*)
      [[ -n $scene ]] || fail "unknown option '$1'; options of the renderer come after the scene. Try --help"
      arguments+=("$1"); shift ;;
    *) if [[ -z $scene ]]; then scene=$1; else arguments+=("$1"); fi; shift ;;
  esac
done
[[ -n $scene ]] || { usage >&2; exit 2; }
for number in "$chunk" "$parts" "$cpus" "$at_once" "$fps"; do
  [[ -z $number || ($number =~ ^[0-9]{1,7}$ && $number -gt 0) ]] || fail "'$number' is not a whole number from 1"
done
[[ -z $video || $video == *.mp4 ]] || fail "--video: '$video' must end in .mp4"
[[ -z $parts || -z $video ]] || fail "--video is of many images, --parts of one"

program=$(find_program) || exit 2

# What the tasks decide for themselves is left out; what they would all write into one file is refused.
kept=()
for argument in "${arguments[@]}"; do
  case $argument in
    --skip-existing | --no-clobber | --resume | --claim | --dry-run | --list-frames) ;;
    --stats | --stats=*) fail "--stats: every task writes its own, into the folder of the logs" ;;
    *) kept+=("$argument") ;;
  esac
done
arguments=("${kept[@]}")

# What the tasks would otherwise each find out for themselves. A mistake in the scene ends it here.
list=$("$program" render "$scene" "${arguments[@]}" --list-frames) || exit
mapfile -t numbers < <(cut -f 1 <<<"$list")
mapfile -t images < <(grep '\.exr$' <<<"$list" | cut -f 2-)
mapfile -t numbers < <(printf '%s\n' "${numbers[@]}" | awk '!seen[$0]++')

job_folder_in() { mkdir -p "$1" && mktemp -d "$(realpath "$1")/job-XXXXXX"; }
if [[ -n $video ]] && ! printf '%s\n' "${numbers[@]}" | sort -n | awk 'NR > 1 && $1 != last + 1 {exit 1} {last = $1}'; then
  fail "--video: there are gaps between these frames: ${arguments[*]}"
fi

# A scene without an animation numbers its images only where there are several at a time, and a task may have just one.
if ((${#images[@]} > 1)) && [[ $("$program" render "$scene" "${arguments[@]}" -f "${numbers[0]}" --list-frames |
  grep '\.exr$' | cut -f 2-) != "${images[0]}" ]]; then
  arguments+=(-o "$(sed 's/[0-9]*\.exr$/####.exr/' <<<"${images[0]}")")
fi

folder=$(dirname "${images[0]}")/farm
units=${#numbers[@]}
crops=() assemble=()
if [[ -n $parts ]]; then
  ((${#images[@]} == 1)) || fail "--parts is for one image, and these are ${#images[@]}: choose one with -f N or --time T"
  size='' overrides=() kept=() wide=no
  for ((i = 0; i < ${#arguments[@]}; i++)); do
    argument=${arguments[i]} next=${arguments[i + 1]:-}
    case $argument in
      --half) continue ;;
      --float) wide=yes; continue ;;
      --png | --crop | --crop=*) fail "$argument does not go together with --parts" ;;
      -o | --output) ((++i)); continue ;;
      -o?* | --output=*) continue ;;
      -r | --resolution) size=$next ;;
      -r?*) size=${argument#-r} ;;
      --resolution=*) size=${argument#*=} ;;
      -D | --set) overrides+=(-D "$next") ;;
      -D?*) overrides+=(-D "${argument#-D}") ;;
      --set=*) overrides+=(-D "${argument#*=}") ;;
    esac
    kept+=("$argument")
  done
  arguments=("${kept[@]}" --float)
  [[ -n $size ]] || size=$("$program" check "$scene" "${overrides[@]}" | sed -n 's/^ *image *\([0-9]*\) x \([0-9]*\) pixels.*/\1x\2/p')
  width=${size%x*} height=${size#*x}
  ((parts <= height)) || fail "--parts $parts: the image has $height rows"
  for ((i = 0; i < parts; i++)); do crops+=("0,$((height * i / parts)),$width,$((height * (i + 1) / parts))"); done
  units=$parts
  [[ $wide == yes ]] || assemble=(--half)
fi
chunk=${chunk:-$(((units + 999) / 1000))}
tasks=$(((units + chunk - 1) / chunk))

# All that the tasks need to know, in a folder of this submission.
job=$(job_folder_in "$folder")
mkdir "$job/logs"
image_paths=() # absolute, so that no task depends on its current folder
for image in "${images[@]}"; do image_paths+=("$(realpath -m "$image")"); done
part_paths=() part_patterns=() # the renderer has its own mind about where a frame number goes
if [[ -n $parts ]]; then
  part_folder=${image_paths[0]%.exr}.parts
  frame=$("$program" render "$scene" "${arguments[@]}" -o 'part.####.exr' --list-frames | grep -o '[0-9]*\.exr$')
  for ((i = 0; i < parts; i++)); do
    part_patterns+=("$part_folder/$(printf %05d "$i").####.exr")
    part_paths+=("$part_folder/$(printf %05d "$i").$frame")
  done
fi
start_folder=$PWD
fps_option=(${fps:+--fps "$fps"})
[[ -z $video ]] || video=$(realpath -m "$video")
{
  echo "# Made by submit.sh for task.sh and gather.sh."
  declare -p program scene start_folder arguments numbers image_paths crops part_patterns part_paths assemble chunk video fps_option here job
} >"$job/settings"

common=(--parsable --requeue --open-mode=append --chdir="$PWD" "${sbatch_options[@]}")
array=(sbatch "${common[@]}" --job-name=backlight --array="0-$((tasks - 1))${at_once:+%$at_once}" --ntasks=1
  --cpus-per-task="$cpus" ${memory:+--mem-per-cpu="$memory"} ${limit:+--time="$limit"} --output="$job/logs/task-%a.log"
  "$here/task.sh" "$job")
gather=(sbatch "${common[@]}" --job-name=backlight-gather --ntasks=1 --cpus-per-task="$cpus" --kill-on-invalid-dep=yes
  ${memory:+--mem-per-cpu="$memory"} ${limit:+--time="$limit"} --output="$job/logs/gather.log")

echo "${parts:+parts: $parts; }images: ${#images[@]}; tasks: $tasks, of up to $chunk $([[ -n $parts ]] && echo parts || echo images) each; logs: $job/logs" >&2
if [[ $dry_run == yes ]]; then
  printf '%q ' "${array[@]}"; echo
  printf '%q ' "${gather[@]}" --dependency=afterok:ARRAY "$here/gather.sh" "$job"; echo
  rm -r "$job"
  rmdir --ignore-fail-on-non-empty "$folder"
  exit 0
fi
command -v sbatch >/dev/null || fail "there is no sbatch here: this needs Slurm's client commands"
array_job=$("${array[@]}")
array_job=${array_job%%;*} # "number;cluster" where there are several clusters
gather_job=$("${gather[@]}" --dependency="afterok:$array_job" "$here/gather.sh" "$job")
echo "$array_job ${gather_job%%;*}"
