#!/usr/bin/env bash
# Manual pages (compressed), completion and the JSON Schema, as the program prints them.
#
#   packaging/manual.sh PROGRAM FOLDER
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
program=$1 folder=$2
rm -rf "$folder/man1" && mkdir -p "$folder/man1"

# page NAME: from standard input
page() { gzip -9n >"$folder/man1/$1.1.gz"; }

# script_page NAME SCRIPT "WHAT": the comment that a script begins with, as it stands, under the name that it is installed by
script_page() {
  local day=''
  [[ -z ${SOURCE_DATE_EPOCH:-} ]] || day=$(date -u -d "@$SOURCE_DATE_EPOCH" +%F)
  {
    printf '.TH %s 1 "%s" "Backlight" "Backlight"\n.SH NAME\n%s \\- %s\n.SH DESCRIPTION\n.nf\n' "${1^^}" "$day" "${1//-/\\-}" "$3"
    sed -n '2,/^set -/{/^set -/d;/^# shellcheck/d;s/^# \{0,1\}//p}' "$top/scripts/$2" |
      sed "s|scripts/$2|$1|g; s/\\\\/\\\\e/g; s/-/\\\\-/g; s/'/\\\\(aq/g; s/^\\./\\\\\\&./; s/^\$/.sp/"
    printf '.fi\n.SH SEE ALSO\n.BR backlight (1)\n'
  } | page "$1"
}

"$program" manual | page backlight
for command in $("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
  "$program" manual "$command" | page "backlight-$command"
done
script_page backlight-video video.sh "make a video of rendered frames"
script_page backlight-farm farm/submit.sh "render an animation as an array job of a Slurm cluster"
"$program" manual --bash >"$folder/completion.bash"
"$program" manual --zsh >"$folder/_backlight"
"$program" schema >"$folder/backlight.schema.json"
