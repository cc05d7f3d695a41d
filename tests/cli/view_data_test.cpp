// backlight view of data channels, with words, both eyes and faces of cubemaps.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "backlight/film/exr.h"
#include "backlight/film/png.h"
#include "program.h"

namespace backlight::test {
namespace {

using Values = std::vector<float>;

class ViewData : public ProgramTest {
 protected:
  // Black pixels beside each other with these data channels, of 40 rows.
  void picture(const std::string& name, const std::vector<std::pair<std::string, Values>>& data,
               const ExrHeader& header = {}) const {
    const int width = static_cast<int>(data.front().second.size());
    ImageLayout layout;
    layout.display = layout.data = {0, 0, width, 40};
    for (const char* channel : {"R", "G", "B"})
      layout.channels.push_back({channel, ChannelPrecision::single});
    for (const auto& [channel, values] : data) layout.channels.push_back({channel, ChannelPrecision::single});
    Image image(layout);
    for (std::size_t c = 0; c < data.size(); ++c) {
      for (int x = 0; x < width; ++x) {
        for (int y = 0; y < 40; ++y) image.at(3 + c, x, y) = data[c].second[static_cast<std::size_t>(x)];
      }
    }
    const auto written = write_exr(folder / "work" / name, image, header);
    if (!written.ok()) ADD_FAILURE() << written.error();
  }

  [[nodiscard]] PixelBytes shown(const std::string& name) const {
    auto pixels = read_rgb_bytes(folder / "work" / name);
    if (!pixels.ok()) throw std::runtime_error(pixels.error());
    return std::move(pixels).value();
  }

  static std::array<int, 3> at(const PixelBytes& pixels, int x, int y) {
    const auto i = 3 * static_cast<std::size_t>(y * pixels.width + x);
    return {pixels.samples[i], pixels.samples[i + 1], pixels.samples[i + 2]};
  }

  void expect_success(const std::vector<std::string>& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }

  void expect_error(int code, const std::vector<std::string>& arguments, const std::string& words) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
};

TEST_F(ViewData, DopplerFactorsAreAboutOneByTheirLogarithm) {
  picture("a.exr", {{"doppler.D", {0.25F, 0.5F, 1.0F, 2.0F, 4.0F}}});
  expect_success({"view", "a.exr", "--channel", "doppler"});
  const PixelBytes a = shown("a.png");
  EXPECT_EQ(at(a, 2, 5), (std::array{247, 247, 247}));
  const auto lightness = [&](int x) {  // CIE L*
    double y = 0.0;
    constexpr std::array shares{0.2126, 0.7152, 0.0722};
    for (std::size_t c = 0; c < 3; ++c)
      y += shares[c] * std::pow((at(a, x, 5)[c] / 255.0 + 0.055) / 1.055, 2.4);
    return 116.0 * std::cbrt(y) - 16.0;
  };
  EXPECT_GT(at(a, 1, 5)[0], at(a, 1, 5)[2] + 50);  // red
  EXPECT_GT(at(a, 3, 5)[2], at(a, 3, 5)[0] + 50);  // blue
  EXPECT_LT(lightness(0), lightness(1));
  EXPECT_LT(lightness(4), lightness(3));
  EXPECT_NEAR(lightness(1), lightness(3), 1.0);
  EXPECT_NEAR(lightness(0), lightness(4), 1.0);
  // The scale is below, wide enough to be read: words, colours, marks and numbers.
  EXPECT_EQ(a.width, 320);
  EXPECT_EQ(a.height, 40 + 5 * 12);
  int letters = 0;
  for (int x = 0; x < 320; ++x) letters += at(a, x, 40 + 14)[1] > 128 ? 1 : 0;
  EXPECT_GT(letters, 20);
  EXPECT_GE(at(a, 160, 40 + 2 * 12 + 3)[1], 245);  // 1 is in the middle of it
  EXPECT_GT(at(a, 40, 40 + 2 * 12 + 3)[0], at(a, 40, 40 + 2 * 12 + 3)[2] + 50);
}

TEST_F(ViewData, SeveralImagesGetOneScale) {
  picture("a.exr", {{"properTime.T", {0.0F, 1.0F}}});
  picture("b.exr", {{"properTime.T", {1.0F, 3.0F}}});
  expect_success({"view", "a.exr", "b.exr", "--channel", "properTime", "-o", "png/"});
  EXPECT_EQ(at(shown("png/a.png"), 1, 3), at(shown("png/b.png"), 0, 3));
  expect_success({"view", "a.exr", "--channel", "properTime.T", "--range", "0,3", "-o", "alone.png"});
  EXPECT_EQ(shown("alone.png").samples, shown("png/a.png").samples);
  expect_success({"view", "a.exr", "--channel", "properTime", "-o", "own.png"});
  EXPECT_NE(at(shown("own.png"), 1, 3), at(shown("png/a.png"), 1, 3));
}

TEST_F(ViewData, WhatHasNoValueIsGrey) {
  const float none = std::numeric_limits<float>::infinity();
  picture("a.exr", {{"Z", {2.0F, none, 3.0F}},
                    {"emissionTime.T", {-2.0F, 0.0F, -3.0F}},
                    {"lampTime.1", {-4.0F, -none, -none}}});
  const std::array grey{70, 70, 70};
  expect_success({"view", "a.exr", "--channel", "emissionTime"});
  EXPECT_EQ(at(shown("a.png"), 1, 3), grey);
  EXPECT_NE(at(shown("a.png"), 0, 3), grey);
  expect_success({"view", "a.exr", "--channel", "Z"});
  EXPECT_EQ(at(shown("a.png"), 1, 3), grey);
  expect_success({"view", "a.exr", "--channel", "lampTime"});
  EXPECT_NE(at(shown("a.png"), 0, 3), grey);
  EXPECT_EQ(at(shown("a.png"), 2, 3), grey);
}

TEST_F(ViewData, SaysWhichChannelsThereAre) {
  picture("a.exr", {{"P.X", {1.0F}}, {"P.Y", {1.0F}}});
  expect_error(4, {"view", "a.exr", "--channel", "P"},
               "a.exr: more than one channel is P; there are B, G, P.X, P.Y, R");
  expect_error(4, {"view", "a.exr", "--channel", "Z"},
               "a.exr: the picture has no channel Z; there are B, G, P.X");
  expect_error(2, {"view", "a.exr", "--channel", "P.X", "--range", "3,1"}, "expected LO,HI with LO below HI");
  expect_error(2, {"view", "a.exr", "--range", "1,3"}, "--range");
  expect_error(2, {"view", "a.exr", "--channel", "P.X", "--tone", "none"}, "--channel");
  expect_error(2, {"view", "a.exr", "--channel", "P.X", "--why"}, "not together with --why");
}

TEST_F(ViewData, LabelsTellWhatTheImageTells) {
  ExrHeader header;
  header.attributes = {{"backlight/time", 1.0 / 3.0},
                       {"backlight/params", std::vector<std::string>{"v = 0.9", "n = 3"}}};
  const Values wide(200, 0.5F);
  picture("a.exr", {{"samples.N", wide}}, header);
  expect_success({"view", "a.exr", "-o", "plain.png"});
  const auto ink = [&](const std::string& label) {
    expect_success({"view", "a.exr", "--label", label});
    const PixelBytes pixels = shown("a.png");
    int sum = 0;
    for (std::size_t i = 0; i < pixels.samples.size(); ++i) {
      sum += pixels.samples[i];
      if (i < static_cast<std::size_t>(3 * 200 * 20)) {
        EXPECT_EQ(pixels.samples[i], 0);
      }
    }
    return std::pair{sum, pixels.samples};
  };
  // The same words are the same pixels, whether written or looked up.
  EXPECT_EQ(ink("v = {params.v} c, t = {time:.2} s").second, ink("v = 0.9 c, t = 0.33 s").second);
  EXPECT_EQ(ink("{file}: {{n}} = {params.n}").second, ink("a: {{n}} = 3").second);
  EXPECT_EQ(ink("{time}").second, ink("0.333333").second);
  EXPECT_GT(ink("v = 0.9 c").first, 5000);
  // Letters beyond ASCII are themselves.
  EXPECT_NE(ink("\u03b2").second, ink("2").second);
  EXPECT_NE(ink("\u03b2").second, ink("\u03b3").second);
  expect_error(2, {"view", "a.exr", "--label", "{tme}"},
               "a.exr: the image does not tell {tme}; did you mean {time}?");
  expect_error(2, {"view", "a.exr", "--label", "{params.w}"}, "does not tell {params.w}");
  expect_error(2, {"view", "a.exr", "--label", "{time"}, "no closing brace");
  expect_error(2, {"view", "a.exr", "--label", "{time:2}"}, "expected decimals such as {time:.2}");
}

TEST_F(ViewData, BothEyesAreOneAboveTheOther) {
  write("pair.toml",
        "[film]\nresolution = [24, 16]\naovs = [\"Z\"]\n[camera]\nposition = [0, 0, -3]\nstereo = { "
        "separation = 1 }\n"
        "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { emission = 0.5 }\n");
  expect_success({"pair.toml", "-q"});
  expect_success({"view", "pair.exr", "--eye", "top-bottom", "-o", "both.png"});
  expect_success({"view", "pair.exr", "--eye", "left", "-o", "left.png"});
  expect_success({"view", "pair.exr", "--eye", "right", "-o", "right.png"});
  PixelBytes expected = shown("left.png");
  const PixelBytes right = shown("right.png");
  ASSERT_NE(expected.samples, right.samples);
  expected.samples.insert(expected.samples.end(), right.samples.begin(), right.samples.end());
  EXPECT_EQ(shown("both.png").height, 32);
  EXPECT_EQ(shown("both.png").samples, expected.samples);
  expect_success({"view", "pair.exr", "--eye", "right", "--channel", "Z", "-o", "z.png"});
  expect_error(4, {"view", "a.exr", "--eye", "top-bottom"}, "a.exr");
}

TEST_F(ViewData, FacesOfACubemapAreFiles) {
  write("cube.toml",
        "[film]\nresolution = [36, 24]\n[camera]\nprojection = \"cubemap\"\n[background]\ncolor = [0.1, 0.1, "
        "0.1]\n"
        "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [0, 0, 3]\nmaterial = { emission = 0.5 }\n");
  expect_success({"cube.toml", "-q"});
  expect_success({"view", "cube.exr", "--faces", "-o", "faces/"});
  for (const char* face : {"right", "left", "up", "down", "front", "back"}) {
    const PixelBytes pixels = shown(std::string("faces/cube.") + face + ".png");
    EXPECT_EQ(pixels.width, 12);
    EXPECT_EQ(pixels.height, 12);
    EXPECT_EQ(at(pixels, 6, 6)[0] > 120, std::string(face) == "front") << face;
  }
  write_scene();
  expect_success({"scene.toml", "-q"});
  expect_error(4, {"view", "scene.exr", "--faces"}, "scene.exr: its projection is perspective, not cubemap");
  expect_error(2, {"view", "cube.exr", "--faces", "-o", "one.png"}, "six files are written");
}

}  // namespace
}  // namespace backlight::test
