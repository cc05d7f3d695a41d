# What zsh would complete a command line with, one word a line: typed into a shell of its own.
#
#   zsh -f ask_zsh.zsh FOLDER "COMMAND LINE"        FOLDER has _backlight
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PROMPT= RPROMPT= PS2=; unsetopt zle_bracketed_paste 2>/dev/null; fpath=(${(q)1} \$fpath)"
zpty -w shell 'autoload -Uz compinit && compinit -u -D; zstyle ":completion:*" list-colors ""'
# Instead of a menu, each word that would be in it, between marks.
zpty -w shell 'compadd() {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return; fi
  local -a found
  builtin compadd -A found "$@"
  (( $#found )) && print -rl -- "<<"$^found">>"
  builtin compadd "$@"
}'
zpty -w shell 'echo READY'
zpty -r -m shell ignored '*READY*READY*'
zpty -w -n shell "$2"$'\t'
zpty -w -n shell $'\C-u'"echo DO''NE"$'\n'
zpty -r -m shell answer '*DONE*'
print -r -- $answer | tr -d '\r' | grep -o '<<[^<>]*>>' | sed 's/^<<//; s/>>$//; s/=$//' | sort -u
