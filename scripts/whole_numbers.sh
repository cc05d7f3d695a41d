# shellcheck shell=bash
# For scripts to source: ends the script with exit status 2, and says why, unless all arguments are whole numbers.
need_whole_numbers() {
  local number
  for number in "$@"; do
    [[ $number =~ ^[0-9]+$ ]] || { echo "scripts/${0##*/}: '$number' is not a whole number" >&2; exit 2; }
  done
}
