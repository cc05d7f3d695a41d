#include "table.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace backlight::test {
namespace {

const std::string page = std::string(BACKLIGHT_SOURCE_DIR) + "/docs/stability.md";

std::string rounded_up(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", value);
  if (std::strtod(text, nullptr) < value) std::snprintf(text, sizeof text, "%.0e", value * 1.5);
  return text;
}

std::string text_of(const std::string& columns, const Table& table) {
  std::string text = "| " + columns +
                     " | rays | hits | missed | false | unresolved | within rounding | worst error |\n| ---";
  for (const char c : columns) text += c == '|' ? " | ---" : "";
  text += " | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const auto& [name, c] : table) {
    text += "| " + name + " | " + std::to_string(c.rays) + " | " + std::to_string(c.hits) + " | " +
            std::to_string(c.missed) + " | " + std::to_string(c.invented) + " | " +
            std::to_string(c.unresolved) + " | " + std::to_string(c.within_rounding) + " | " +
            rounded_up(c.worst) + " |\n";
  }
  return text;
}

// The last column depends on the last bits of the C library's functions, which differ between processors: it
// may be half of what is written, or twice. All the others are exact.
void expect_same_row(const std::string& written, const std::string& now) {
  const std::size_t last = written.rfind("| ", written.size() - 3);
  const std::size_t last_now = now.rfind("| ", now.size() - 3);
  EXPECT_EQ(written.substr(0, last), now.substr(0, last_now));
  const double stated = std::strtod(written.c_str() + last + 2, nullptr);
  const double error = std::strtod(now.c_str() + last_now + 2, nullptr);
  EXPECT_LE(error, 2.0 * stated) << now;
  EXPECT_GE(error, 0.5 * stated) << now;
}

}  // namespace

void expect_on_page(const std::string& name, const std::string& columns, const Table& table) {
  std::ifstream file(page);
  std::stringstream content;
  content << file.rdbuf();
  const std::string text = content.str();
  const std::string begin = "<!-- " + name + " -->\n";
  const std::size_t from = text.find(begin);
  ASSERT_NE(from, std::string::npos);
  const std::size_t start = from + begin.size();
  const std::size_t to = text.find("<!-- end of table -->\n", start);
  ASSERT_NE(to, std::string::npos);
  const std::string measured = text_of(columns, table);
  if (std::getenv("BACKLIGHT_UPDATE_STABILITY") != nullptr) {
    std::ofstream(page) << text.substr(0, start) + measured + text.substr(to);
    return;
  }
  std::istringstream written(text.substr(start, to - start));
  std::istringstream now(measured);
  std::string line;
  for (std::string row; std::getline(written, row);) {
    ASSERT_TRUE(std::getline(now, line)) << "the page has a row too many: " << row;
    expect_same_row(row, line);
  }
  EXPECT_FALSE(std::getline(now, line)) << "the page lacks a row: " << line;
}

}  // namespace backlight::test
