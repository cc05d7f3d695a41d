#!/usr/bin/env bash
# Looks at the manual pages, which must be without a warning and name every option of --help, and asks the completion of bash
# and zsh for words.
#
#   tests/manual/run.sh PROGRAM FOLDER        FOLDER is emptied first
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
rm -rf "$2" && mkdir -p "$2/bin" "$2/work/folder" && cd "$2"
ln -s "$program" bin/backlight
export PATH="$PWD/bin:$PATH" SOURCE_DATE_EPOCH=1700000000
failed=0
complain() { echo "$*" >&2 && failed=1; }

mapfile -t commands < <(backlight --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
((${#commands[@]} >= 9)) || complain "only ${#commands[@]} commands: ${commands[*]}"
backlight manual >backlight.1
for command in "${commands[@]}"; do
  grep -q "^\\\\fB$command\\\\fR" backlight.1 || complain "backlight.1 does not list $command"
  page=backlight-$command.1
  backlight manual "$command" >"$page"
  text=$(mandoc -T ascii "$page" | col -b)
  [[ $text == *2023-11-14* ]] || complain "$page is not dated by SOURCE_DATE_EPOCH"
  mapfile -t options < <(backlight "$command" --help | grep -oE '^ +(-., )?--[a-z-]+' | grep -oE -- '--?[a-zA-Z-]+')
  ((${#options[@]} >= 2)) || complain "$command has no options"
  for option in "${options[@]}"; do
    [[ $text == *$option* ]] || complain "$page does not tell of $option"
  done
done
for page in *.1; do
  mandoc -T lint "$page" || complain "$page has faults"
done
[[ $(LC_ALL=C.UTF-8 man --warnings -l -Tutf8 backlight-render.1 2>&1 >/dev/null) == '' ]] || complain "man warns"
backlight manual | cmp - <(SOURCE_DATE_EPOCH=1700000000 backlight manual) || complain "not the same twice"

# ---- completion
cd work
touch scene.toml "two words.toml" image.exr folder/inner.toml
backlight manual --bash >../bash.sh
backlight manual --zsh >../_backlight

by_bash() { # words...: the last is what is to be completed
  bash --norc -c 'source ../bash.sh; COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _backlight; printf "%s\n" "${COMPREPLY[@]}"' _ backlight "$@" | sort | tr '\n' '|'
}
expect() { # NAME "WORDS|" GIVEN
  [[ $2 == "$3" ]] || complain "$1: expected $2, found $3"
}
expect bash "check|" "$(by_bash ch)"
expect bash "folder|scene.toml|two words.toml|" "$(by_bash check '')"
expect bash "--tolerance|--tone|" "$(by_bash scene.toml --to)"
expect bash "auto|drago|log|none|reinhard|" "$(by_bash view --tone '')"
expect bash "drago|" "$(by_bash scene.toml --tone = d)"
expect bash "auto|bar|json|lines|none|" "$(by_bash render --progress =)"
expect bash "Z,doppler|" "$(by_bash render --aov Z,dop)"
expect bash "lampTime|light.N|light.Y|" "$(by_bash view a.exr --channel l)"
expect bash "folder|image.exr|" "$(by_bash info '')"
expect bash "folder|" "$(by_bash compare a.exr b.exr --scenes '')"
expect bash "folder|image.exr|scene.toml|two words.toml|" "$(by_bash render -o '')"
[[ $(by_bash '') == *compare*folder*render*scene.toml* ]] || complain "bash: the first word: $(by_bash '')"

by_zsh() { zsh -f "$here/ask_zsh.zsh" "$PWD/.." "$*" | sort | tr '\n' '|'; }
expect zsh "check|" "$(by_zsh backlight ch)"
expect zsh "folder|scene.toml|two\\ words.toml|" "$(by_zsh backlight check '')"
expect zsh "--tolerance|--tone|" "$(by_zsh backlight scene.toml --to)"
expect zsh "auto|drago|log|none|reinhard|" "$(by_zsh backlight view --tone '')"
expect zsh "doppler|" "$(by_zsh backlight render --aov Z,dop)"
expect zsh "lampTime|light.N|light.Y|" "$(by_zsh backlight view a.exr --channel l)"
expect zsh "folder|image.exr|" "$(by_zsh backlight info '')"
expect zsh "folder|" "$(by_zsh backlight compare a.exr b.exr --scenes '')"
((failed == 0)) && echo "Pages and completion are right."
exit "$failed"
