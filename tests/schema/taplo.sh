#!/usr/bin/env bash
# The `#:schema` line as editors read it, by taplo, which Even Better TOML of VS Code has inside: every scene is right, and a misspelt key of
# each is refused at its line.
#
#   tests/schema/taplo.sh PROGRAM SCENES FOLDER        exit status 77: skipped, as taplo is not installed (npm install -g @taplo/cli)
set -euo pipefail
program=$1 scenes=$2 folder=$3
command -v taplo >/dev/null || { echo "skipped: taplo is not installed" && exit 77; }
rm -rf "$folder" && mkdir -p "$folder/right" "$folder/wrong"
"$program" schema >"$folder/backlight.schema.json"
for scene in "$scenes"/*.toml; do
  name=$(basename "$scene")
  { echo '#:schema ../backlight.schema.json' && cat "$scene"; } >"$folder/right/$name"
  sed '0,/^\(position\|projection\|look_at\|include\|resolution\) =/s//x\1 =/' "$folder/right/$name" >"$folder/wrong/$name"
done
cd "$folder"
taplo check right/*.toml
refused=0
for scene in wrong/*.toml; do
  ! cmp -s "$scene" "right/${scene#wrong/}" || continue
  line=$(grep -n '^x[a-z_]* =' "$scene" | head -n 1 | cut -d: -f1)
  ! taplo check "$scene" >told 2>&1 || { echo "$scene is not refused" >&2 && exit 1; }
  grep -q "$scene:$line:" told || { cat told && echo "$scene: not refused at line $line" >&2 && exit 1; }
  refused=$((refused + 1))
done
echo "$refused misspelt keys are refused."
((refused > 30))
