#include "command_table.h"

#include <algorithm>
#include <sstream>

namespace backlight {

const OptionRow* find_row(const CommandTable& table, std::string_view name) {
  const auto found = std::ranges::find_if(table.options, [name](const OptionRow& row) {
    return std::ranges::find(row.names, name) != row.names.end();
  });
  return found != table.options.end() ? &*found : nullptr;
}

OptionRow& RowGroup::add(const char* names, const char* value, std::string meaning,
                         std::function<Result<void>(const std::string&)> take) {
  OptionRow row{{{}, value, {}, std::move(meaning), name_}, std::move(take)};
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) row.names.push_back(name);
  return table_.options.emplace_back(std::move(row));
}

OptionRow& RowGroup::flag(const char* names, bool& target, std::string meaning) {
  return add(names, "", std::move(meaning), [&target](const std::string& /*none*/) -> Result<void> {
    target = true;
    return {};
  });
}

void add_quiet(CommandTable& table, bool& quiet) {
  RowGroup(table, "Other").flag("-q,--quiet", quiet, "say nothing but errors");
}

void add_verbosity(CommandTable& table, bool& quiet, bool& verbose) {
  add_quiet(table, quiet);
  RowGroup(table, "Other").flag("-v,--verbose", verbose, "say more about each step");
}

Result<Verbosity> verbosity_of(bool quiet, bool verbose) {
  if (quiet && verbose) return Failure{"--quiet: not together with --verbose"};
  return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal;
}

Result<std::vector<std::filesystem::path>> image_files(const std::vector<std::string>& operands) {
  if (operands.empty()) return Failure{"no image file is given"};
  return std::vector<std::filesystem::path>{operands.begin(), operands.end()};
}

std::vector<CommandTable> command_tables() {
  std::vector<CommandTable> tables{render_table(),   check_table(),  compare_table(),
                                   view_table(),     info_table(),   probe_table(),
                                   assemble_table(), schema_table(), manual_table()};
  for (CommandTable& table : tables)
    table.options.push_back({{{"-h", "--help"}, "", {}, "print this help", "Other"}, nullptr});
  return tables;
}

// Group by group, in the order in which they first appear.
CommandManual manual_of(const CommandTable& table) {
  CommandManual manual{table};
  std::vector<std::string> groups;
  for (const OptionRow& row : table.options) {
    if (std::ranges::find(groups, row.group) == groups.end()) groups.push_back(row.group);
  }
  for (const std::string& group : groups) {
    for (const OptionRow& row : table.options) {
      if (row.group == group) manual.options.push_back(row);
    }
  }
  return manual;
}

}  // namespace backlight
