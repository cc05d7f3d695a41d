#include "backlight/render/image_sequence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace backlight {
namespace {

TEST(Frames, AreNumbersAndRanges) {
  EXPECT_EQ(parse_frames("7").value(), (std::vector<int>{7}));
  EXPECT_EQ(parse_frames("1-4").value(), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(parse_frames("1-6x2").value(), (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(parse_frames("1-7x2").value(), (std::vector<int>{1, 3, 5, 7}));
  EXPECT_EQ(parse_frames("1-5x2,150").value(), (std::vector<int>{1, 3, 5, 150}));
  EXPECT_EQ(parse_frames("3-3").value(), (std::vector<int>{3}));
}

TEST(Frames, KeepTheirOrderAndComeOnce) {
  EXPECT_EQ(parse_frames("9,1-3,2,9").value(), (std::vector<int>{9, 1, 2, 3}));
}

TEST(Frames, MayBeNegative) {
  EXPECT_EQ(parse_frames("-3").value(), (std::vector<int>{-3}));
  EXPECT_EQ(parse_frames("-3--1").value(), (std::vector<int>{-3, -2, -1}));
  EXPECT_EQ(parse_frames("-1-1").value(), (std::vector<int>{-1, 0, 1}));
}

TEST(Frames, EndAtTheLargestNumber) {
  EXPECT_EQ(parse_frames("2147483646-2147483647").value(), (std::vector<int>{2147483646, 2147483647}));
}

TEST(Frames, SayWhatIsWrong) {
  const std::string how = " is not a range of frames: write 7, 1-100 or 1-100x2, with commas between several";
  for (const char* text : {"", "a", "1-", "1-2x", "1:5", "1..5", "1-5x2x3", "1.5", "1 - 5", "99999999999"}) {
    EXPECT_EQ(parse_frames(text).error(), "'" + std::string(text) + "'" + how);
  }
  EXPECT_EQ(parse_frames("1,,2").error(), "''" + how);
  EXPECT_EQ(parse_frames("1,").error(), "''" + how);
  EXPECT_EQ(parse_frames("5-1").error(), "the range '5-1' runs backwards");
  EXPECT_EQ(parse_frames("1-5x0").error(), "the step of '1-5x0' must be at least 1");
  EXPECT_EQ(parse_frames("1-5x-1").error(), "the step of '1-5x-1' must be at least 1");
  EXPECT_EQ(parse_frames("-2147483648-2147483647").error(), "these are more than a million frames");
}

std::string name(const std::string& pattern, int frame) {
  return OutputPattern::parse(pattern).value().path(frame).string();
}

TEST(OutputPattern, PutsInTheNumber) {
  EXPECT_EQ(name("a.%04d.exr", 7), "a.0007.exr");
  EXPECT_EQ(name("a.%d.exr", 7), "a.7.exr");
  EXPECT_EQ(name("a%02d.exr", 123), "a123.exr");
  EXPECT_EQ(name("a.#.exr", 7), "a.0007.exr");
  EXPECT_EQ(name("a.##.exr", 7), "a.07.exr");
  EXPECT_EQ(name("a.######.exr", 7), "a.000007.exr");
  EXPECT_EQ(name("shot##/a.%03d.exr", 5), "shot##/a.005.exr");
  EXPECT_EQ(name("a.%04d.exr", -7), "a.-007.exr");
  EXPECT_EQ(name("100%%.exr", 7), "100%.exr");
}

TEST(OutputPattern, KnowsWhetherItHasANumber) {
  EXPECT_TRUE(OutputPattern::parse("a.#.exr").value().has_number());
  EXPECT_FALSE(OutputPattern::parse("a%%.exr").value().has_number());
}

TEST(OutputPattern, NumbersSeveralImages) {
  const auto numbered = [](const std::string& text) {
    return OutputPattern::parse(text).value().numbered().path(12).string();
  };
  EXPECT_EQ(numbered("a.exr"), "a.0012.exr");
  EXPECT_EQ(numbered("some.where/a.b.exr"), "some.where/a.b.0012.exr");
  EXPECT_EQ(numbered("50%%.exr"), "50%.0012.exr");
  EXPECT_EQ(numbered("a.##.exr"), "a.12.exr");
}

TEST(OutputPattern, TakesLiteralNames) {
  EXPECT_EQ(OutputPattern::literal("50%d#.exr").path(3).string(), "50%d#.exr");
  EXPECT_EQ(OutputPattern::literal("50%d#.exr").numbered().path(3).string(), "50%d#.0003.exr");
  const auto in = [](const std::string& folder) {
    return OutputPattern::parse(folder).value().with_file("a#.exr").path(3).string();
  };
  EXPECT_EQ(in("shots"), "shots/a#.exr");
  EXPECT_EQ(in("shots/"), "shots/a#.exr");
  EXPECT_EQ(in("shot%02d/"), "shot%02d/a#.exr");
  EXPECT_EQ(OutputPattern::parse("out").value().with_file("a.exr").numbered().path(3).string(),
            "out/a.0003.exr");
}

// Hashes and percent signs are numbers in the file's name only.
TEST(OutputPattern, TakesFoldersAsTheyAre) {
  const auto path = [](const std::string& text) {
    return OutputPattern::parse(text).value().path(12).string();
  };
  EXPECT_EQ(path("take#2/"), "take#2/");
  EXPECT_EQ(path("take#2/a.##.exr"), "take#2/a.12.exr");
  EXPECT_EQ(path("50%/%%/%d/#/a%03d.exr"), "50%/%%/%d/#/a012.exr");
  EXPECT_EQ(path("/%s/{}/a.exr"), "/%s/{}/a.exr");
  EXPECT_FALSE(OutputPattern::parse("shot.####/a.exr").value().has_number());
  EXPECT_EQ(OutputPattern::parse("shot.####/a.exr").value().numbered().path(12).string(),
            "shot.####/a.0012.exr");
  EXPECT_FALSE(OutputPattern::parse("50%/a%s.exr").ok());
}

TEST(OutputPattern, RefusesOtherConversions) {
  const std::string how = ": after % comes 04d (or another width), or % for a percent sign";
  for (const char* text : {"a%s.exr", "a%.exr", "a%", "a%4d.exr", "a%-4d.exr", "a%0999d.exr", "a%021d.exr"}) {
    EXPECT_EQ(OutputPattern::parse(text).error(), "'" + std::string(text) + "'" + how);
  }
  EXPECT_EQ(OutputPattern::parse("").error(), "the name of the output file is empty");
}

}  // namespace
}  // namespace backlight
