#include "backlight/film/assemble.h"

#include <gtest/gtest.h>

#include "folder.h"

namespace backlight {
namespace {

using Assembling = InFolder;

constexpr PixelBox window{0, 0, 40, 70};

/// One channel of the value `of(x, y)` over `box`.
template <typename Of>
ImagePart part(const std::filesystem::path& file, const PixelBox& box, Of of) {
  Image image(ImageLayout{window, box, {{"R", ChannelPrecision::half}}, {}});
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) image.at(0, x, y) = of(x, y);
  }
  ExrHeader header;
  header.attributes.push_back({"backlight/complete", std::int32_t{1}});
  const auto written = write_exr(file, image, header);
  EXPECT_TRUE(written.ok()) << written.error();
  return {file, read_exr_info(file).value()};
}

float ramp(int x, int y) {
  return static_cast<float>((31 * x + 17 * y) % 1024);
}

TEST_F(Assembling, ReadsEachPixelFromItsPart) {
  std::vector<ImagePart> parts;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 10; ++j) {
      parts.push_back(
          part(folder / (std::to_string(10 * i + j) + ".exr"), {8 * i, 7 * j, 8 * i + 8, 7 * j + 7}, ramp));
    }
  }
  EXPECT_EQ(misfit_of(parts), "");
  const Assembly assembly = assemble_exr(folder / "out.exr", parts, false);
  ASSERT_EQ(assembly.end, Assembly::End::written) << assembly.message;
  const auto picture = read_exr(folder / "out.exr");
  ASSERT_TRUE(picture.ok()) << picture.error();
  ASSERT_EQ(picture.value().image.layout().data, window);
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) ASSERT_EQ(picture.value().image.at(0, x, y), ramp(x, y));
  }
}

TEST_F(Assembling, NamesThePixelInWhichPartsDiffer) {
  const auto other = [](int x, int y) { return ramp(x, y) + (x == 20 && y == 66 ? 1.0F : 0.0F); };
  const std::vector<ImagePart> parts{part(folder / "one.exr", {0, 0, 21, 70}, ramp),
                                     part(folder / "two.exr", {20, 0, 40, 70}, other)};
  const Assembly assembly = assemble_exr(folder / "out.exr", parts, false);
  EXPECT_EQ(assembly.end, Assembly::End::misfit);
  EXPECT_EQ(assembly.message,
            (folder / "two.exr").string() + " and " + (folder / "one.exr").string() +
                " differ in a pixel that both have: R at 20,66 is 719.000000 and 718.000000");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(Assembling, RefusesPartsThatAreNotComplete) {
  std::vector<ImagePart> parts{part(folder / "one.exr", window, ramp)};
  parts[0].info.header.attributes[0].value = std::int32_t{0};
  EXPECT_NE(misfit_of(parts).find("one.exr is not complete"), std::string::npos);
  parts[0].info.header.attributes.clear();
  EXPECT_NE(misfit_of(parts).find("was not made by 'backlight render'"), std::string::npos);
}

std::string gaps_of(std::vector<PixelBox> boxes, const std::filesystem::path& file) {
  std::vector<ImagePart> parts;
  for (const PixelBox& box : boxes) parts.push_back(part(file, box, ramp));
  const std::string text = misfit_of(parts);
  return text.empty() ? "" : text.substr(text.find('\n'));
}

TEST_F(Assembling, FindsTheGaps) {
  const auto file = folder / "part.exr";
  EXPECT_EQ(gaps_of({window}, file), "");
  EXPECT_EQ(gaps_of({{0, 0, 40, 30}, {0, 30, 40, 70}}, file), "");
  EXPECT_EQ(gaps_of({{0, 0, 40, 30}, {0, 31, 40, 70}}, file), "\n  --crop 0,30,40,31");
  // A hole in the middle of a ring, whose left and right sides are cut at other heights than it.
  EXPECT_EQ(
      gaps_of({{0, 0, 40, 10}, {0, 10, 5, 50}, {35, 10, 40, 60}, {0, 50, 35, 70}, {35, 60, 40, 70}}, file),
      "\n  --crop 5,10,35,50");
  EXPECT_EQ(gaps_of({{10, 10, 20, 20}}, file),
            "\n  --crop 0,0,40,10\n  --crop 0,10,10,20\n  --crop 20,10,40,20\n  --crop 0,20,40,70");
}

}  // namespace
}  // namespace backlight
