#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "read_model.h"

namespace backlight::models {
namespace {

constexpr std::string_view space = " \t\r";

std::string_view next_word(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(space));
  line.remove_prefix(word.size());
  return word;
}

bool is_finite_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
  return end.ec == std::errc() && end.ptr == word.data() + word.size() && std::isfinite(value);
}

/// What is wrong with a line, or null.
const char* fault_of(std::string_view line) {
  const std::string_view what = next_word(line);
  const std::size_t wanted = what == "v" || what == "vn" ? 3 : what == "vt" ? 1 : 0;
  if (wanted == 0) return nullptr;
  std::size_t numbers = 0;
  for (std::string_view word = next_word(line); !word.empty() && !word.starts_with('#');
       word = next_word(line), ++numbers) {
    if (!is_finite_number(word)) return "expected finite numbers";
  }
  return numbers < wanted ? "expected more numbers" : nullptr;
}

}  // namespace

void check_obj_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("the file cannot be opened");
  constexpr std::size_t longest_line = 1 << 24;
  std::vector<char> piece(1 << 20);
  std::string rest;  // of a line that the last piece ended in
  std::size_t number = 0;
  const auto check = [&](std::string_view line) {
    ++number;
    if (line.size() > longest_line)
      throw std::runtime_error("it has a line of more than 16 MB: it is no OBJ file");
    if (line.find('\0') != std::string_view::npos)
      throw std::runtime_error("line " + std::to_string(number) + " is no text");
    if (const char* fault = fault_of(line))
      throw std::runtime_error("line " + std::to_string(number) + ": " + fault);
  };
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    std::string_view text(piece.data(), static_cast<std::size_t>(file.gcount()));
    for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
      if (rest.empty()) {
        check(text.substr(0, end));
      } else {
        check(rest.append(text.substr(0, end)));
        rest.clear();
      }
    }
    rest.append(text);
    if (rest.size() > longest_line) check(rest);
  }
  if (!rest.empty()) check(rest);
}

}  // namespace backlight::models
