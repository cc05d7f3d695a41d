#include "backlight/base/diagnostics.h"

#include <gtest/gtest.h>

namespace backlight {
namespace {

std::string shown(const std::string& line, int column, int length) {
  const auto source = std::make_shared<const SourceText>(SourceText{"a.toml", "first\n" + line + "\nlast\n"});
  return format({Severity::error, {source, 2, column, length}, "no", "hint"});
}

TEST(Diagnostic, ShowsTheLineAndMarksThePlace) {
  EXPECT_EQ(shown("\tsize = 3", 9, 1), "a.toml:2:9: error: no\n  \tsize = 3\n  \t       ^\n  hint");
  EXPECT_EQ(shown("é = abc", 5, 3), "a.toml:2:5: error: no\n  é = abc\n      ^~~\n  hint");
}

TEST(Diagnostic, ShowsAPieceOfALongLine) {
  const std::string line = std::string(1000, 'a') + "XYZ" + std::string(1000, 'b');
  EXPECT_EQ(shown(line, 1001, 3), "a.toml:2:1001: error: no\n  ..." + std::string(60, 'a') + "XYZ" +
                                      std::string(137, 'b') + "...\n  " + std::string(63, ' ') +
                                      "^~~\n  hint");
  EXPECT_EQ(shown(line, 1, 2000), "a.toml:2:1: error: no\n  " + std::string(200, 'a') + "...\n  ^" +
                                      std::string(199, '~') + "\n  hint");
  EXPECT_EQ(shown(line, 2003, 1), "a.toml:2:2003: error: no\n  ..." + std::string(61, 'b') + "\n  " +
                                      std::string(63, ' ') + "^\n  hint");
}

TEST(NearestName, IsNoneWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("shpere", {"box", "sphere", "cone"}), "sphere");
  EXPECT_EQ(nearest_name("zebra", {"box", "sphere", "cone"}), "");
}

}  // namespace
}  // namespace backlight
