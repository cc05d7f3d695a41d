// The table of keys, and what is made from it.
#include "backlight/scene/keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>

#include "backlight/base/files.h"
#include "backlight/scene/schema.h"

namespace backlight {
namespace {

TEST(Keys, AreNamedOnceInEachTable) {
  std::set<std::string_view> tables;
  for (const KeyTable& table : key_tables()) {
    EXPECT_TRUE(tables.insert(table.name).second) << table.name;
    EXPECT_FALSE(table.meaning.empty()) << table.name;
    std::set<std::string_view> keys;
    for (const Key& key : table.keys) {
      EXPECT_TRUE(keys.insert(key.name).second) << table.name << "." << key.name;
      EXPECT_TRUE(key.meaning.ends_with('.')) << table.name << "." << key.name;
      EXPECT_FALSE(key.forms.empty()) << table.name << "." << key.name;
    }
  }
}

TEST(Keys, ReferToTablesThatExist) {
  for (const KeyTable& table : key_tables()) {
    for (const Key& key : table.keys) {
      for (const ValueForm& form : key.forms) {
        const bool needs_table = form.kind >= ValueKind::reference;
        EXPECT_EQ(needs_table, !form.table.empty()) << table.name << "." << key.name;
        if (needs_table) {
          EXPECT_NE(find_table(form.table), nullptr) << table.name << "." << key.name;
        }
      }
    }
  }
}

TEST(Keys, EveryChoiceOfASelectorHasItsTable) {
  for (const KeyTable& table : key_tables()) {
    if (table.selector.empty()) continue;
    const Key* selector = find_key(table, table.selector);
    ASSERT_NE(selector, nullptr);
    for (const std::string_view choice : selector->choices) {
      const KeyTable* variant = find_variant(table, choice);
      ASSERT_NE(variant, nullptr) << choice;
      for (const Key& key : variant->keys)
        EXPECT_EQ(find_key(table, key.name), nullptr) << choice << "." << key.name;
    }
  }
}

TEST(Keys, DefaultsAreAllowedValues) {
  for (const KeyTable& table : key_tables()) {
    for (const Key& key : table.keys) {
      if (const auto* number = std::get_if<double>(&key.value)) {
        EXPECT_TRUE(key.range.contains(*number)) << key.name;
      }
      if (const auto* numbers = std::get_if<std::vector<double>>(&key.value)) {
        EXPECT_EQ(numbers->size(), static_cast<std::size_t>(key.forms.front().count)) << key.name;
        for (const double number : *numbers) EXPECT_TRUE(key.range.contains(number)) << key.name;
      }
      if (key.forms.front().kind == ValueKind::choice && std::holds_alternative<std::string>(key.value)) {
        const auto& usual = std::get<std::string>(key.value);
        EXPECT_NE(std::find(key.choices.begin(), key.choices.end(), usual), key.choices.end()) << key.name;
      }
    }
  }
}

TEST(Keys, RangesInWords) {
  EXPECT_EQ(Range{}.words(), "");
  EXPECT_EQ((Range{.least = 0, .above_least = true}).words(), "greater than 0");
  EXPECT_EQ((Range{.least = 0, .greatest = 1}).words(), "at least 0 and at most 1");
  EXPECT_EQ((Range{.least = 1, .whole = true}).words(), "a whole number, at least 1");
  EXPECT_EQ((Range{.greatest = 3, .below_greatest = true}).words(), "less than 3");
}

TEST(Keys, RangesContain) {
  const Range range{.least = 0, .greatest = 10, .above_least = true, .whole = true};
  EXPECT_FALSE(range.contains(0));
  EXPECT_TRUE(range.contains(1));
  EXPECT_FALSE(range.contains(1.5));
  EXPECT_TRUE(range.contains(10));
  EXPECT_FALSE(range.contains(11));
  EXPECT_FALSE(Range{}.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(Range{}.contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(Keys, NumbersInTheFewestDigits) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(720), "720");
  EXPECT_EQ(number_text(1e30), "1e30");
  EXPECT_EQ(number_text(1.5e-7), "1.5e-7");
  EXPECT_EQ(number_text(-1e100), "-1e100");
}

// The committed page is what `backlight schema --markdown` prints.
TEST(Reference, PageIsUpToDate) {
  const auto page = read_file(std::string(BACKLIGHT_SOURCE_DIR) + "/docs/scene-reference.md");
  ASSERT_TRUE(page.ok()) << page.error();
  EXPECT_EQ(page.value(), reference_markdown())
      << "write it anew: backlight schema --markdown > docs/scene-reference.md";
}

// A row whose cells are more or fewer than its table's head is cut, or shifted, wherever the page is read.
TEST(Reference, RowsHaveAsManyCellsAsTheirHeads) {
  std::istringstream page(reference_markdown());
  std::ptrdiff_t bars = 0;  // of the table's head; 0 outside of tables
  int rows = 0;
  for (std::string line; std::getline(page, line); rows += bars > 0 ? 1 : 0) {
    std::ptrdiff_t of_line = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      of_line += line[i] == '|' && (i == 0 || line[i - 1] != '\\') ? 1 : 0;
    }
    if (!line.starts_with('|')) {
      bars = 0;
      continue;
    }
    if (bars == 0) bars = of_line;
    EXPECT_EQ(of_line, bars) << line;
  }
  EXPECT_GT(rows, 100);
}

TEST(Reference, TellsTheKeysOfMotionOnce) {
  const std::string page = reference_markdown();
  for (const std::string key : {"beta", "celerity", "rapidity"}) {
    const std::string row = "\n| `" + key + "` |";
    const std::size_t first = page.find(row);
    ASSERT_NE(first, std::string::npos) << key;
    EXPECT_EQ(page.find(row, first + 1), std::string::npos) << key;
  }
  EXPECT_NE(page.find("[how things move](#how-things-move)"), std::string::npos);
}

}  // namespace
}  // namespace backlight
