#!/usr/bin/env bash
# Kills renders at random moments, and checks that nothing is lost, torn or made twice.
#
# Usage: scripts/soak.sh [SECONDS] [BACKLIGHT]
#
# Several processes render one animation into one folder with --claim --resume; each is killed after a random
# time, by SIGKILL, SIGTERM or SIGHUP, and begun again, until every image is there. The images must be those
# of a run that nobody disturbed, to the byte; each must have been finished once; nothing else may be left.
# Rounds go on for SECONDS (60).
set -euo pipefail

seconds=${1:-60}
root=$(cd "$(dirname "$0")/.." && pwd)
# shellcheck source=scripts/find_program.sh
source "$root/scripts/find_program.sh"
# This clone's own, whatever is in the PATH: it is what is tested.
backlight=$(find_program "${2:-$root/build/release/bin/backlight}") || exit 2
workers=3
frames=20
folder=$(mktemp -d "${TMPDIR:-/tmp}/backlight-soak-XXXXXX")
trap 'rm -rf "$folder"' EXIT

cat > "$folder/scene.toml" <<'SCENE'
[animation]
fps = 10
frames = [1, 20]
[film]
resolution = [48, 36]
samples = 100
aovs = ["Z", "doppler", "P"]
[camera]
position = [0, 0, -5]
look_at = [0, 0, 0]
velocity = [0, 0, 0.3]
[[light]]
type = "distant"
direction = [1, -1, 1]
irradiance = 3
[[object]]
shape = "torus"
major = 1
minor = 0.4
rotate = ["40*image_time", 20, 0]
velocity = [0.6, 0, 0]
SCENE

cd "$folder"
options=(scene.toml -t 1 -q)
"$backlight" "${options[@]}" -o right/a.exr

# One worker: is killed and begins again until it ends by itself.
work() {
  RANDOM=$1
  local code=1
  while [ "$code" -ne 0 ]; do
    "$backlight" "${options[@]}" -o made/a.exr --claim --resume --stats stats.json 2>> errors &
    local process=$!
    sleep "0.$(printf '%03d' $((RANDOM % 400)))"
    case $((RANDOM % 4)) in
      0) kill -KILL $process 2> /dev/null || true ;;
      1) kill -TERM $process 2> /dev/null || true ;;
      2) kill -HUP $process 2> /dev/null || true ;;
      *) kill -USR1 $process 2> /dev/null || true ;;
    esac
    code=0
    wait $process 2> /dev/null || code=$?
    echo "$code" >> codes
    case $code in
      0 | 129 | 137 | 138 | 143) ;;
      *) echo "unexpected exit status $code" >> wrong ;;
    esac
  done
}

round=0
end=$((SECONDS + seconds))
while [ $SECONDS -lt $end ]; do
  round=$((round + 1))
  rm -rf made stats.json errors codes wrong
  mkdir made
  for worker in $(seq $workers); do work $((1000 * round + worker)) & done
  wait
  diff -r right made || echo "the images differ, or files are left over" >> wrong
  finished=$(grep -o '"file":"[^"]*"' stats.json | sort | uniq -d)
  [ -z "$finished" ] || echo "made twice: $finished" >> wrong
  if [ -s wrong ]; then
    cat wrong errors >&2
    exit 1
  fi
  echo "round $round: $frames images, $workers processes, $(wc -l < codes) runs: all right"
done
