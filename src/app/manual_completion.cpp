#include <algorithm>

#include "manual.h"

namespace backlight {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> names_of(const std::vector<CommandManual>& commands) {
  std::vector<std::string> names;
  for (const CommandManual& command : commands) names.push_back(command.name);
  return names;
}

// ".exr" of "IMAGE.exr": the files that a word may be the name of. Empty: any.
std::string extension_of(const std::string& value) {
  const std::size_t dot = value.rfind('.');
  const std::size_t space = value.find(' ');
  return dot == std::string::npos || dot > space ? "" : value.substr(dot, space - dot);
}

// What an option's value is.
enum class Kind { nothing, word, list, file, folder, other };

Kind kind_of(const OptionManual& option) {
  if (option.value.empty()) return Kind::nothing;
  if (!option.words.empty()) return option.value == "LIST" ? Kind::list : Kind::word;
  if (option.value == "FOLDER") return Kind::folder;
  const bool is_file =
      option.value.starts_with("FILE") || option.value == "PATTERN" || !extension_of(option.value).empty();
  return is_file ? Kind::file : Kind::other;
}

std::string bash_values(const OptionManual& option) {
  switch (kind_of(option)) {
    case Kind::word:
      return "_backlight_words \"" + joined(option.words, " ") + "\"";
    case Kind::list:
      return "_backlight_list \"" + joined(option.words, " ") + "\"";
    case Kind::file:
      return "_backlight_files '" + extension_of(option.value) + "'";
    case Kind::folder:
      return "_backlight_files /";
    default:
      return ":";
  }
}

// Of one command: what may follow an option, which options there are, and what else is a word of it.
std::string bash_case(const CommandManual& command) {
  std::string values;
  std::vector<std::string> names;
  for (const OptionManual& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
    if (option.value.empty()) continue;
    values += "        " + joined(option.names, " | ") + ") " + bash_values(option) + "; return ;;\n";
  }
  return "    " + command.name + ")\n      case $prev in\n" + values + "      esac\n      options='" +
         joined(names, " ") + "' extension='" + extension_of(command.operands) + "' ;;\n";
}

// Within single quotes and brackets of a specification of _arguments.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

std::string zsh_files(const std::string& extension) {
  return extension.empty() ? "_files" : "_files -g \"*" + extension + "\"";
}

// Its first clause: a line of a menu is short.
std::string brief(const std::string& meaning) {
  return meaning.substr(0, std::min(meaning.find_first_of(";.("), meaning.find(", ")));
}

std::string zsh_option(const OptionManual& option) {
  std::string action;
  switch (kind_of(option)) {
    case Kind::nothing:
      break;
    case Kind::word:
      action = ":" + option.value + ":(" + joined(option.words, " ") + ")";
      break;
    case Kind::list:
      action = ":" + option.value + ":_values -s , " + option.value + " " + joined(option.words, " ");
      break;
    case Kind::file:
      action = ":" + zsh_text(option.value) + ":" + zsh_files(extension_of(option.value));
      break;
    case Kind::folder:
      action = ":" + option.value + ":_files -/";
      break;
    case Kind::other:
      action = ":" + zsh_text(option.value) + ": ";
  }
  std::string text;
  for (const std::string& name : option.names) {
    const std::string takes = option.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
    text += "        '*" + name + takes + "[" + zsh_text(brief(option.meaning)) + "]" + action + "' \\\n";
  }
  return text;
}

}  // namespace

std::string bash_completion(const std::vector<CommandManual>& commands) {
  std::string cases;
  for (const CommandManual& command : commands) cases += bash_case(command);
  const std::string names = joined(names_of(commands), " ");
  return R"(# Completion of backlight for bash, made by 'backlight manual --bash'.

_backlight_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"); }

# The same with commas between.
_backlight_list() {
  local before=''
  [[ $cur == *,* ]] && before=${cur%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${cur##*,}")
}

# Files whose names end in $1, and folders; only folders for /.
_backlight_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(
    compgen -d -- "$cur"
    [[ $1 == / ]] || compgen -f -X "!*$1" -- "$cur" | while IFS= read -r file; do [[ -d $file ]] || printf '%s\n' "$file"; done
  )
}

_backlight() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command=render options='' extension='' i
  COMPREPLY=()
  if [[ $cur == = ]]; then
    cur=''
  elif [[ $prev == = ]]; then
    prev=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
      )" +
         joined(names_of(commands), " | ") +
         R"() command=${COMP_WORDS[i]}; break ;;
    esac
  done
  case $command in
)" + cases +
         R"(  esac
  if [[ $cur == -* ]]; then
    _backlight_words "$options"
  else
    [[ -n $extension ]] && _backlight_files "$extension"
    if ((COMP_CWORD == 1)); then
      local files=("${COMPREPLY[@]}")
      _backlight_words ")" +
         names + R"("
      COMPREPLY+=("${files[@]}")
    fi
  fi
}

complete -F _backlight backlight
)";
}

std::string zsh_completion(const std::vector<CommandManual>& commands) {
  std::string cases;
  std::string descriptions;
  for (const CommandManual& command : commands) {
    descriptions += "    '" + command.name + ":" + zsh_text(brief(command.meaning)) + "'\n";
    std::string options;
    for (const OptionManual& option : command.options) options += zsh_option(option);
    const std::string operands =
        command.operands.empty()
            ? "''"
            : "'*:" + zsh_text(command.operands) + ":" + zsh_files(extension_of(command.operands)) + "'";
    cases +=
        "    " + command.name + ")\n      _arguments -s \\\n" + options + "        " + operands + " ;;\n";
  }
  return R"(#compdef backlight
# Completion of backlight for zsh, made by 'backlight manual --zsh'.

_backlight() {
  local command=render word
  local -a commands
  commands=(
)" + descriptions +
         R"(  )
  for word in ${words[2,CURRENT-1]}; do
    (( ${commands[(I)$word:*]} )) && { command=$word; break }
  done
  if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then
    _describe command commands
  elif [[ $words[2] == $command ]]; then
    words=("$words[1]" "${(@)words[3,-1]}")
    (( CURRENT-- ))
  fi
  case $command in
)" + cases +
         R"(  esac
}

_backlight "$@"
)";
}

}  // namespace backlight
