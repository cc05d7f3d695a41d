#include "backlight/film/png.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cstdio>
#include <string>

#include "backlight/base/files.h"
#include "backlight/film/texture.h"
#include "folder.h"

namespace backlight {
namespace {

using Png = InFolder;

PixelBytes gradient(int width, int height) {
  PixelBytes pixels{width, height, 3, {}};
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      for (const int value : {i * 7, j * 11, i * j}) {
        pixels.samples.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return pixels;
}

TEST_F(Png, DecodesToTheBytesThatWereWritten) {
  const PixelBytes pixels = gradient(37, 23);
  ASSERT_TRUE(write_png(folder / "deep" / "a.png", pixels).ok());
  const Result<PixelBytes> read = read_rgb_bytes(folder / "deep" / "a.png");
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_EQ(read.value().width, 37);
  EXPECT_EQ(read.value().height, 23);
  EXPECT_EQ(read.value().samples, pixels.samples);
}

TEST_F(Png, TheSamePixelsGiveTheSameBytesAndNoClock) {
  ASSERT_TRUE(write_png(folder / "a.png", gradient(20, 20)).ok());
  ASSERT_TRUE(write_png(folder / "b.png", gradient(20, 20)).ok());
  const std::string bytes = read_file(folder / "a.png").value();
  EXPECT_EQ(bytes, read_file(folder / "b.png").value());
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);
}

TEST_F(Png, RefusesPixelsThatDoNotFitAndFoldersThatAreNone) {
  PixelBytes pixels = gradient(4, 4);
  pixels.samples.pop_back();
  EXPECT_EQ(write_png(folder / "a.png", pixels).error(),
            "cannot write " + (folder / "a.png").string() +
                ": the picture has no pixel, or not as many as it says");
  EXPECT_FALSE(write_png(folder / "a.png", PixelBytes{}).ok());
  EXPECT_EQ(write_png(folder, gradient(4, 4)).error(),
            "cannot write " + folder.string() + ": Is a directory");
  EXPECT_EQ(entries(), 0);
}

TEST_F(Png, SaysWhereItLookedForTheModule) {
  ::setenv("BACKLIGHT_MODULE_PATH", folder.c_str(), 1);
  const Result<void> written = write_png(folder / "a.png", gradient(4, 4));
  const Result<Texture> texture = load_texture(folder / "a.png");
  ::unsetenv("BACKLIGHT_MODULE_PATH");
  const std::string expected =
      "cannot find the module for textures and PNG (BACKLIGHT_MODULE_PATH names its folder):\n  not at " +
      (folder / "libbacklight_oiio.so").string();
  EXPECT_EQ(written.error(), expected);
  EXPECT_EQ(texture.error(), expected);
  EXPECT_EQ(entries(), 0);
}

TEST_F(Png, SaysThatAModuleCannotBeLoaded) {
  ASSERT_TRUE(write_file(folder / "libbacklight_oiio.so", "not a library").ok());
  ::setenv("BACKLIGHT_MODULE_PATH", folder.c_str(), 1);
  const std::string error = write_png(folder / "a.png", gradient(4, 4)).error();
  ::unsetenv("BACKLIGHT_MODULE_PATH");
  EXPECT_TRUE(error.starts_with("cannot load the module for textures and PNG: ")) << error;
}

/// This very program uses textures and PNG, and is not linked with OpenImageIO.
TEST(ModuleOnDemand, IsNotAmongTheLibrariesOfTheProgram) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  FILE* pipe = ::popen(("ldd '" + program + "'").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string libraries;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) {
    libraries += line.data();
  }
  ASSERT_EQ(::pclose(pipe), 0);
  EXPECT_NE(libraries.find("libOpenEXR"), std::string::npos) << libraries;
  EXPECT_EQ(libraries.find("OpenImageIO"), std::string::npos) << libraries;
}

}  // namespace
}  // namespace backlight
