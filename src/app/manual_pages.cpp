#include <algorithm>
#include <cctype>
#include <ctime>
#include <sstream>
#include <utility>

#include "help_text.h"
#include "manual.h"

namespace backlight {
namespace {

// Text as roff has it: what has a meaning of its own there, escaped; options with a minus that can be copied.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\e";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      default:
        escaped += c;
    }
  }
  return (escaped.starts_with('.') ? "\\&" : "") + escaped;
}

// A paragraph in lines that are not long, which roff fills again.
std::string filled(const std::string& text) {
  constexpr std::size_t width = 78;
  std::istringstream words(text);
  std::string lines;
  std::string line;
  for (std::string word; words >> word;) {
    word = roff(word);
    if (!line.empty() && line.size() + 1 + word.size() > width) lines += std::exchange(line, "") + "\n";
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line + "\n";
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string heading(const std::string& name, std::optional<std::int64_t> date) {
  std::string day;
  if (date) {
    const std::time_t time = *date;
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[32];
    if (std::strftime(text, sizeof text, "%Y-%m-%d", &parts) > 0) day = text;
  }
  std::string title = name;
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return ".TH " + title + " 1 \"" + day + "\" \"Backlight " BACKLIGHT_VERSION "\" \"Backlight\"\n";
}

// Lines as paragraphs.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += (result.empty() ? "" : ".PP\n") + filled(line);
  return result;
}

// Names bold, and what stands for something else italic.
std::string usage_lines(const std::string& usage) {
  std::istringstream lines(usage);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string row;
    for (std::string word; words >> word;) {
      const bool is_name = word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos &&
                           word != "[options]" && word != ">";
      row += (row.empty() ? "" : " ") + (is_name ? bold(word) : italic(word));
    }
    if (!row.empty()) result += (result.empty() ? "" : ".br\n") + row + "\n";
  }
  return result;
}

// The sentence that `apropos` shows: without the full stop, and not in capitals.
std::string short_meaning(const std::string& meaning) {
  std::string first = meaning.substr(0, meaning.find_first_of(".:;"));
  if (!first.empty() && first[0] >= 'A' && first[0] <= 'Z')
    first[0] = static_cast<char>(first[0] + ('a' - 'A'));
  return first;
}

std::string option_rows(const CommandManual& command) {
  std::string rows;
  std::string group;
  for (const OptionManual& option : command.options) {
    if (option.group != group) {
      group = option.group;
      rows += ".SS " + roff(group) + "\n";
    }
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
    rows += ".TP\n" + names + (option.value.empty() ? "" : " " + italic(option.value)) + "\n" +
            filled(option.meaning);
  }
  return rows;
}

std::string exit_status() {
  return ".SH EXIT STATUS\n" + filled(exit_status_text());
}

}  // namespace

std::string manual_page(const CommandManual& command, std::optional<std::int64_t> date) {
  const std::string name = roff("backlight-" + command.name);
  return heading(name, date) + ".SH NAME\n" + name + " \\-\n" + filled(short_meaning(command.meaning)) +
         ".SH SYNOPSIS\n" + usage_lines("backlight " + command.usage) + ".SH DESCRIPTION\n" +
         paragraphs(command.meaning) + ".SH OPTIONS\n" + option_rows(command) + exit_status() +
         ".SH SEE ALSO\n.BR backlight (1)\n";
}

std::string manual_page(const std::vector<CommandManual>& commands, std::optional<std::int64_t> date) {
  std::string page = heading("backlight", date);
  page +=
      ".SH NAME\nbacklight \\- render scenes as special relativity shows them\n"
      ".SH SYNOPSIS\n" +
      usage_lines("backlight [render] SCENE.toml [options]\nbacklight COMMAND ...") + ".SH DESCRIPTION\n" +
      paragraphs(program_text()) + ".SH COMMANDS\n";
  std::string others;
  for (const CommandManual& command : commands) {
    page += ".TP\n" + bold(command.name) + (command.operands.empty() ? "" : " " + italic(command.operands)) +
            "\n" + filled(command.meaning.substr(0, command.meaning.find('\n')));
    others += (others.empty() ? ".BR backlight\\-" : " (1),\n.BR backlight\\-") + command.name;
  }
  page += ".PP\n" +
          filled(
              "'backlight COMMAND --help' lists the options of a command, and so does its page. 'backlight "
              "--version' prints the version.") +
          exit_status() + ".SH ENVIRONMENT\n";
  for (const auto& [name, meaning] : environment_variables())
    page += ".TP\n" + bold(name) + "\n" + filled(meaning);
  return page + ".SH SEE ALSO\n" + others + " (1)\n";
}

}  // namespace backlight
