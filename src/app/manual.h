// Manual pages and completion, of the options as the command line declares them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace backlight {

/// An option as --help shows it.
struct OptionManual {
  std::vector<std::string> names;  ///< "-o", "--output"
  std::string value;               ///< what it is called, "PATTERN"; empty: the option takes none
  std::vector<std::string> words;  ///< the values that it may have, where they are few
  std::string meaning;
  std::string group;
};

/// What a command is.
struct CommandWords {
  std::string name;
  std::string meaning;   ///< sentences
  std::string usage;     ///< after the program's name; a line each
  std::string operands;  ///< what stands without an option, as in "SCENE.toml"; empty: nothing does
};

/// A command as its --help shows it.
struct CommandManual : CommandWords {
  std::vector<OptionManual> options;
};

/// The page backlight-COMMAND(1), in the macros of man(7). `date`: seconds since 1970 that it is dated by.
std::string manual_page(const CommandManual& command, std::optional<std::int64_t> date);
/// The page backlight(1), which lists the commands.
std::string manual_page(const std::vector<CommandManual>& commands, std::optional<std::int64_t> date);

/// Completion for bash, to be put where bash-completion looks: .../completions/backlight.
std::string bash_completion(const std::vector<CommandManual>& commands);
/// Completion for zsh, to be put into a folder of its fpath as _backlight.
std::string zsh_completion(const std::vector<CommandManual>& commands);

}  // namespace backlight
