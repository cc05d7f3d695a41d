// The options of the commands that print what the program knows of itself: schema, manual.
#include <algorithm>
#include <memory>

#include "backlight/film/exr.h"
#include "command_table.h"

namespace backlight {

CommandTable schema_table() {
  const auto options = std::make_shared<SchemaOptions>();
  CommandTable table{
      {"schema", "Print the JSON Schema of the scene format, for editors.", "schema > scene.json", ""}};
  RowGroup(table, "Options")
      .flag("--markdown", options->markdown, "print the reference page of the format instead");
  table.finish = [options](const std::vector<std::string>& /*none*/) -> Result<Command> {
    return Command{*options};
  };
  return table;
}

namespace {

Result<std::string> text_of_manual(const std::vector<std::string>& commands, bool bash, bool zsh) {
  if (int(bash) + int(zsh) + int(commands.size()) > 1) return Failure{"one page or one shell at a time"};
  const auto date = source_date_epoch();
  if (!date.ok()) return date.failure();
  std::vector<CommandManual> all;
  std::vector<std::string> names;
  for (const CommandTable& table : command_tables()) {
    all.push_back(manual_of(table));
    names.push_back(table.name);
  }
  if (bash) return bash_completion(all);
  if (zsh) return zsh_completion(all);
  if (commands.empty()) return manual_page(all, date.value());
  const auto found = std::ranges::find(all, commands.front(), &CommandManual::name);
  if (found == all.end()) return not_one_of(names, commands.front());
  return manual_page(*found, date.value());
}

}  // namespace

CommandTable manual_table() {
  struct State {
    bool bash = false;
    bool zsh = false;
  };
  const auto state = std::make_shared<State>();
  CommandTable table{
      {"manual",
       "Print a manual page, of the program or of a command, as `man -l -` reads it; or completion "
       "for a shell.",
       "manual [COMMAND] | man -l -\n       backlight manual --bash > FILE", "COMMAND"}};
  RowGroup group(table, "Output");
  group.flag("--bash", state->bash, "print completion for bash instead");
  group.flag("--zsh", state->zsh, "print completion for zsh instead");
  table.finish = [state](const std::vector<std::string>& commands) -> Result<Command> {
    const auto text = text_of_manual(commands, state->bash, state->zsh);
    if (!text.ok()) return text.failure();
    return Command{Answer{text.value(), false}};
  };
  return table;
}

}  // namespace backlight
