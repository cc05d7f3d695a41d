#include "mutations.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace backlight::fuzz {
namespace {

constexpr std::array<std::string_view, 44> numbers{"0",
                                                   "-0.0",
                                                   "1",
                                                   "-1",
                                                   "nan",
                                                   "-nan",
                                                   "inf",
                                                   "-inf",
                                                   "1e308",
                                                   "-1e308",
                                                   "1.7e308",
                                                   "1e-308",
                                                   "5e-324",
                                                   "1e-320",
                                                   "1e200",
                                                   "-1e200",
                                                   "1e154",
                                                   "1e155",
                                                   "1e100",
                                                   "1e50",
                                                   "-1e50",
                                                   "1e-50",
                                                   "1e30",
                                                   "1e16",
                                                   "9007199254740993",
                                                   "65536",
                                                   "65537",
                                                   "1048576",
                                                   "2147483647",
                                                   "2147483648",
                                                   "-2147483649",
                                                   "4294967296",
                                                   "9223372036854775807",
                                                   "99999999999999999999",
                                                   "0.1",
                                                   "0.5",
                                                   "0.999999999999",
                                                   "1.0000000001",
                                                   "1e-9",
                                                   "3",
                                                   "90",
                                                   "180",
                                                   "360",
                                                   "1e6"};
constexpr std::array<std::string_view, 24> formulas{"\"t\"",
                                                    "\"frame\"",
                                                    "\"1/0\"",
                                                    "\"0/0\"",
                                                    "\"-1/0\"",
                                                    "\"log(t)\"",
                                                    "\"sqrt(-1)\"",
                                                    "\"x\"",
                                                    "\"y-x/abs(x)\"",
                                                    "\"x^x-0.8+0.3*y\"",
                                                    "\"mod(y, 0.5)\"",
                                                    "\"y-tan(2*x)\"",
                                                    "\"1e308*x*x*y\"",
                                                    "\"floor(x*y*z)\"",
                                                    "\"exp(1000*x)-exp(1000*y)\"",
                                                    "\"max(x,x)-0.1\"",
                                                    "\"min(x, 0/0)\"",
                                                    "\"atan2(x, y)\"",
                                                    "\"x*x+y*y+z*z-1\"",
                                                    "\"0*x\"",
                                                    "\"acos(2*x)\"",
                                                    "\"(x*x+y*y+z*z-1)^-3\"",
                                                    "\"\"",
                                                    "\"((\""};
constexpr std::array<std::string_view, 16> pieces{"sin(",  "/0",     "*x", "^y",  "-",        "log(",
                                                  ")",     "1e308*", "(",  "t",   "mod(x,y)", "cbrt(",
                                                  "^-1e9", "+0/0",   ",",  "abs("};
constexpr std::array<std::string_view, 16> values{"true",
                                                  "\"\"",
                                                  "[]",
                                                  "{}",
                                                  "[[]]",
                                                  "[0, 0, 0]",
                                                  "[1e308, 1e308, 1e308]",
                                                  "[nan, 0, 0]",
                                                  "1979-05-27",
                                                  "\"world\"",
                                                  "\"sphere\"",
                                                  "\"/dev/null\"",
                                                  "\"..\"",
                                                  "[1]",
                                                  "[[1, 2, 3], [4, 5, 6]]",
                                                  "{ a = 1 }"};

bool in_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == 'e' || c == '-' || c == '+';
}

/// Where the numbers of a text are: [begin, end).
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const auto is_digit = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(text[i])) != 0; };
  const auto is_word = [&](std::size_t i) {
    return std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_' || text[i] == '.';
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!is_digit(i) || (i > 0 && is_word(i - 1))) continue;
    std::size_t end = i;
    while (end < text.size() && in_number(text[end])) ++end;
    found.emplace_back(i > 0 && text[i - 1] == '-' ? i - 1 : i, end);
    i = end;
  }
  return found;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1);
    lines.push_back(text.substr(begin, end + 1 - begin));
    begin = end + 1;
  }
  if (lines.empty()) lines.emplace_back("\n");
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

void change_number(std::string& text, Random& random) {
  const auto found = numbers_in(text);
  if (found.empty()) return;
  const auto [begin, end] = random.of(found);
  const std::string_view with = random.one_in(4) ? random.of(formulas) : random.of(numbers);
  text.replace(begin, end - begin, with);
}

void change_bytes(std::string& text, Random& random) {
  if (text.empty()) return;
  const std::size_t place = random.below(text.size());
  const char byte = static_cast<char>(random.next());
  switch (random.below(4)) {
    case 0:
      text[place] = byte;
      break;
    case 1:
      text.insert(place, 1, byte);
      break;
    case 2:
      text.erase(place, 1 + random.below(8));
      break;
    default:
      text[place] = static_cast<char>(text[place] ^ (1 << random.below(8)));
      break;
  }
}

void change_lines(std::string& text, const std::string& other, Random& random) {
  std::vector<std::string> lines = lines_of(text);
  const std::size_t place = random.below(lines.size());
  const auto at = lines.begin() + static_cast<std::ptrdiff_t>(place);
  const std::vector<std::string> others = lines_of(other);
  switch (random.below(6)) {
    case 0:
      lines.erase(at);
      break;
    case 1:
      lines.insert(at, std::string(*at));
      break;
    case 2:
      std::swap(*at, lines[random.below(lines.size())]);
      break;
    case 3:
      lines.insert(at, random.of(others));
      break;
    case 4:
      lines.resize(place + 1);
      break;
    default: {
      const std::string moved = *at;
      lines.erase(at);
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(random.below(lines.size() + 1)), moved);
    }
  }
  text = joined(lines);
}

/// The value of a line `key = value` becomes another one, or goes into brackets.
void change_value(std::string& text, Random& random) {
  std::vector<std::string> lines = lines_of(text);
  std::string& line = lines[random.below(lines.size())];
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return;
  std::string value = line.substr(equals + 1);
  if (!value.empty() && value.back() == '\n') value.pop_back();
  const std::string& from = lines[random.below(lines.size())];
  const std::size_t its = from.find('=');
  switch (random.below(4)) {
    case 0:
      value = random.of(values);
      break;
    case 1:
      if (its != std::string::npos) value = from.substr(its + 1, from.size() - its - 2);
      break;
    case 2:
      value = random.of(formulas);
      break;
    default: {
      const std::size_t depth = random.one_in(8) ? 300 : 1 + random.below(3);
      value = std::string(depth, '[') + value + std::string(depth, ']');
    }
  }
  line = line.substr(0, equals + 1) + " " + value + "\n";
  text = joined(lines);
}

/// Within a string, a piece of a formula.
void change_string(std::string& text, Random& random) {
  std::vector<std::size_t> quotes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quotes.push_back(i);
  }
  if (quotes.size() < 2) return;
  const std::size_t first = random.below(quotes.size() - 1);
  const std::size_t length = quotes[first + 1] - quotes[first];
  text.insert(quotes[first] + 1 + random.below(length), random.of(pieces));
}

void change_size(std::string& bytes, Random& random) {
  constexpr std::array<std::uint32_t, 12> sizes{0,           1,           0xffffffffU, 0x7fffffffU,
                                                0x80000000U, 0xffffU,     0x10000U,    0x01000000U,
                                                0x00100000U, 0x000fffffU, 0x40000000U, 7};
  if (bytes.size() < 4) return;
  const std::size_t header = std::min<std::size_t>(bytes.size() - 3, 600);
  const std::size_t place = random.below(random.one_in(3) ? bytes.size() - 3 : header);
  const std::uint32_t size = random.of(sizes);
  const bool big_end_first = random.one_in(2);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[place + i] = static_cast<char>(size >> (8 * (big_end_first ? 3 - i : i)));
}

}  // namespace

std::uint64_t Random::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

std::string mutated_scene(std::string text, const std::string& other, Random& random) {
  for (std::size_t i = 1 + random.below(4); i > 0; --i) {
    switch (random.below(8)) {
      case 0:
      case 1:
      case 2:
        change_number(text, random);
        break;
      case 3:
        change_lines(text, other, random);
        break;
      case 4:
      case 5:
        change_value(text, random);
        break;
      case 6:
        change_string(text, random);
        break;
      default:
        change_bytes(text, random);
    }
  }
  return text;
}

std::string mutated_table(std::string text, const std::string& other, Random& random) {
  constexpr std::array separators{';', '\t', ' ', '|'};
  for (std::size_t i = 1 + random.below(4); i > 0; --i) {
    switch (random.below(8)) {
      case 0:
        std::replace(text.begin(), text.end(), ',', random.of(separators));
        break;
      case 1:
        text.insert(0, random.one_in(2) ? "\xEF\xBB\xBF" : "\xFF\xFE");
        break;
      case 2:
        std::replace(text.begin(), text.end(), '\n', '\r');
        break;
      case 3:
      case 4:
        change_lines(text, other, random);
        break;
      case 5:
        change_bytes(text, random);
        break;
      default:
        change_number(text, random);
    }
  }
  return text;
}

std::string mutated_picture(std::string bytes, const std::string& other, Random& random) {
  for (std::size_t i = 1 + random.below(4); i > 0; --i) {
    if (bytes.empty()) return bytes;
    const std::size_t place =
        random.below(random.one_in(3) ? bytes.size() : std::min<std::size_t>(bytes.size(), 600));
    switch (random.below(8)) {
      case 0:
      case 1:
        change_size(bytes, random);
        break;
      case 2:
        bytes.resize(random.below(bytes.size()));
        break;
      case 3: {
        const std::size_t from = random.below(bytes.size());
        bytes.insert(place, bytes.substr(from, 1 + random.below(64)));
        break;
      }
      case 4:
        if (!other.empty()) bytes.replace(place, 16, other.substr(random.below(other.size()), 16));
        break;
      case 5:
        bytes.erase(place, 1 + random.below(64));
        break;
      default:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.below(8)));
    }
  }
  return bytes;
}

}  // namespace backlight::fuzz
