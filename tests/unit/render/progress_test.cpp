#include "backlight/render/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace backlight {
namespace {

ProgressState halfway() {
  return {"shot.0005.exr", 10, 4, 0.5, 90.0};
}

TEST(ProgressState, CountsImagesAndTheirParts) {
  EXPECT_DOUBLE_EQ(halfway().fraction(), 0.45);
  EXPECT_DOUBLE_EQ(halfway().remaining(), 110.0);
  EXPECT_DOUBLE_EQ((ProgressState{"", 1, 1, 0.0, 1.0}).fraction(), 1.0);
  EXPECT_DOUBLE_EQ((ProgressState{"", 1, 0, 7.0, 1.0}).fraction(), 1.0);
  EXPECT_DOUBLE_EQ((ProgressState{"", 0, 0, 0.0, 1.0}).fraction(), 1.0);
}

TEST(ProgressState, DoesNotGuessTooEarly) {
  EXPECT_LT((ProgressState{"", 1, 0, 0.0001, 5.0}).remaining(), 0.0);
  EXPECT_LT((ProgressState{"", 1, 0, 0.5, 0.01}).remaining(), 0.0);
  EXPECT_EQ((ProgressState{"", 1, 1, 0.0, 0.01}).remaining(), 0.0);
}

TEST(ProgressText, IsAsDocumented) {
  EXPECT_EQ(progress_line(halfway()),
            "Progress: 45% (image 5 of 10, shot.0005.exr, 1:30 elapsed, about 1:50 left)");
  EXPECT_EQ(progress_line({"a.exr", 1, 1, 0.0, 3725.0}), "Progress: 100% (a.exr, 1:02:05 elapsed)");
  EXPECT_EQ(progress_json(halfway()),
            R"({"event":"progress","fraction":0.45,"image":5,"images":10,"file":"shot.0005.exr",)"
            R"("elapsed":90,"remaining":110})");
  EXPECT_EQ(
      progress_json({"a.exr", 1, 0, 0.0, 0.0}),
      R"({"event":"progress","fraction":0,"image":1,"images":1,"file":"a.exr","elapsed":0,"remaining":null})");
}

TEST(ProgressText, FitsTheTerminal) {
  EXPECT_EQ(progress_bar(halfway(), 100, false),
            "  45% [==========>             ] 1:30, 1:50 left  image 5/10  shot.0005.exr");
  for (const int columns : {1, 10, 40, 79}) {
    EXPECT_LT(progress_bar(halfway(), columns, false).size(), static_cast<std::size_t>(columns)) << columns;
  }
  EXPECT_EQ(progress_bar({"a.exr", 1, 1, 0.0, 5.0}, 100, false),
            " 100% [========================] 0:05, 0:00 left  a.exr");
  EXPECT_NE(progress_bar(halfway(), 100, true).find("\x1b[36m"), std::string::npos);
  EXPECT_EQ(progress_bar(halfway(), 100, false).find('\x1b'), std::string::npos);
}

TEST(ProgressReporter, WritesLinesFromItsOwnThread) {
  std::ostringstream out;
  {
    ProgressReporter reporter(out, {ProgressStyle::lines, 2, std::chrono::milliseconds(1)});
    reporter.begin_image("a.exr", 4);
    std::vector<std::jthread> tiles;
    for (int i = 0; i < 4; ++i) tiles.emplace_back([&reporter] { reporter.advance(); });
    tiles.clear();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    reporter.end_image();
    reporter.say("wrote a.exr");
    reporter.begin_image("b.exr", 4);
    reporter.end_image();
  }
  const std::string text = out.str();
  EXPECT_NE(text.find("Progress: 50% (image 1 of 2, a.exr"), std::string::npos) << text;
  EXPECT_NE(text.find("\nwrote a.exr\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Progress: 100% (image 2 of 2, b.exr"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
}

TEST(ProgressReporter, WritesOneJsonObjectALine) {
  std::ostringstream out;
  {
    ProgressReporter reporter(out, {ProgressStyle::json, 1, std::chrono::hours(1)});
    reporter.begin_image("a.exr", 4);
    reporter.end_image();
  }
  EXPECT_EQ(out.str().find(R"({"event":"progress","fraction":1,"image":1,"images":1,"file":"a.exr")"), 0U)
      << out.str();
  EXPECT_EQ(out.str().back(), '\n');
}

TEST(ProgressReporter, TakesTheBarAwayBeforeALine) {
  std::ostringstream out;
  {
    ProgressReporter reporter(out, {ProgressStyle::bar, 1, std::chrono::milliseconds(1)});
    reporter.begin_image("a.exr", 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    reporter.say("hello");
  }
  EXPECT_NE(out.str().find("\r\x1b[Khello\n"), std::string::npos);
  EXPECT_TRUE(out.str().ends_with("hello\n") || out.str().ends_with("\r\x1b[K"));
}

TEST(ProgressReporter, IsSilentWhenAsked) {
  std::ostringstream out;
  {
    ProgressReporter reporter(out, {ProgressStyle::none, 1, std::chrono::milliseconds(1)});
    reporter.begin_image("a.exr", 4);
    reporter.advance(4);
    reporter.end_image();
  }
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressReporter, EndsAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  {
    std::ostringstream out;
    ProgressReporter reporter(out, {ProgressStyle::lines, 1, std::chrono::hours(1)});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

}  // namespace
}  // namespace backlight
