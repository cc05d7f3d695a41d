// backlight view: what it chooses by itself, folders, and why pixels are black.
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "backlight/film/exr.h"
#include "backlight/film/png.h"
#include "program.h"

namespace backlight::test {
namespace {

class View : public ProgramTest {
 protected:
  // Greys of these film values, a row of one pixel each; with `light` their data channels.
  void picture(const std::string& name, const std::vector<float>& values,
               const std::vector<std::pair<float, float>>& light = {}) const {
    ImageLayout layout;
    layout.display = layout.data = {0, 0, static_cast<int>(values.size()), 1};
    std::vector<std::vector<float>> planes;
    for (const char* channel : {"R", "G", "B"}) {
      layout.channels.push_back({channel, ChannelPrecision::single});
      planes.push_back(values);
    }
    if (!light.empty()) {
      layout.channels.push_back({"light.N", ChannelPrecision::single});
      layout.channels.push_back({"light.Y", ChannelPrecision::single});
      planes.resize(5);
      for (const auto& [lamps, unshifted] : light) {
        planes[3].push_back(lamps);
        planes[4].push_back(unshifted);
      }
    }
    const auto written = write_exr(folder / "work" / name, Image(layout, planes), {});
    if (!written.ok()) ADD_FAILURE() << written.error();
  }

  [[nodiscard]] PixelBytes shown(const std::string& name) const {
    auto pixels = read_rgb_bytes(folder / "work" / name);
    if (!pixels.ok()) throw std::runtime_error(pixels.error());
    return std::move(pixels).value();
  }

  void expect_success(const std::vector<std::string>& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
};

TEST_F(View, ShowsTheFilmAsItIsWhereNothingIsBeyondWhite) {
  picture("a.exr", {0.0F, 0.18F, 1.0F});
  expect_success({"view", "a.exr"});
  const PixelBytes a = shown("a.png");
  EXPECT_EQ(a.samples[3], 118);  // the sRGB signal of 0.18
  EXPECT_EQ(a.samples[6], 255);
}

TEST_F(View, KeepsManyDecadesApart) {
  std::vector<float> decades;
  for (float value = 1e-4F; value < 2e4F; value *= 10.0F) decades.push_back(value);
  picture("a.exr", decades);
  const Outcome outcome = run({"view", "a.exr"});
  EXPECT_NE(outcome.err.find("shown with --tone drago --exposure "), std::string::npos) << outcome.err;
  const PixelBytes a = shown("a.png");
  EXPECT_EQ(a.samples[3 * 8], 255);
  // From a tenth of white on.
  for (std::size_t i = 3; i < decades.size(); ++i) {
    EXPECT_GT(a.samples[3 * i], a.samples[3 * i - 3] + 3) << decades[i];
  }
  // What it says it did can be asked for.
  const std::string flags = outcome.err.substr(outcome.err.find("--tone"));
  std::istringstream words(flags);
  std::vector<std::string> arguments{"view", "a.exr", "-o", "again.png"};
  for (std::string word; words >> word;) arguments.push_back(word);
  expect_success(arguments);
  EXPECT_EQ(shown("again.png").samples, a.samples);
}

// A street at night: nearly all of it is dark, and a few lamps are far beyond white.
TEST_F(View, ShowsNothingBrighterThanItIsOnTheFilm) {
  std::vector<float> night(200, 0.002F);
  for (std::size_t i = 0; i < 20; ++i) night[i] = 0.01F;
  night[20] = 0.2F;
  for (const float lamp : {1.5F, 30.0F, 3e5F}) {
    for (const int lamps : {1, 30}) {
      std::fill_n(night.begin() + 21, lamps, lamp);
      picture("night.exr", night);
      expect_success({"view", "night.exr", "-o", "night.png"});
      expect_success({"view", "night.exr", "--tone", "none", "-o", "cut.png"});
      const PixelBytes shown_by_itself = shown("night.png");
      const PixelBytes cut = shown("cut.png");
      for (std::size_t i = 0; i < cut.samples.size(); ++i)
        EXPECT_LE(shown_by_itself.samples[i], cut.samples[i]) << lamp << " x " << lamps;
    }
  }
}

// What is dark is seen though a lamp is a million times as bright.
TEST_F(View, ALampDoesNotHideTheNight) {
  std::vector<float> night(100, 0.02F);
  for (const float lamp : {4.0F, 4e2F, 4e4F, 4e8F}) {
    night[0] = lamp;
    picture("night.exr", night);
    expect_success({"view", "night.exr"});
    EXPECT_NEAR(shown("night.png").samples[3], 39, 1) << lamp;  // the sRGB signal of 0.02 is 38.6
  }
  // And much light all over is exposed down.
  std::vector<float> day(100, 3e4F);
  day[0] = 1e5F;
  picture("day.exr", day);
  expect_success({"view", "day.exr"});
  EXPECT_LT(shown("day.png").samples[3], 220);
  EXPECT_GT(shown("day.png").samples[3], 150);
}

TEST_F(View, HardlyChangesAPictureThatIsHardlyBeyondWhite) {
  picture("a.exr", {0.1F, 0.5F, 0.9F, 1.05F});
  expect_success({"view", "a.exr"});
  expect_success({"view", "a.exr", "--tone", "none", "-o", "cut.png"});
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(shown("a.png").samples[i], shown("cut.png").samples[i], 6);
}

TEST_F(View, IsWhatRenderDoesForItsPng) {
  write("bright.toml",
        "[film]\nresolution = [32, 20]\n[camera]\nposition = [0, 0, -3]\n[background]\ncolor = [0.1, 0.2, "
        "0.3]\n"
        "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { emission = 40 }\n");
  const Outcome outcome = run({"bright.toml", "--png"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("bright.png: shown with --tone "), std::string::npos) << outcome.err;
  expect_success({"view", "bright.exr", "-o", "viewed.png"});
  EXPECT_EQ(read("bright.png"), read("viewed.png"));
  const Outcome cut = run({"bright.toml", "--png", "--tone", "none", "-o", "cut.exr"});
  EXPECT_NE(cut.err.find("pixels beyond white"), std::string::npos) << cut.err;
  EXPECT_EQ(run({"bright.toml", "--png", "-q", "-o", "quiet.exr"}).err, "");
}

TEST_F(View, AutomaticExposureShowsTheLogAverageAsMiddleGrey) {
  picture("a.exr", {0.001F, 0.1F});  // log-average 0.01
  expect_success({"view", "a.exr", "--exposure", "auto", "--tone", "none", "-o", "grey.png"});
  picture("b.exr", {0.018F, 1.8F});
  expect_success({"view", "b.exr", "--tone", "none", "-o", "same.png"});
  EXPECT_EQ(shown("grey.png").samples, shown("same.png").samples);
}

TEST_F(View, ShowsSeveralImagesInOneWay) {
  picture("a.exr", {0.5F, 0.5F});
  picture("b.exr", {500.0F, 0.5F});
  expect_success({"view", "a.exr", "b.exr", "-o", "png/"});
  EXPECT_EQ(shown("png/a.png").samples[0], shown("png/b.png").samples[3]);
  EXPECT_EQ(shown("png/b.png").samples[0], 255);
  expect_success({"view", "--sheet", "a.exr", "b.exr", "--columns", "1", "-o", "sheet.png"});
  EXPECT_EQ(shown("sheet.png").height, 2);
  EXPECT_EQ(run({"view", "--sheet", "a.exr", "-o", "png/"}).code, 2);
  EXPECT_EQ(run({"view", "--sheet", "a.exr"}).code, 2);
}

TEST_F(View, TellsWhyPixelsAreBlack) {
  const std::vector<std::pair<float, float>> light{{-1, 0},    {0, 0},     {2, 0.3F},
                                                   {1, 1e-5F}, {-1, 0.4F}, {1, 0.5F}};
  picture("a.exr", {0, 0, 0, 1e-6F, 0, 0.5F}, light);
  const Outcome outcome = run({"view", "a.exr", "--why"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const PixelBytes a = shown("a.png");
  EXPECT_GT(a.height, 1);  // the legend
  const std::vector<std::vector<int>> expected{{0, 114, 178}, {230, 159, 0},   {204, 121, 167},
                                               {0, 158, 115}, {204, 121, 167}, {188, 188, 188}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(a.samples[3 * i + c], expected[i][c]) << i;
  }
  for (const char* line : {"missed                      blue            1 pixels",
                           "shadowed                    orange          1 pixels",
                           "shifted out of the visible  pink            2 pixels",
                           "too faint                   green           1 pixels"}) {
    EXPECT_NE(outcome.out.find(line), std::string::npos) << outcome.out;
  }
  picture("b.exr", {0.0F});
  const Outcome without = run({"view", "b.exr", "--why"});
  EXPECT_EQ(without.code, 4);
  EXPECT_NE(without.err.find("render it with --aov light"), std::string::npos);
}

}  // namespace
}  // namespace backlight::test
