#!/usr/bin/env bash
# The last job of submit.sh: checks that every image is there, complete and made from the scene as it is now; puts parts
# together; makes the video. Exits 1, and makes nothing, where anything is missing.
#
#   gather.sh JOB_FOLDER
# shellcheck disable=SC2154 # the settings have the variables
set -euo pipefail
job=$1
# shellcheck source=/dev/null
source "$job/settings"
cd "$start_folder"

if ((${#crops[@]})); then
  "$program" assemble "${part_paths[@]}" "${assemble[@]}" -o "${image_paths[0]}"
  rm -- "${part_paths[@]}"
  rmdir --ignore-fail-on-non-empty "$(dirname "${part_paths[0]}")"
  echo "${image_paths[0]}: put together from ${#crops[@]} parts"
  exit 0
fi

missing=$("$program" render "$scene" "${arguments[@]}" --skip-existing --dry-run --quiet)
if [[ -n $missing ]]; then
  printf 'gather.sh: missing, or not of this scene and these settings:\n%s\n' "$missing" >&2
  exit 1
fi
echo "all ${#image_paths[@]} images are complete"
if [[ -n $video ]]; then
  "$here/../video.sh" "${image_paths[@]}" -o "$video" "${fps_option[@]}" --program "$program"
fi
