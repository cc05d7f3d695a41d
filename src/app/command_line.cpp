// The only file that includes CLI11, which takes a compiler longer than the rest of the folder.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>

#include "backlight/base/diagnostics.h"
#include "command_table.h"
#include "help_text.h"

namespace backlight {
namespace {

using Tables = std::vector<CommandTable>;

const CommandTable* find_table(const Tables& tables, std::string_view name) {
  const auto found = std::ranges::find(tables, name, &CommandTable::name);
  return found != tables.end() ? &*found : nullptr;
}

std::vector<std::string> names_of(const Tables& tables) {
  std::vector<std::string> names;
  for (const CommandTable& table : tables) names.push_back(table.name);
  return names;
}

bool is_flag(const std::string& argument) {
  return argument.size() > 1 && argument.front() == '-';
}

bool is_known(const Tables& tables, const std::string& name) {
  return std::ranges::any_of(tables, [&](const CommandTable& table) { return find_row(table, name); });
}

// Whether the argument after `flag` is its value, in whichever command has such a flag.
bool takes_next(const std::string& flag, const Tables& tables) {
  return std::ranges::any_of(tables, [&flag](const CommandTable& table) {
    const OptionRow* row = find_row(table, flag);
    return row != nullptr && !row->value.empty();
  });
}

// The index of the first argument that is neither a flag nor the value of one.
std::size_t first_word(const std::vector<std::string>& arguments, const Tables& tables) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--") return i + 1;
    if (!is_flag(arguments[i])) return i;
    if (takes_next(arguments[i], tables)) ++i;
  }
  return arguments.size();
}

Answer usage_error(const std::string& command, const std::string& message) {
  const std::string help = command.empty() ? "backlight --help" : "backlight " + command + " --help";
  return {"backlight: " + message + "\nTry '" + help + "'.", true};
}

Answer unknown_argument(const Tables& tables, const CommandTable& table,
                        const std::vector<std::string>& extras) {
  const auto flag = std::ranges::find_if(extras, is_flag);
  if (flag == extras.end()) return usage_error(table.name, "unexpected argument '" + extras.front() + "'");
  const std::string name = flag->substr(0, flag->find('='));
  for (const CommandTable& other : tables) {
    if (find_row(other, name) != nullptr)
      return usage_error(table.name, "'" + name + "' is an option of 'backlight " + other.name + "'");
  }
  std::vector<std::string> known;
  for (const OptionRow& row : table.options) {
    std::ranges::copy_if(row.names, std::back_inserter(known),
                         [](const std::string& one) { return one.starts_with("--"); });
  }
  const std::string nearest = name.starts_with("--") ? nearest_name(name, known) : "";
  return usage_error(table.name, "unknown option '" + name + "'" +
                                     (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

// Of the first `count` arguments, an option that no command has: what follows it may be meant as its value.
std::optional<std::string> unknown_option(const std::vector<std::string>& arguments, std::size_t count,
                                          const Tables& tables) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& argument = arguments[i];
    // Of short options, the letter: its value may be joined to it.
    const std::string name =
        argument.starts_with("--") ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
    if (is_flag(argument) && !is_known(tables, name)) return argument;
    if (takes_next(argument, tables)) ++i;
  }
  return std::nullopt;
}

// The first of the arguments that names a command; without one, to render is meant.
const CommandTable& meant_command(const std::vector<std::string>& arguments, const Tables& tables) {
  for (const std::string& argument : arguments) {
    if (const CommandTable* table = find_table(tables, argument)) return *table;
  }
  return tables.front();
}

// What CLI11 is told of an option.
CLI::Option* add_option(CLI::App& app, const OptionRow& row) {
  std::string names;
  for (const std::string& name : row.names) names += (names.empty() ? "" : ",") + name;
  const auto take = [&row](const std::string& text) {
    if (const auto taken = row.take(text); !taken.ok())
      throw CLI::ValidationError(row.names.back(), taken.error());
  };
  if (!row.take) return app.set_help_flag(names);
  if (row.value.empty()) return app.add_flag_callback(names, [take] { take(""); });
  if (!row.every) return app.add_option_function<std::string>(names, take);
  const auto take_all = [take](const std::vector<std::string>& texts) { std::ranges::for_each(texts, take); };
  return app.add_option_function<std::vector<std::string>>(names, take_all)
      ->allow_extra_args(false)
      ->take_all();
}

// Reads the options of the table; the operands go into `operands`, and what is left is returned. Throws
// CLI::ParseError.
std::vector<std::string> take_options(const CommandTable& table, std::vector<std::string> arguments,
                                      std::vector<std::string>& operands) {
  CLI::App app;
  app.allow_extras();  // unknown flags are reported by unknown_argument()
  app.option_defaults()->take_last();
  app.set_help_flag();
  if (!table.operands.empty()) app.add_option(table.operands, operands);
  std::vector<CLI::Option*>
      options;  // by row: CLI11 looks options up by name without room for std::bad_alloc
  for (const OptionRow& row : table.options) options.push_back(add_option(app, row));
  for (std::size_t i = 0; i < options.size(); ++i) {
    const OptionRow* needed = find_row(table, table.options[i].needs);
    if (needed != nullptr)
      options[i]->needs(options[static_cast<std::size_t>(needed - table.options.data())]);
  }
  std::ranges::reverse(arguments);  // CLI11 takes them from the end
  app.parse(std::move(arguments));
  std::vector<std::string> extras = app.remaining();
  std::erase(extras, "--");
  return extras;
}

Command parse_command(const Tables& tables, const CommandTable& table,
                      const std::vector<std::string>& arguments) {
  std::vector<std::string> operands;
  try {
    const std::vector<std::string> extras = take_options(table, arguments, operands);
    if (!extras.empty()) return unknown_argument(tables, table, extras);
  } catch (const CLI::CallForHelp&) {
    return Answer{help_of(manual_of(table)), false};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string message = error.what();  // "--samples: 1 required N missing"
    return usage_error(table.name, message.substr(0, message.find(':')) + " needs a value");
  } catch (const CLI::ParseError& error) {
    return usage_error(table.name, error.what());
  }
  auto command = table.finish(operands);
  if (!command.ok()) return usage_error(table.name, command.error());
  if (auto* options = std::get_if<RenderOptions>(&command.value())) options->arguments = arguments;
  return std::move(command).value();
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return usage_error("", "no scene file is given");
  const Tables tables = command_tables();
  const std::size_t place = first_word(arguments, tables);
  if (place >= arguments.size()) {
    const auto asks = [&arguments](const char* flag) {
      return std::ranges::find(arguments, flag) != arguments.end();
    };
    if (asks("--help") || asks("-h")) return Answer{general_help(), false};
    if (asks("--version")) return Answer{"Backlight " BACKLIGHT_VERSION "\n", false};
    return parse_command(tables, tables.front(), arguments);
  }
  const std::string& word = arguments[place];
  std::vector<std::string> rest = arguments;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(place));
  if (word == "help") {
    if (rest.empty()) return Answer{general_help(), false};
    if (const CommandTable* table = find_table(tables, rest[0]))
      return parse_command(tables, *table, {"--help"});
    return usage_error("", not_one_of(names_of(tables), rest[0]).message);
  }
  if (const CommandTable* table = find_table(tables, word)) return parse_command(tables, *table, rest);
  const bool looks_like_a_file =
      word == "-" || word.find_first_of("./") != std::string::npos || std::filesystem::exists(word);
  if (!looks_like_a_file) {
    if (const auto option = unknown_option(arguments, place, tables))
      return unknown_argument(tables, meant_command(arguments, tables), {*option});
    const std::string nearest = nearest_name(word, names_of(tables));
    return usage_error("", "there is neither a command nor a file called '" + word + "'" +
                               (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  return parse_command(tables, tables.front(), arguments);
}

}  // namespace backlight
