#include "backlight/film/texture.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <vector>

#include "backlight/base/files.h"
#include "backlight/film/display.h"
#include "backlight/film/exr.h"
#include "backlight/film/png.h"
#include "folder.h"

namespace backlight {
namespace {

using Textures = InFolder;

/// Width 4, height 2: red is 10 j + i, green its negative, blue 1/3 (which half cannot hold).
Texture grid() {
  std::vector<float> rgb;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 4; ++i) {
      const auto value = static_cast<float>(10 * j + i);
      rgb.insert(rgb.end(), {value, -value, 1.0F / 3.0F});
    }
  }
  return {4, 2, rgb};
}

TEST(Texture, GivesATexelAtItsCentre) {
  const Texture texture = grid();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 4; ++i) {
      // Centres at multiples of 1/8 and 1/4: no rounding.
      const Vec3 value = texture.sample((i + 0.5) / 4.0, (j + 0.5) / 2.0);
      EXPECT_EQ(value, texture.texel(i, j));
      EXPECT_EQ(value.r, 10 * j + i);
      EXPECT_EQ(value.g, -(10 * j + i));
      EXPECT_EQ(value.b, double{1.0F / 3.0F});
    }
  }
}

TEST(Texture, IsBilinearBetweenTheCentres) {
  const Texture texture = grid();
  for (const double x : {0.0, 0.25, 0.5, 1.0, 2.75, 3.0}) {
    for (const double y : {0.0, 0.125, 0.5, 1.0}) {
      EXPECT_DOUBLE_EQ(texture.sample((x + 0.5) / 4.0, (y + 0.5) / 2.0).r, 10.0 * y + x) << x << " " << y;
    }
  }
}

TEST(Texture, RepeatsInUWithoutASeam) {
  const Texture texture = grid();
  EXPECT_DOUBLE_EQ(texture.sample(0.0, 0.25).r, 1.5);  // halfway between texels 3 and 0
  EXPECT_DOUBLE_EQ(texture.sample(1.0, 0.25).r, 1.5);
  // The slope is 12 per unit of u, and the step 2^-53.
  EXPECT_NEAR(texture.sample(std::nextafter(1.0, 0.0), 0.25).r, 1.5, 12 * 0x1p-52);
  EXPECT_DOUBLE_EQ(texture.sample(-1e-20, 0.25).r, 1.5);
  for (const double u : {0.03125, 0.375, 0.96875}) {
    EXPECT_EQ(texture.sample(u + 5.0, 0.25), texture.sample(u, 0.25));
    EXPECT_EQ(texture.sample(u - 3.0, 0.25), texture.sample(u, 0.25));
  }
}

TEST(Texture, ClampsOrRepeatsInV) {
  const Texture texture = grid();
  EXPECT_EQ(texture.sample(0.125, 0.0).r, 0.0);
  EXPECT_EQ(texture.sample(0.125, -7.0).r, 0.0);
  EXPECT_EQ(texture.sample(0.125, 1.0).r, 10.0);
  EXPECT_EQ(texture.sample(0.125, 1e300).r, 10.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.125, 0.0, TextureEdge::repeat).r, 5.0);
  EXPECT_DOUBLE_EQ(texture.sample(0.125, 1.25, TextureEdge::repeat).r, 0.0);
}

TEST(Texture, GivesNanForCoordinatesThatAreNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Texture texture = grid();
  EXPECT_TRUE(std::isnan(texture.sample(nan, 0.5).r));
  EXPECT_TRUE(std::isnan(texture.sample(0.5, infinity).r));
  EXPECT_EQ(texture.sample(1e300, 0.25).b, double{1.0F / 3.0F});  // finite, though no texel is meant
}

TEST(Texture, OfOneTexelIsConstant) {
  const Texture texture(1, 1, {0.5F, 0.25F, 0.125F});
  for (const double u : {0.0, 0.3, 0.99}) {
    EXPECT_EQ(texture.sample(u, 1.0 - u), (Vec3{0.5, 0.25, 0.125}));
  }
}

TEST(Texture, KeepsValuesThatHalfHoldsAndThoseThatItDoesNot) {
  const Texture half(2, 1, {1.0F, 65504.0F, -0.5F, 6e-8F * 0.0F, 0x1p-24F, 3.0F});
  EXPECT_EQ(half.texel(0, 0), (Vec3{1.0, 65504.0, -0.5}));
  EXPECT_EQ(half.texel(1, 0), (Vec3{0.0, 0x1p-24, 3.0}));
  const Texture single(2, 1, {1.0F, 65504.0F, -0.5F, 1e20F, 0x1p-24F, 3.0F});
  EXPECT_EQ(single.texel(1, 0).r, double{1e20F});
}

TEST_F(Textures, EightBitsAreTakenAsSrgb) {
  PixelBytes pixels{256, 1, 3, {}};
  for (int i = 0; i < 256; ++i) {
    pixels.samples.insert(pixels.samples.end(),
                          {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 128});
  }
  ASSERT_TRUE(write_png(folder / "ramp.png", pixels).ok());
  const Result<Texture> texture = load_texture(folder / "ramp.png");
  ASSERT_TRUE(texture.ok()) << texture.error();
  for (int i = 0; i < 256; ++i) {
    const Vec3 value = texture.value().texel(i, 0);
    EXPECT_EQ(value.r, double{static_cast<float>(srgb_to_linear(i / 255.0))});
    EXPECT_EQ(value.g, double{static_cast<float>(srgb_to_linear((255 - i) / 255.0))});
    EXPECT_FLOAT_EQ(static_cast<float>(value.b), 0.21586050F);  // ((128/255 + 0.055) / 1.055)^2.4
  }
}

TEST_F(Textures, SixteenBitsGreyAndAlphaAreUnderstood) {
  ASSERT_TRUE(write_png(folder / "words.png", PixelWords{1, 1, 3, {65535, 32768, 0}}).ok());
  const Result<Texture> words = load_texture(folder / "words.png");
  ASSERT_TRUE(words.ok()) << words.error();
  EXPECT_EQ(words.value().texel(0, 0).r, 1.0);
  EXPECT_NEAR(words.value().texel(0, 0).g, srgb_to_linear(32768.0 / 65535.0), 1e-7);
  EXPECT_EQ(words.value().texel(0, 0).b, 0.0);
  ASSERT_TRUE(write_png(folder / "grey.png", PixelBytes{2, 1, 1, {255, 51}}).ok());
  const Result<Texture> grey = load_texture(folder / "grey.png");
  ASSERT_TRUE(grey.ok()) << grey.error();
  EXPECT_EQ(grey.value().texel(0, 0), Vec3{1.0});
  EXPECT_EQ(grey.value().texel(1, 0), Vec3{double{static_cast<float>(srgb_to_linear(0.2))}});
  // Transparent red stays red: alpha is ignored, not multiplied in.
  ASSERT_TRUE(write_png(folder / "alpha.png", PixelBytes{1, 1, 4, {255, 0, 0, 0}}).ok());
  const Result<Texture> alpha = load_texture(folder / "alpha.png");
  ASSERT_TRUE(alpha.ok()) << alpha.error();
  EXPECT_EQ(alpha.value().texel(0, 0), (Vec3{1.0, 0.0, 0.0}));
}

TEST_F(Textures, ExrStaysLinearAndExact) {
  Image image({{0, 0, 2, 1},
               {0, 0, 2, 1},
               {{"Z", ChannelPrecision::single},
                {"B", ChannelPrecision::single},
                {"G", ChannelPrecision::single},
                {"R", ChannelPrecision::single}},
               {}});
  image.at(3, 0, 0) = 1e5F;
  image.at(2, 0, 0) = 0.1F;
  image.at(1, 0, 0) = -0.25F;
  image.at(3, 1, 0) = 0.5F;
  ASSERT_TRUE(write_exr(folder / "sky.exr", image, {}).ok());
  const Result<Texture> texture = load_texture(folder / "sky.exr");
  ASSERT_TRUE(texture.ok()) << texture.error();
  EXPECT_EQ(texture.value().texel(0, 0), (Vec3{1e5F, 0.1F, -0.25F}));
  EXPECT_EQ(texture.value().texel(1, 0), (Vec3{0.5, 0.0, 0.0}));
}

// Two parts of one pixel: positions, and a colour.
void write_two_parts(const std::filesystem::path& path) {
  const std::array<std::array<const char*, 3>, 2> channels{{{"P.X", "P.Y", "P.Z"}, {"R", "G", "B"}}};
  std::array<float, 3> values{0.25F, 0.5F, 0.75F};
  std::vector<Imf::Header> headers(2, Imf::Header(1, 1));
  for (std::size_t part = 0; part < 2; ++part) {
    headers[part].setName(part == 0 ? "positions" : "colours");
    headers[part].setType(Imf::SCANLINEIMAGE);
    for (const char* name : channels[part]) headers[part].channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
  for (std::size_t part = 0; part < 2; ++part) {
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < 3; ++i) {
      buffer.insert(channels[part][i],
                    Imf::Slice::Make(Imf::FLOAT, &values[i], Imath::V2i(0, 0), std::int64_t{1}, 1));
    }
    Imf::OutputPart out(file, static_cast<int>(part));
    out.setFrameBuffer(buffer);
    out.writePixels(1);
    for (float& value : values) value += 1.0F;
  }
}

TEST_F(Textures, TheColourOfAnExrIsFoundOrMissed) {
  write_two_parts(folder / "parts.exr");
  const Result<Texture> texture = load_texture(folder / "parts.exr");
  ASSERT_TRUE(texture.ok()) << texture.error();
  EXPECT_EQ(texture.value().texel(0, 0), (Vec3{1.25, 1.5, 1.75}));
  // Channels of data are not taken for colours.
  const Image data({{0, 0, 1, 1}, {0, 0, 1, 1}, {{"P.X", {}}, {"P.Y", {}}, {"P.Z", {}}, {"Z", {}}}, {}});
  ASSERT_TRUE(write_exr(folder / "data.exr", data, {}).ok());
  const std::string error = load_texture(folder / "data.exr").error();
  EXPECT_NE(error.find("it has no channels R, G and B, nor Y; there are "), std::string::npos) << error;
  Image grey({{0, 0, 1, 1}, {0, 0, 1, 1}, {{"Y", {}}, {"Z", {}}}, {}});
  grey.at(0, 0, 0) = 0.5F;
  ASSERT_TRUE(write_exr(folder / "grey.exr", grey, {}).ok());
  EXPECT_EQ(load_texture(folder / "grey.exr").value().texel(0, 0), Vec3{0.5});
}

TEST_F(Textures, ACroppedExrIsRefused) {
  const Image image({{0, 0, 8, 8}, {2, 2, 6, 6}, {{"R", {}}, {"G", {}}, {"B", {}}}, {}});
  ASSERT_TRUE(write_exr(folder / "crop.exr", image, {}).ok());
  EXPECT_EQ(load_texture(folder / "crop.exr").error(),
            "cannot read " + (folder / "crop.exr").string() +
                ": only a part of the picture is in the file (its data window is a crop)");
}

TEST_F(Textures, AMissingFileIsNamed) {
  EXPECT_EQ(load_texture(folder / "none.png").error(),
            "cannot read " + (folder / "none.png").string() + ": No such file or directory");
  EXPECT_EQ(load_texture(folder).error(), "cannot read " + folder.string() + ": Is a directory");
  ASSERT_TRUE(write_file(folder / "text.png", "not a picture").ok());
  const std::string error = load_texture(folder / "text.png").error();
  EXPECT_TRUE(error.starts_with("cannot read " + (folder / "text.png").string() + ": ")) << error;
}

/// A file cut at many places must fail, never give a grey rest. The last `spare` bytes may be missing.
void expect_cuts_to_fail(const std::filesystem::path& path, std::size_t step, std::size_t spare = 0) {
  ASSERT_TRUE(load_texture(path).ok()) << load_texture(path).error();
  const std::string whole = read_file(path).value();
  for (std::size_t size = 0; size + spare < whole.size(); size += step) {
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary) << std::string_view(whole).substr(0, size);
    ::testing::internal::CaptureStderr();
    const Result<Texture> cut = load_texture(path);
    ASSERT_EQ(::testing::internal::GetCapturedStderr(), "")
        << path << " cut to " << size;  // libraries' own words
    ASSERT_FALSE(cut.ok()) << path << " cut to " << size << " of " << whole.size() << " bytes";
    ASSERT_TRUE(cut.error().starts_with("cannot read " + path.string() + ": ")) << cut.error();
    ASSERT_EQ(cut.error().find('\n'), std::string::npos) << cut.error();
  }
}

TEST_F(Textures, CutFilesAreErrors) {
  PixelBytes pixels{64, 48, 3, {}};
  Image image({{0, 0, 64, 48}, {0, 0, 64, 48}, {{"R", {}}, {"G", {}}, {"B", {}}}, {}});
  std::uint32_t state = 9;
  for (int i = 0; i < 64 * 48 * 3; ++i) {
    state = 1664525 * state + 1013904223;
    pixels.samples.push_back(static_cast<std::uint8_t>(state >> 24U));
    image.plane(static_cast<std::size_t>(i % 3))[static_cast<std::size_t>(i / 3)] = static_cast<float>(state);
  }
  ASSERT_TRUE(write_png(folder / "cut.png", pixels).ok());
  expect_cuts_to_fail(folder / "cut.png", 401);
  ASSERT_TRUE(write_exr(folder / "cut.exr", image, {}).ok());
  expect_cuts_to_fail(folder / "cut.exr", 1409);
}

TEST_F(Textures, ACutJpegIsAnError) {
  const std::filesystem::path path = folder / "cut.jpg";
  std::filesystem::copy_file(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / "tests/unit/film/grid.jpg", path);
  const Result<Texture> whole = load_texture(path);
  ASSERT_TRUE(whole.ok()) << whole.error();
  // The left half is red, the right half blue.
  EXPECT_EQ(whole.value().width(), 32);
  EXPECT_EQ(whole.value().height(), 16);
  EXPECT_NEAR(whole.value().texel(4, 4).r, 1.0, 0.03);
  EXPECT_NEAR(whole.value().texel(4, 4).b, 0.0, 0.03);
  EXPECT_NEAR(whole.value().texel(28, 4).b, 1.0, 0.03);
  // Without its last two bytes, the end-of-image marker, the picture is still whole.
  expect_cuts_to_fail(path, 1, 2);
}

}  // namespace
}  // namespace backlight
