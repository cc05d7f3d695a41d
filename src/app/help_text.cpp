#include "help_text.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace backlight {

std::string program_text() {
  return "Backlight renders scenes as special relativity shows them.\n";
}

std::string exit_status_text() {
  return "0 all images written; 1 an image failed; 2 the command line is wrong; 3 the scene is wrong;\n"
         "4 a file cannot be read or written; 128+n stopped by signal n. compare: 0 equal; 1 differs; 2 "
         "trouble.\n";
}

std::vector<std::pair<std::string, std::string>> environment_variables() {
  return {{"BACKLIGHT_MODULE_PATH",
           "folder of the modules that are loaded on demand; default: lib/backlight beside the program's "
           "folder."},
          {"SLURM_CPUS_PER_TASK", "the most threads that are used where -t does not say how many."},
          {"SOURCE_DATE_EPOCH", "seconds since 1970 that images are dated by; without it they have no date."},
          {"NO_COLOR", "turns the colour of messages off, if it is not empty."}};
}

std::string general_help() {
  return program_text() + R"(
Usage: backlight [render] SCENE.toml [options]
       backlight COMMAND ...

Commands:
  render SCENE.toml   trace the images of a scene into OpenEXR files (the default)
  check  SCENE.toml   look for mistakes in a scene and explain what it needs; renders nothing
  compare REF NEW     tell whether images are equal, and where and by how much not; HTML report
  view   IMAGE.exr    make a PNG to look at: exposure, tone curve, sRGB; contact sheets
  info   IMAGE.exr    tell what made an image
  probe  IMAGE.exr X,Y  tell what is at a pixel: object, Doppler factor, angles, times
  assemble PART.exr   put an image together that was rendered in parts with --crop
  schema              print the JSON Schema of the scene format, for editors
  manual              print manual pages, and completion for shells

'backlight COMMAND --help' lists the options of a command; 'backlight --version' prints the version.

Exit status: )" +
         exit_status_text();
}

namespace {

// An option with its meaning in a column beside it.
std::string help_row(std::string option, const std::string& meaning) {
  constexpr std::size_t indent = 31;
  constexpr std::size_t width = 100;
  std::string rows;
  std::string line = std::move(option) + "  ";
  line.resize(std::max(line.size(), indent), ' ');
  std::istringstream words(meaning);
  bool at_start = true;
  for (std::string word; words >> word; at_start = false) {
    if (!at_start && line.size() + 1 + word.size() > width) {
      rows += std::exchange(line, std::string(indent, ' ')) + "\n";
      at_start = true;
    }
    line += (at_start ? "" : " ") + word;
  }
  return rows + line + "\n";
}

}  // namespace

std::string help_of(const CommandManual& command) {
  std::string text = command.meaning + "\n\nUsage: backlight " + command.usage + "\n";
  std::string group;
  for (const OptionManual& option : command.options) {
    if (option.group != group) text += "\n" + option.group + ":\n";
    group = option.group;
    std::string names = option.names.front().starts_with("--") ? "    " : "";
    for (const std::string& name : option.names) names += (&name == &option.names.front() ? "" : ", ") + name;
    text += help_row("  " + names + (option.value.empty() ? "" : " " + option.value), option.meaning);
  }
  return text;
}

}  // namespace backlight
