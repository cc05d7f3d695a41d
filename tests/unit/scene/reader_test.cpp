// Includes, overrides, parameters and the digest. (What is said about mistakes: tests/messages.)
#include "backlight/scene/reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "backlight/base/files.h"
#include "backlight/base/sha256.h"
#include "backlight/scene/compile.h"
#include "compiled.h"

namespace backlight {
namespace {

using namespace std::string_literals;
using testing_scenes::all_messages;
using testing_scenes::camera;
using testing_scenes::compiled;

class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(BACKLIGHT_BINARY_DIR) / "scene_files" / name;
    std::filesystem::remove_all(folder_);
  }
  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file(folder_ / name, text).ok());
  }
  [[nodiscard]] ReadResult read(const std::string& name) const { return read_scene(folder_ / name); }

  [[nodiscard]] auto read_catalogue(const std::string& name) const { return read_stars(folder_ / name); }

  Scene scene(const std::string& name) const {
    ReadResult result = read(name);
    ResourceCache cache;
    std::optional<Scene> compiled;
    if (result.description) compiled = compile(*result.description, {}, cache, result.diagnostics);
    EXPECT_TRUE(compiled.has_value()) << all_messages(result.diagnostics);
    EXPECT_TRUE(result.diagnostics.all().empty()) << all_messages(result.diagnostics);
    return compiled ? std::move(*compiled) : Scene{};
  }

 private:
  std::filesystem::path folder_;
};

const std::string sphere = "[[object]]\nshape = \"sphere\"\nradius = 1\n";

TEST_F(SceneFiles, IncludedObjectsComeFirstInTheOrderOfReading) {
  write("main.toml",
        "include = [\"a/a.toml\", \"b.toml\"]\n" + camera + sphere + "name = \"own\"\nmaterial = \"red\"\n");
  write("a/a.toml", "include = [\"deeper.toml\"]\n" + sphere + "name = \"of a\"\n");
  write("a/deeper.toml", sphere + "name = \"of deeper\"\n");
  write("b.toml", sphere + "name = \"of b\"\n[material.red]\ncolor = [1, 0, 0]\n");
  const Scene s = scene("main.toml");
  ASSERT_EQ(s.objects.size(), 4U);
  EXPECT_EQ(s.objects[0].name, "of deeper");
  EXPECT_EQ(s.objects[1].name, "of a");
  EXPECT_EQ(s.objects[2].name, "of b");
  EXPECT_EQ(s.objects[3].name, "own");
}

TEST_F(SceneFiles, AFileReachedTwiceIsReadOnce) {
  write("main.toml", "include = [\"a.toml\", \"b.toml\", \"./a.toml\"]\n" + camera);
  write("a.toml", "include = [\"common.toml\"]\n");
  write("b.toml", "include = [\"common.toml\"]\n");
  write("common.toml", sphere + "material = \"red\"\n[material.red]\ncolor = [1, 0, 0]\n");
  EXPECT_EQ(scene("main.toml").objects.size(), 1U);
}

TEST_F(SceneFiles, TheIncludersParametersReplaceTheIncludeds) {
  write("main.toml", "include = [\"a.toml\"]\n" + camera + "[params]\nr = 3\n");
  write("a.toml",
        "[params]\nr = 1\nh = \"2*r\"\n[[object]]\nshape = \"cylinder\"\nradius = \"r\"\nheight = \"h\"\n");
  const Scene s = scene("main.toml");
  EXPECT_NEAR(s.frames[0].surfaces->bounds(0).radius, std::sqrt(18.0), 1e-11);
}

TEST_F(SceneFiles, UnusedDefinitionsOfIncludedFilesAreNoMistake) {
  write("main.toml", "include = [\"a.toml\"]\n" + camera);
  write("a.toml", "[params]\nr = 1\n[material.red]\ncolor = [1, 0, 0]\n[frame.f]\nbeta = [0.5, 0, 0]\n");
  scene("main.toml");
}

TEST_F(SceneFiles, TheDigestIsThatOfTheBytesRead) {
  write("alone.toml", camera);
  EXPECT_EQ(read("alone.toml").description->sha256, sha256_hex(camera));
  const std::string text = "include = [\"alone.toml\"]\n" + camera;
  write("main.toml", text);
  EXPECT_EQ(read("main.toml").description->sha256, sha256_hex(text + camera));
}

TEST_F(SceneFiles, AMissingSceneFileSaysSo) {
  const ReadResult result = read("none.toml");
  EXPECT_TRUE(result.unreadable);
  EXPECT_FALSE(result.description.has_value());
  EXPECT_NE(all_messages(result.diagnostics).find("none.toml"), std::string::npos);
}

TEST_F(SceneFiles, IncludesMayBeDeepButNotBottomless) {
  for (int i = 0; i < 100; ++i) {
    write(std::to_string(i) + ".toml", "include = [\"" + std::to_string(i + 1) + ".toml\"]\n");
  }
  write("100.toml", "");
  const ReadResult result = read("0.toml");
  EXPECT_NE(
      all_messages(result.diagnostics).find("64.toml:1:12: error: files are included more than 64 deep"),
      std::string::npos)
      << all_messages(result.diagnostics);
}

TEST(SceneOverrides, ReplaceAndAdd) {
  const std::string text = "c = 2\n" + camera +
                           "fov = 30\n[params]\nr = 1\n[frame.f]\nvelocity = [0.5, 0, 0]\n" + sphere +
                           "name = \"ball\"\nframe = \"f\"\n[[object]]\nshape = \"sphere\"\nradius = \"r\"\n";
  const Scene s =
      compiled(text, {},
               {"c=4", "camera.fov = 45.5", "film.samples=9", "object.ball.position=[1,2,3]",
                "object.2.name=second", "params.r=2", "frame.f.velocity=[1,0,0]", "camera.time='0.5 + t'",
                "effects.doppler=false", "film.resolution=[10, 20]", "camera.projection=fisheye"});
  EXPECT_EQ(s.c, 4.0);
  EXPECT_NEAR(s.camera.lens.fov, 45.5 * std::acos(-1.0) / 180, 1e-15);
  EXPECT_EQ(s.camera.lens.projection, Projection::fisheye);
  EXPECT_EQ(s.film.samples, 9);
  EXPECT_EQ(s.film.height, 20);
  EXPECT_EQ(s.frames[1].surfaces->bounds(0).centre, (Vec3{1, 2, 3}));
  EXPECT_NEAR(double(s.frames[1].motion.celerity[0]), 0.25 / std::sqrt(1 - 0.0625), 1e-16);
  EXPECT_EQ(s.objects[1].name, "second");
  EXPECT_NEAR(s.frames[0].surfaces->bounds(0).radius, 2.0, 1e-11);
  EXPECT_EQ(s.camera.proper_time, 2.0);
  EXPECT_FALSE(s.effects.doppler);
}

TEST(SceneOverrides, ReachNamedCamerasLightsAndRegions) {
  const std::string text =
      "[[camera]]\nname = \"a.b\"\n[[camera]]\nname = \"c\"\n[[light]]\nname = \"lamp\"\n[[light]]\n"
      "[[effects.region]]\nrect = [0, 0, 1, 1]\n";
  const Scene s = compiled(text, {},
                           {"camera.\"a.b\".fov=90", "light.lamp.intensity=3", "light.2.intensity=\"2*t+5\"",
                            "effects.region.1.doppler=false"});
  EXPECT_NEAR(s.camera.lens.fov, std::acos(0.0), 1e-15);
  EXPECT_EQ(s.lights[0].strength, 3.0);
  EXPECT_TRUE(s.lights[1].flickers);
  EXPECT_FALSE(s.regions[0].effects.doppler);
}

TEST(SceneOverrides, AreKeptForTheImagesHeader) {
  EXPECT_EQ(read_scene_text(camera, "x", {"c=3"}).description->overrides, std::vector<std::string>{"c=3"});
}

TEST(SceneReader, NumbersMayBeFormulasAnywhere) {
  const Scene s = compiled("[params]\nn = 2\n[film]\nresolution = [\"32*n\", \"48\"]\n" + camera + sphere +
                           "repeat = { count = [\"n\", \"n + 1\", 1], step = [\"1/n\", 1, 1] }\n" +
                           "[background]\nstars = { count = \"5*n\" }\n");
  EXPECT_EQ(s.film.width, 64);
  EXPECT_EQ(s.frames[0].surfaces->size(), 6U);
  EXPECT_EQ(s.sky.stars.size(), 10U);
}

// Chains are followed without recursion, and in a time that grows as their length does: with the square of
// it, this would take minutes.
TEST_F(SceneFiles, ChainsMayBeLong) {
  constexpr int length = 100'000;
  std::string text = "[params]\n";
  for (int i = 0; i < length; ++i)
    text += "p" + std::to_string(i) + " = \"p" + std::to_string(i + 1) + " + 1\"\n";
  text +=
      "p" + std::to_string(length) + " = 0\n" + camera + "[[object]]\nshape = \"sphere\"\nradius = \"p0\"\n";
  const Scene scene = compiled(text);
  EXPECT_EQ(scene.frames.front().surfaces->shape(0).values[0], length);
}

TEST_F(SceneFiles, FramesMayLieWithinManyOthers) {
  constexpr int length = 20'000;
  std::string text = camera;
  for (int i = 0; i < length; ++i) {
    const std::string outer = i + 1 < length ? "within = \"f" + std::to_string(i + 1) + "\"\n" : "";
    text += "[frame.f" + std::to_string(i) + "]\norigin = [1, 0, 0]\n" + outer;
  }
  text += "[[object]]\nshape = \"sphere\"\nradius = 1\nframe = \"f0\"\n";
  const Scene scene = compiled(text);
  EXPECT_EQ(double(scene.frames.back().motion.origin.x[0]), length);
}

TEST_F(SceneFiles, CirclesAreFoundInLongChains) {
  std::string text = "[params]\n";
  for (int i = 0; i < 1000; ++i)
    text += "p" + std::to_string(i) + " = \"p" + std::to_string((i + 1) % 1000) + "\"\n";
  const ReadResult result = read_scene_text(text + camera, "circle.toml");
  EXPECT_NE(all_messages(result.diagnostics).find("parameters use each other in a circle: p0 -> p1 -> "),
            std::string::npos);
  EXPECT_NE(all_messages(result.diagnostics).find(" -> ... (981 more) -> "), std::string::npos);
}

TEST_F(SceneFiles, AMarkOfUtf8IsNoPartOfTheText) {
  write("marked.toml", "\xEF\xBB\xBF" + std::string(camera));
  EXPECT_EQ(scene("marked.toml").frames.size(), 1U);
}

TEST_F(SceneFiles, TablesOfNumbersAreReadAsSpreadsheetsWriteThem) {
  for (const std::string& text :
       {"right_ascension,declination,magnitude,b_minus_v\n1,2,3,0.5\n"s,
        "\xEF\xBB\xBFright_ascension;declination;magnitude;b_minus_v\r\n1;2;3;0.5\r\n;;;\r\n\r\n"s,
        "\"right_ascension\"\t\"declination\"\t\"magnitude\"\t\"b_minus_v\"\r1\t2\t\"3\"\t0.5\r"s}) {
    write("stars.csv", text);
    const auto stars = read_catalogue("stars.csv");
    ASSERT_TRUE(stars.ok()) << stars.error();
    ASSERT_EQ(stars.value().size(), 1U) << text;
    EXPECT_EQ(stars.value()[0].b_minus_v, 0.5);
  }
}

}  // namespace
}  // namespace backlight
