#!/usr/bin/env bash
# One task of the array job of submit.sh: a chunk of frames, or of the parts of one image.
#
#   task.sh JOB_FOLDER        run by Slurm, with SLURM_ARRAY_TASK_ID
#
# The renderer takes this process's place wherever it can, so that Slurm's signals reach it directly: at SIGTERM it writes a partial image and
# ends with 143. After a requeue the same task finds that image and finishes it.
# shellcheck disable=SC2154 # the settings have the variables
set -euo pipefail
job=$1
# shellcheck source=/dev/null
source "$job/settings"
cd "$start_folder"
first=$((SLURM_ARRAY_TASK_ID * chunk))
safe=(--resume --claim --progress lines --stats "$job/logs/task-$SLURM_ARRAY_TASK_ID.json" -t "${SLURM_CPUS_PER_TASK:-1}")
echo "task $SLURM_ARRAY_TASK_ID on ${SLURMD_NODENAME:-$(hostname)}, start number $((${SLURM_RESTART_COUNT:-0} + 1))" >&2

if ((${#crops[@]} == 0)); then
  frames=$(IFS=,; echo "${numbers[*]:first:chunk}")
  # One image of no animation has no number to ask for.
  ((${#image_paths[@]} == 1)) || arguments+=(-f "$frames")
  exec "$program" render "$scene" "${arguments[@]}" "${safe[@]}"
fi

trap 'kill -TERM "$renderer" 2>/dev/null' TERM INT
for ((i = first; i < first + chunk && i < ${#crops[@]}; i++)); do
  "$program" render "$scene" "${arguments[@]}" "${safe[@]}" --crop "${crops[i]}" -o "${part_patterns[i]}" &
  renderer=$!
  status=0
  wait "$renderer" || status=$?
  # A signal ends the first wait; the second one has the renderer's own answer.
  while kill -0 "$renderer" 2>/dev/null; do
    status=0
    wait "$renderer" || status=$?
  done
  ((status == 0)) || exit "$status"
done
