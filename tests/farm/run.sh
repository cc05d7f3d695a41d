#!/usr/bin/env bash
# The farm scripts against a real Slurm: a cluster of two nodes on this machine, in a folder of its own.
#
#   tests/farm/run.sh [PROGRAM]      default: build/release/bin/backlight
#
#   1. an animation as an array job; one node's daemons are killed in the middle, and its renderer is left behind as an orphan that
#      wakes up while its frames are being rendered again
#   2. a task that is requeued in the middle of an image, and finishes it
#   3. one image in parts, put together again
#   4. a task that fails: no gather job
#   5. the same frames through a shell loop and through GNU parallel
#
# Every image is compared byte for byte with those of a plain run. Takes about two minutes on two CPUs; everything that waits has a
# deadline. Packages: scripts/install.sh build farm. Exits 0 only if all of it held; cleans up in any case.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
BACKLIGHT=$(realpath "${1:-$top/build/release/bin/backlight}")
export BACKLIGHT
scene=$top/tests/farm/moving.toml
work=$(mktemp -d "${TMPDIR:-/tmp}/backlight-farm-XXXXXX")
chmod 0755 "$work"
export FARM=$work/slurm SLURM_CONF=$work/slurm/slurm.conf
submit=$top/scripts/farm/submit.sh
orphan=''

finish() {
  local status=$?
  [[ -z ${KEEP:-} ]] || { scontrol -o show job >"$KEEP"; cp -r "$work" "$KEEP.d"; }
  set +e
  [[ -z $orphan ]] || kill -9 "$orphan" 2>/dev/null
  if ((status)); then
    echo "--- the last lines of the logs"
    tail -n 15 "$work"/*/farm/*/logs/* "$FARM"/log/slurmctld.log 2>/dev/null
    squeue 2>/dev/null
    echo "tests/farm/run.sh: FAILED: ${step:-at the start}"
  fi
  "$top/scripts/farm/one-machine.sh" down >/dev/null 2>&1
  rm -rf "$work"
  exit "$status"
}
trap finish EXIT
trap 'exit 130' INT TERM

step=''
begin() { step=$1; echo "[$SECONDS s] $step"; }
fail() { echo "tests/farm/run.sh: $*" >&2; exit 1; }

# until_true SECONDS WHAT COMMAND...: waits for the command to succeed
until_true() {
  local deadline=$((SECONDS + $1)) what=$2
  shift 2
  until "$@"; do
    ((SECONDS < deadline)) || fail "waited in vain for: $what"
    sleep 0.02
  done
}

queue_is_empty() { [[ -z $(squeue -h -j "$1" 2>/dev/null) ]]; }
state_of() { scontrol -o show job "$1" | grep -o 'JobState=[A-Z_]*' | sort | uniq -c | tr -s ' \n' ' '; }
count() { find "$1" -maxdepth 1 -name "$2" 2>/dev/null | wc -l; }
has_images() { (($(count "$1" '*.exr') >= $2)); }

# expect_same FOLDER [COUNT]: its images are those of the plain run, and there is nothing else in it
expect_same() {
  local folder=$1 expected=${2:-16} image left
  (($(count "$folder" 'flight.*.exr') == expected)) || fail "$folder has $(count "$folder" '*.exr') images instead of $expected"
  for image in "$folder"/flight.*.exr; do
    cmp "$work/plain/${image##*/}" "$image" || fail "$image is not as in the plain run"
  done
  left=$(find "$folder" -mindepth 1 -maxdepth 1 ! -name 'flight.????.exr' ! -name farm ! -name '*.mp4')
  [[ -z $left ]] || fail "left behind: $left"
}

# The process number of the renderer that a node runs.
renderer_of() {
  local folder
  for folder in /proc/[0-9]*; do
    [[ $(cat "$folder/comm" 2>/dev/null) == backlight ]] || continue
    tr '\0' '\n' <"$folder/environ" 2>/dev/null | grep -qx "SLURMD_NODENAME=$1" || continue
    tr '\0' '\n' <"$folder/environ" 2>/dev/null | grep -qx "FARM=$FARM" || continue
    echo "${folder#/proc/}"
    return
  done
  return 1
}
parent_of() { sed -n 's/^PPid:\t//p' "/proc/$1/status"; }

# Stops the orphan in the middle of an image (there is its claim, and not yet the image), as a node does that hangs. Not before
# its daemons are gone: a stopped process that becomes an orphan is sent SIGHUP.
freeze_orphan() {
  kill -STOP "$orphan" || fail "the orphan is gone"
  local claim
  for claim in "$work"/array/*.claim; do
    frozen_image=${claim%.claim}
    [[ -e $claim && ! -e $frozen_image ]] && grep -q "$orphan" "$claim" && return
  done
  kill -CONT "$orphan"
  return 1
}
runs_on_n1() { orphan=$(renderer_of n1); }
has_lost() { [[ $(parent_of "$orphan") != "$1" ]]; }
is_gone() { [[ ! -e /proc/$1 ]]; }
is_file() { compgen -G "$1" >/dev/null; }
requeued_task_runs() { grep -qs 'on n2, start number 2' "$job"/logs/task-*.log; }
node_is_idle() { [[ $(sinfo -h -N -n n1 -o %T) == idle ]]; }
node_is_down() { [[ $(sinfo -h -N -n n1 -o %T) == down* ]]; }
job_folder() { find "$1/farm" -maxdepth 1 -name 'job-*' -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d ' ' -f 2; }

free_ports() {
  local base port
  for ((base = 26817; base < 27817; base += 10)); do
    for port in 0 1 2; do
      (exec 3<>"/dev/tcp/127.0.0.1/$((base + port))") 2>/dev/null && continue 2
    done
    echo $base
    return
  done
  return 1
}

begin "a plain run"
"$BACKLIGHT" render "$scene" -o "$work/plain/flight.####.exr" -q
(($(count "$work/plain" '*.exr') == 16)) || fail "the plain run made no 16 images"

begin "two nodes"
FARM_PORT=$(free_ports)
export FARM_PORT
"$top/scripts/farm/one-machine.sh" up >/dev/null
[[ $(sinfo -h -N -t idle -o %N | sort -u | xargs) == "n1 n2" ]] || fail "no two idle nodes"

begin "an array job, one node lost in the middle"
read -r array gather < <("$submit" --chunk 4 --mem-per-cpu 300M --time 10 --video "$work/array/flight.mp4" --fps 8 \
  "$scene" -o "$work/array/flight.####.exr" --claim-expires 3)
job=$(job_folder "$work/array")
until_true 30 "images of the array job" has_images "$work/array" 1
until_true 20 "a renderer on node n1" runs_on_n1
done_before=$(count "$work/array" '*.exr')
((done_before >= 1 && done_before < 16)) || fail "the node was to be killed in the middle, not with $done_before images of 16"
stepd=$(parent_of "$orphan")
[[ $(cat "/proc/$stepd/comm") == slurmstepd ]] || fail "the renderer of n1 is no child of slurmstepd"
kill -9 "$(cat "$FARM/run/slurmd.n1.pid")" "$stepd"
until_true 5 "the death of slurmstepd" has_lost "$stepd"
until_true 10 "an image in the orphan's hands" freeze_orphan
until_true 60 "node n1 to be down" node_is_down
until_true 60 "the lost task to be started again" requeued_task_runs
[[ $(scontrol -o show job "$array" | grep -c 'Restarts=1') == 1 ]] || fail "no task was requeued"
[[ ! -e $frozen_image ]] || fail "$frozen_image was there before the second writer"
until_true 30 "the second writer's image" is_file "$frozen_image"
kill -CONT "$orphan"   # it goes on in the middle of an image that another task has made, and with all its others
until_true 60 "the array job" queue_is_empty "$array"
until_true 30 "the gather job" queue_is_empty "$gather"
until_true 30 "the orphan's end" is_gone "$orphan"
orphan=''
[[ $(state_of "$array") == " 4 JobState=COMPLETED " ]] || fail "array job: $(state_of "$array")"
[[ $(state_of "$gather") == " 1 JobState=COMPLETED " ]] || fail "gather job: $(state_of "$gather")"
grep -q '^all 16 images are complete' "$job/logs/gather.log" || fail "the gather job did not look at all images"
expect_same "$work/array"
pictures=$(ffprobe -v error -count_packets -select_streams v -show_entries stream=nb_read_packets -of csv=p=0 "$work/array/flight.mp4")
[[ $pictures == 16 ]] || fail "the video has $pictures pictures"
# In any of the tasks, and however often it was started, an image is rendered once; the frozen one twice.
rendered=$(cat "$job"/logs/task-*.json | wc -l)
((rendered <= 17)) || fail "$rendered images were rendered for 16"

begin "node n1 comes back"
PATH=$PATH:/usr/sbin slurmd -N n1
until_true 30 "node n1" node_is_idle

begin "the same job again: nothing to do"
read -r array gather < <("$submit" --chunk 8 "$scene" -o "$work/array/flight.####.exr")
job=$(job_folder "$work/array")
until_true 60 "the array job" queue_is_empty "$array,$gather"
[[ $(state_of "$gather") == " 1 JobState=COMPLETED " ]] || fail "gather job: $(state_of "$gather")"
[[ -z $(cat "$job"/logs/task-*.json) ]] || fail "complete images were rendered again"
expect_same "$work/array"

begin "requeued in the middle of an image"
slow=(-f 7 -s 2048 -r 240x135)   # seconds of work, so that its middle can be met
"$BACKLIGHT" render "$scene" "${slow[@]}" -o "$work/plain/slow.exr" -q
read -r array gather < <("$submit" "$scene" "${slow[@]}" -o "$work/requeue/slow.exr")
job=$(job_folder "$work/requeue")
until_true 30 "the image to be begun" is_file "$work/requeue/*.claim"
sleep 0.2
scontrol requeue "$array"
until_true 20 "the partial image" is_file "$work/requeue/*.partial.exr"
[[ -z $(find "$work/requeue" -maxdepth 1 -name 'slow*.exr' ! -name '*.partial.exr') ]] || fail "the image was whole before the requeue"
until_true 90 "the array job" queue_is_empty "$array,$gather"
grep -q 'start number 2' "$job/logs/task-0.log" || fail "the task was not started twice"
cmp "$work"/plain/slow*.exr "$work"/requeue/slow*.exr || fail "the resumed image has other bytes"

begin "one image in parts"
"$BACKLIGHT" render "$scene" -f 5 -r 320x181 -s 16 -o "$work/plain/still.exr" -q
read -r array gather < <("$submit" --parts 7 --chunk 2 "$scene" -f 5 -r 320x181 -s 16 -o "$work/parts/still.exr")
until_true 60 "the array job" queue_is_empty "$array,$gather"
cmp "$work"/plain/still*.exr "$work"/parts/still*.exr || fail "the image put together has other bytes"
[[ -z $(find "$work/parts" -name '*.parts') ]] || fail "the parts were left behind"

begin "a task that fails"
mkdir "$work/fails"
cp "$scene" "$work/fails/"
sed -i 's/^velocity = .*/velocity = ["0.5 + 0.5*image_time", 0, 0]/' "$work/fails/moving.toml"
read -r array gather < <("$submit" --chunk 8 --video "$work/fails/flight.mp4" "$work/fails/moving.toml" -f 1-16 -s 1 -r 16x9 -o "$work/fails/flight.####.exr")
until_true 60 "the array job" queue_is_empty "$array"
until_true 30 "the end of the gather job" queue_is_empty "$gather"
[[ $(state_of "$array") == *FAILED* ]] || fail "the task did not fail: $(state_of "$array")"
[[ ! -e $work/fails/flight.mp4 ]] || fail "a video was made of images that are not there"
[[ $(state_of "$gather") == *CANCELLED* ]] || fail "the gather job was not cancelled: $(state_of "$gather")"

begin "a shell loop"
for frame in $("$BACKLIGHT" render "$scene" --list-frames | cut -f 1); do
  "$BACKLIGHT" render "$scene" -f "$frame" -o "$work/loop/flight.####.exr" -q
done
expect_same "$work/loop"

begin "GNU parallel"
"$BACKLIGHT" render "$scene" --list-frames | cut -f 1 |
  parallel --will-cite -j2 "$BACKLIGHT" render "$scene" -f {} -o "$work/parallel/flight.####.exr" -q -t 1
expect_same "$work/parallel"

begin "done"
step=''
echo "tests/farm/run.sh: everything held, in $SECONDS s"
