// A command as a table of options: reading the command line, --help, manual pages and completion are made
// from it.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "manual.h"
#include "option_values.h"
#include "options.h"

namespace backlight {

/// The last of its names is a long one.
struct OptionRow : OptionManual {
  /// Takes the value; of an option without one, nothing. Null: it asks for help.
  std::function<Result<void>(const std::string&)> take;
  bool every = false;  ///< each one given counts, and not only the last
  std::string needs;   ///< another option, without which it is an error; or empty
};

struct CommandTable : CommandWords {
  std::vector<OptionRow> options;
  /// What is asked for, when all options have been taken.
  std::function<Result<Command>(const std::vector<std::string>& operands)> finish;
};

/// The row with this name, "-o" or "--output", or null.
const OptionRow* find_row(const CommandTable& table, std::string_view name);

/// Adds rows of one group. What they set must live as long as the table: its `finish` holds it.
class RowGroup {
 public:
  RowGroup(CommandTable& table, std::string name) : table_(table), name_(std::move(name)) {}

  /// An option without a value. `names` are as in "-o,--output".
  OptionRow& flag(const char* names, bool& target, std::string meaning);

  /// `read` makes a Result of the text; its value is assigned to `target`, or handed to it if it can be
  /// called.
  template <class Read, class Target>
  OptionRow& value(const char* names, const char* value, std::string meaning, Read read, Target&& target) {
    return add(names, value, std::move(meaning),
               [read, set = setter(std::forward<Target>(target))](const std::string& text) -> Result<void> {
                 auto result = read(text);
                 if (!result.ok()) return result.failure();
                 set(std::move(result).value());
                 return {};
               });
  }

  /// One of these words.
  template <class Value, class Target>
  OptionRow& choice(const char* names, const char* value_name, std::string meaning,
                    std::vector<std::pair<std::string, Value>> choices, Target& target) {
    std::vector<std::string> words;
    for (const auto& [word, meant] : choices) words.push_back(word);
    const auto read = [choices, words](const std::string& text) -> Result<Value> {
      for (const auto& [word, meant] : choices) {
        if (word == text) return meant;
      }
      return not_one_of(words, text);
    };
    OptionRow& row = value(names, value_name, std::move(meaning), read, target);
    row.words = words;
    return row;
  }

 private:
  template <class Target>
  static auto setter(Target&& target) {
    if constexpr (std::is_lvalue_reference_v<Target>) {
      return [&target](auto value) { target = std::move(value); };
    } else {
      return std::forward<Target>(target);
    }
  }
  OptionRow& add(const char* names, const char* value, std::string meaning,
                 std::function<Result<void>(const std::string&)> take);

  CommandTable& table_;
  std::string name_;
};

/// A whole number between `least` and `most`, both included.
template <std::integral Number>
auto whole(std::int64_t least, std::int64_t most) {
  return [least, most](const std::string& text) -> Result<Number> {
    const auto number = parse_whole(text, least, most);
    if (!number.ok()) return number.failure();
    return static_cast<Number>(number.value());
  };
}

/// What several commands have.
void add_quiet(CommandTable& table, bool& quiet);
void add_verbosity(CommandTable& table, bool& quiet, bool& verbose);
Result<Verbosity> verbosity_of(bool quiet, bool verbose);
/// `needs`: the option whose pictures these are about, in a group of its own commands; or empty.
void add_display_rows(RowGroup& group, DisplayChoice& display, const std::string& needs);
Result<void> check_display(const DisplayChoice& display);
void add_label_row(RowGroup& group, std::string& label, const std::string& needs);
Result<std::vector<std::filesystem::path>> image_files(const std::vector<std::string>& operands);

CommandTable render_table();
CommandTable check_table();
CommandTable compare_table();
CommandTable view_table();
CommandTable info_table();
CommandTable probe_table();
CommandTable assemble_table();
CommandTable schema_table();
CommandTable manual_table();

/// All commands, in the order of --help; each with its --help.
std::vector<CommandTable> command_tables();

CommandManual manual_of(const CommandTable& table);

}  // namespace backlight
