#include "backlight/base/json_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace backlight {
namespace {

TEST(JsonText, QuotesStrings) {
  EXPECT_EQ(json_quoted(""), "\"\"");
  EXPECT_EQ(json_quoted("a b"), "\"a b\"");
  EXPECT_EQ(json_quoted("say \"c\\d\"\n\t\r"), R"("say \"c\\d\"\n\t\r")");
  EXPECT_EQ(json_quoted(std::string("\0\x1f\x7f", 3)), "\"\\u0000\\u001f\x7f\"");
  EXPECT_EQ(json_quoted("γ = 2, 😀"), "\"γ = 2, 😀\"");
}

TEST(JsonText, ReplacesWhatIsNotUtf8) {
  const std::string replacement = "\xEF\xBF\xBD";
  EXPECT_EQ(json_quoted("a\xff"), "\"a" + replacement + "\"");
  EXPECT_EQ(json_quoted("\xc3"), "\"" + replacement + "\"");                    // cut short
  EXPECT_EQ(json_quoted("\xc0\xaf"), "\"" + replacement + replacement + "\"");  // overlong
  EXPECT_EQ(json_quoted("\xed\xa0\x80z"),
            "\"" + replacement + replacement + replacement + "z\"");              // a surrogate
  EXPECT_EQ(json_quoted("\xf4\x90\x80\x80").size(), 2 + 4 * replacement.size());  // past the last code point
}

TEST(JsonText, WritesNumbersThatReadBack) {
  EXPECT_EQ(json_number(0.1), "0.1");
  EXPECT_EQ(json_number(-3.0), "-3");
  EXPECT_EQ(json_number(1e300), "1e+300");
  EXPECT_EQ(std::stod(json_number(1.0 / 3.0)), 1.0 / 3.0);
  EXPECT_EQ(json_number(std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(json_number(std::numeric_limits<double>::quiet_NaN()), "null");
}

}  // namespace
}  // namespace backlight
