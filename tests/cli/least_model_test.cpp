// Nothing that a scene does not need is run, and what is run is told.
#include <nlohmann/json.hpp>

#include "program.h"

namespace backlight::test {
namespace {

const std::string film = "[film]\nresolution = [16, 12]\n[camera]\nposition = [0, 0, -5]\n";
const std::string sphere = "[[object]]\nshape = \"sphere\"\nradius = 1\n";
const std::string textured = sphere + "material = { texture = \"dot.png\" }\n";
const std::string lamp = "[[light]]\nposition = [-5, 5, -5]\nintensity = 90\n";
const std::string ambient = "[[light]]\ntype = \"ambient\"\n";

class LeastModel : public ProgramTest {
 protected:
  // The statistics of the scene's image.
  nlohmann::json statistics(const std::string& scene) {
    write("scene.toml", scene);
    const Outcome outcome = run({"scene.toml", "-q", "--stats", "stats.json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(read("stats.json"));
  }

  // Whether the dynamic linker opened the library whose name has this in it, while the scene was rendered.
  bool loads(const std::string& library, const std::string& scene,
             const std::vector<std::string>& more = {}) {
    write("scene.toml", scene);
    std::vector<std::string> arguments{"scene.toml", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments, {"LD_DEBUG=files"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("libOpenEXR"), std::string::npos) << "the linker tells nothing";
    return outcome.err.find(library) != std::string::npos;
  }
};

TEST_F(LeastModel, StatisticsGoToTheOutputForADash) {
  write("scene.toml", film + sphere);
  const Outcome outcome = run({"scene.toml", "-q", "-o", "a.exr", "--stats", "-"});
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["file"], "a.exr");
}

TEST_F(LeastModel, OpenImageIoIsLoadedForTexturesAndPngAlone) {
  EXPECT_FALSE(loads("libOpenImageIO", film + sphere + lamp));
  EXPECT_FALSE(loads("backlight_oiio", film + sphere + "beta = [0.5, 0, 0]\n" + lamp));
  EXPECT_TRUE(loads("libOpenImageIO", film + sphere + lamp, {"--png", "-o", "dot.exr"}));
  ASSERT_TRUE(exists("dot.png"));
  EXPECT_TRUE(loads("libOpenImageIO", film + textured + lamp));
}

TEST_F(LeastModel, NoShadowRayWhereNoLightThrowsShadows) {
  const auto without = statistics(film + sphere + ambient);
  EXPECT_EQ(without["shadowRays"], 0);
  const auto with = statistics(film + sphere + ambient + lamp);
  EXPECT_GT(with["shadowRays"], 0);
}

TEST_F(LeastModel, ALightWithoutShadowsHasNoShadowRays) {
  const auto fill = statistics(film + sphere + lamp + "shadows = false\n");
  EXPECT_EQ(fill["shadowRays"], 0);
}

TEST_F(LeastModel, NoDataRayWithoutDataChannels) {
  EXPECT_EQ(statistics(film + sphere + lamp)["dataRays"], 0);
}

TEST_F(LeastModel, NoSpectraWhereNoColourShifts) {
  const auto rest = statistics(film + sphere + lamp);
  EXPECT_EQ(rest["model"], "rgb");
  EXPECT_EQ(rest["wavelengths"], 0);
  EXPECT_EQ(rest["modelWhy"], "nothing moves relative to anything else");
  const auto moving = statistics(film + sphere + "beta = [0.5, 0, 0]\n" + lamp);
  EXPECT_EQ(moving["model"], "spectral");
  EXPECT_EQ(moving["modelWhy"], "object 1 moves relative to the camera");
  EXPECT_EQ(moving["wavelengthsWhy"], "the default");
}

TEST_F(LeastModel, NoRootIsSearchedWhereClosedFormsDo) {
  const auto closed = statistics(film + sphere + lamp);
  EXPECT_EQ(closed["rootsSolved"], 0);
  EXPECT_EQ(closed["roots"], "1 sphere: closed form");
  const auto formula = statistics(film + "[[object]]\nshape = \"implicit\"\nf = \"x^2+y^2+z^2-1\"\n" + lamp);
  EXPECT_GT(formula["rootsSolved"], 0);
}

TEST_F(LeastModel, MovingFramesAreCounted) {
  const auto s = statistics(film + sphere + sphere + "gamma = 40\nalong = [0, 0, 1]\n" + sphere +
                            "gamma = 2\nalong = [0, 0, 1]\n" + lamp);
  EXPECT_EQ(s["frames"], 3);
  EXPECT_EQ(s["movingFrames"], 2);
  EXPECT_EQ(s["extendedFrames"], 1);
  EXPECT_EQ(s["surfaces"], 3);
}

TEST_F(LeastModel, CheckTellsTheSame) {
  write("scene.toml", film + sphere + lamp + ambient);
  const Outcome outcome = run({"check", "scene.toml"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("  roots      1 sphere: closed form\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("  arithmetic double precision; no boosts\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("OpenImageIO is not loaded"), std::string::npos) << outcome.out;
}

TEST_F(LeastModel, CheckTellsWhatImagesShare) {
  const std::string frames = "[animation]\nframes = [1, 3]\n";
  const auto check = [this](const std::string& scene) {
    write("scene.toml", scene);
    return run({"check", "scene.toml"}).out;
  };
  const std::string fixed = check(film + frames + sphere + sphere + "position = [3, 0, 0]\n" + lamp);
  EXPECT_NE(fixed.find("  reuse      from image to image 2 of 2 surfaces, "), std::string::npos) << fixed;
  const std::string growing =
      check(film + frames + sphere +
            "[[object]]\nshape = \"sphere\"\nradius = \"1 + image_time\"\nbeta = [0.5, 0, 0]\n" + lamp);
  EXPECT_NE(growing.find("  reuse      from image to image 1 of 2 surfaces, "), std::string::npos) << growing;
  EXPECT_EQ(check(film + sphere + lamp).find("reuse"), std::string::npos);
}

}  // namespace
}  // namespace backlight::test
