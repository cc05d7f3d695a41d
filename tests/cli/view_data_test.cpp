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

// What a mirror does not show has no value, and its shifts have the scale of shifts.
TEST_F(ViewData, WhatMirrorsShow) {
  const float none = std::numeric_limits<float>::infinity();
  picture("a.exr", {{"mirror.V", {2.0F, 0.0F, 4.0F}},
                    {"mirror.D", {1.0F, 0.0F, 0.5F}},
                    {"mirror.T", {-1.0F, 0.0F, -3.0F}},
                    {"mirror.Z", {1.0F, none, 3.0F}}});
  for (const char* channel : {"mirror.D", "mirror.T", "mirror.Z", "mirror.V"}) {
    expect_success({"view", "a.exr", "--channel", channel});
    EXPECT_EQ(at(shown("a.png"), 1, 3), (std::array{70, 70, 70})) << channel;
    EXPECT_NE(at(shown("a.png"), 2, 3), (std::array{70, 70, 70})) << channel;
  }
  expect_success({"view", "a.exr", "--channel", "mirror.D"});
  EXPECT_EQ(at(shown("a.png"), 0, 3), (std::array{247, 247, 247}));
}

// Between two objects is none, and one value has one mark: those of the scale are white, below it.
TEST_F(ViewData, ScalesHaveNoMoreMarksThanValues) {
  const auto marks = [&](const std::string& channel) {
    expect_success({"view", "a.exr", "--channel", channel});
    const PixelBytes a = shown("a.png");
    int count = 0;
    for (int x = 0; x < a.width; ++x) count += at(a, x, 40 + 3 * 12 + 1) == std::array{255, 255, 255} ? 1 : 0;
    return count;
  };
  picture(
      "a.exr",
      {{"objectId.V", {1.0F, 2.0F, 3.0F}}, {"light.N", {1.0F, 1.0F, 1.0F}}, {"light.Y", {0.3F, 0.3F, 0.3F}}});
  EXPECT_EQ(marks("objectId"), 3);
  EXPECT_EQ(marks("light.N"), 2);
  EXPECT_EQ(marks("light.Y"), 1);
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

// The words of --png are those that view writes.
TEST_F(ViewData, LabelsOfPngsBesideImages) {
  write_scene("scene.toml", "[params]\nv = 0.25\n");
  const std::string label = "v = {params.v}, t = {time}, {file}";
  expect_success({"scene.toml", "-q", "-r", "160x80", "-D", "params.v=0.5", "--png", "--label", label});
  expect_success({"view", "scene.exr", "-q", "--label", label, "-o", "viewed.png"});
  expect_success({"view", "scene.exr", "-q", "-o", "plain.png"});
  EXPECT_EQ(read("scene.png"), read("viewed.png"));
  EXPECT_NE(read("scene.png"), read("plain.png"));
  expect_error(2, {"scene.toml", "-q", "-o", "no/x.exr", "--png", "--label", "{params.w}"},
               "backlight: error: --label: the image does not tell {params.w}");
  EXPECT_FALSE(exists("no"));
  expect_error(2, {"scene.toml", "--label", "v"}, "--label requires --png");
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
  picture("square.exr", {{"Z", Values(40, 1.0F)}});
  expect_error(4, {"view", "square.exr", "--faces"},
               "square.exr: it is no cubemap of six faces, which is 3:2");
  write_scene();
  expect_success({"scene.toml", "-q"});
  expect_error(4, {"view", "scene.exr", "--faces"}, "scene.exr: its projection is perspective, not cubemap");
  expect_error(2, {"view", "cube.exr", "--faces", "-o", "one.png"}, "six files are written");
}

// Each face is what a perspective camera renders that looks there, its data and its header too.
TEST_F(ViewData, FacesOfACubemapAreOpenExrFiles) {
  const std::string scene =
      "[[object]]\nname = \"box\"\nshape = \"box\"\nsize = [7, 5, 9]\nposition = [0.3, 0.2, -0.4]\nbeta = "
      "[0.3, 0, 0]\nmaterial = { checker = { colors = [[0.9, 0.5, 0.1], [0.1, 0.2, 0.6]], size = 0.7 } }\n"
      "[[light]]\nposition = [0.4, 1, 0.2]\nintensity = 20\n";
  const std::string film = "[film]\nresolution = [36, 24]\naovs = [\"Z\", \"doppler\", \"objectId\"]\n";
  const std::string place = "position = [0, 0.5, 0]\ntime = 0.5\n";
  write("cube.toml", film + "[camera]\nprojection = \"cubemap\"\ndirection = [0, 0, 1]\n" + place + scene);
  expect_success({"cube.toml", "-q", "-s", "1"});
  expect_success({"assemble", "cube.exr", "--faces", "-o", "faces/"});
  const std::array<std::array<std::string, 3>, 6> ways{{{"right", "[-1, 0, 0]", "[0, 1, 0]"},
                                                        {"left", "[1, 0, 0]", "[0, 1, 0]"},
                                                        {"up", "[0, 1, 0]", "[0, 0, -1]"},
                                                        {"down", "[0, -1, 0]", "[0, 0, 1]"},
                                                        {"front", "[0, 0, 1]", "[0, 1, 0]"},
                                                        {"back", "[0, 0, -1]", "[0, 1, 0]"}}};
  for (const auto& [face, direction, up] : ways) {
    write(face + ".toml",
          film + "[camera]\nfov = 90\ndirection = " + direction + "\nup = " + up + "\n" + place + scene);
    expect_success({face + ".toml", "-q", "-s", "1", "-r", "12x12"});
    const std::string file = "faces/cube." + face + ".exr";
    expect_success({"compare", face + ".exr", file, "--fail", "1e-5", "--failrelative", "1e-3"});
    const auto one = read_exr(folder / "work" / (face + ".exr"));
    const auto other = read_exr(folder / "work" / file);
    ASSERT_TRUE(one.ok() && other.ok());
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_NEAR((*one.value().header.world_to_camera)[i], (*other.value().header.world_to_camera)[i], 1e-6)
          << face << i;
    }
    EXPECT_EQ(*other.value().header.find<std::string>("backlight/face"), face);
    EXPECT_EQ(other.value().header.find<std::string>("backlight/identity"), nullptr);
    EXPECT_EQ(run({"probe", face + ".exr", "3,8"}).out.substr(face.size()),
              run({"probe", file, "3,8"}).out.substr(file.size() - 4));
  }
  expect_success({"assemble", "cube.exr", "--faces"});
  EXPECT_EQ(read("cube.down.exr"), read("faces/cube.down.exr"));
  expect_error(1, {"assemble", "up.exr", "--faces"}, "up.exr: its projection is perspective, not cubemap");
  expect_error(2, {"assemble", "cube.exr", "--faces", "-o", "six.exr"}, "six files are written");
  expect_error(2, {"assemble", "cube.exr", "up.exr", "--faces"}, "one cubemap at a time");
  expect_success({"cube.toml", "-q", "--crop", "0,0,12,12", "-o", "crop.exr"});
  expect_error(1, {"assemble", "crop.exr", "--faces"}, "crop.exr: it is a crop, not a whole cubemap");
}

}  // namespace
}  // namespace backlight::test
