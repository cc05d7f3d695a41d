# shellcheck shell=bash
# Which backlight a script runs, for scripts to source.
#
#   program=$(find_program [FILE])
#
# FILE or, where it is empty or missing, that of the environment variable BACKLIGHT, the one in the PATH, or
# build/release/bin/backlight of this clone: the first that is named. Prints its absolute path; says why, and fails, where
# it cannot be run.
find_program_top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)  # now: the name may start at the current folder, which changes
find_program() {
  local top=$find_program_top program=${1:-${BACKLIGHT:-}}
  [[ -n $program ]] || program=$(command -v backlight) || program=$top/build/release/bin/backlight
  [[ -n $program && ! -e $program && -e $top/../../bin/backlight ]] && program=$top/../../bin/backlight
  if ! command -v "$program" >/dev/null; then
    echo "${0##*/}: there is no program $program: build it with scripts/render.sh, put it into the PATH, or name it in BACKLIGHT" >&2
    return 1
  fi
  realpath "$(command -v "$program")"
}
