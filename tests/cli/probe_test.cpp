// backlight probe: what it reads off an image at a pixel.
#include <cmath>

#include "backlight/film/exr.h"
#include "program.h"

namespace backlight::test {
namespace {

class Probe : public ProgramTest {
 protected:
  // A wall that fills the picture, seen from 10 away, and moves to the right at 0.6 c; c = 5.
  void render_wall(const std::vector<std::string>& more, const std::string& camera = "") {
    write("wall.toml",
          "c = 5\n[film]\nresolution = [40, 20]\n[camera]\nposition = [0, 0, -10]\nlook_at = [0, 0, 0]\n" +
              camera +
              "[[light]]\ntype = \"ambient\"\nradiance = 1\n"
              "[[object]]\nname = \"wall\"\nshape = \"box\"\nsize = [100, 100, 2]\nbeta = [0.6, 0, 0]\n"
              "material = { color = [0.5, 0.5, 0.5] }\n");
    std::vector<std::string> arguments{"wall.toml", "-q", "-s", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  // The number after a name in an object of JSON.
  static double number_in(const std::string& json, const std::string& name) {
    const std::size_t at = json.find("\"" + name + "\":");
    if (at == std::string::npos) {
      ADD_FAILURE() << name << " is not in " << json;
      return std::nan("");
    }
    return std::atof(json.c_str() + at + name.size() + 3);
  }
};

constexpr double degree = 3.14159265358979323846 / 180.0;

// The three numbers that a lesson is about agree: D = 1/(γ (1 + β cos θ)), θ from the object's velocity.
TEST_F(Probe, AngleAndVelocityGiveTheDopplerFactor) {
  render_wall({"--aov", "all"});
  for (const std::string pixel : {"0,0", "20,10", "39,3", "7,19"}) {
    const Outcome outcome = run({"probe", "wall.exr", pixel, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const double angle = number_in(outcome.out, "angleFromObjectVelocity") * degree;
    EXPECT_NEAR(number_in(outcome.out, "doppler"), 0.8 / (1.0 + 0.6 * std::cos(angle)), 2e-7) << outcome.out;
    // The front of the wall is a plane 9 away.
    EXPECT_NEAR(number_in(outcome.out, "Z"),
                9.0 / std::cos(number_in(outcome.out, "angleFromViewAxis") * degree), 2e-6);
    EXPECT_NEAR(number_in(outcome.out, "emissionTime"), -number_in(outcome.out, "Z") / 5.0, 1e-6);
    EXPECT_NEAR(number_in(outcome.out, "timeInCameraFrame"), number_in(outcome.out, "emissionTime"), 1e-6);
  }
}

// The world's time of what a moving camera sees, brought into the camera's frame by the Lorentz
// transformation.
TEST_F(Probe, TellsTheTimeInTheCamerasFrame) {
  render_wall({"--aov", "all"}, "velocity = [0, 0, 3]\ntime = 0.25\n");
  const Outcome outcome = run({"probe", "wall.exr", "33,4", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // In the camera's frame the light has come from -Z n; the event's world time is γ (t' + v·x'/c²).
  const double z = number_in(outcome.out, "Z"), time = number_in(outcome.out, "timeInCameraFrame");
  EXPECT_NEAR(time, 0.25 - z / 5.0, 1e-6);
  const double along = z * std::cos(number_in(outcome.out, "angleFromCameraVelocity") * degree);
  EXPECT_NEAR(number_in(outcome.out, "emissionTime"), 1.25 * (time + 3.0 / 25.0 * along), 1e-5);
  render_wall({"--aov", "all", "-D", "effects.light_delay=false"}, "velocity = [0, 0, 3]\ntime = 0.25\n");
  EXPECT_EQ(number_in(run({"probe", "wall.exr", "33,4", "--json"}).out, "timeInCameraFrame"), 0.25);
  EXPECT_NE(run({"probe", "wall.exr", "33,4"}).out.find("0.25 s by the camera's clock"), std::string::npos);
  render_wall({"-q"});
  EXPECT_NE(run({"probe", "wall.exr", "3,4", "--json"}).out.find("\"timeInCameraFrame\":null"),
            std::string::npos);
}

TEST_F(Probe, AnglesAreThoseOfPixelCentres) {
  render_wall({"--aov", "objectId"}, "fov = 90\nvelocity = [0, 0, 3]\n");
  const Outcome outcome = run({"probe", "wall.exr", "39,10", "20,9", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  // x = 19.5/20, y = -0.5/20 of tan 45 degrees.
  const double angle = std::atan(std::hypot(0.975, 0.025)) / degree;
  EXPECT_NEAR(number_in(outcome.out, "angleFromViewAxis"), angle, 1e-5);
  EXPECT_NEAR(number_in(outcome.out, "angleFromCameraVelocity"), angle, 1e-5);
  const std::string second = outcome.out.substr(outcome.out.find('\n') + 1);
  EXPECT_NE(second.find("\"pixel\":[20,9]"), std::string::npos) << second;
  EXPECT_NEAR(number_in(second, "angleFromViewAxis"), std::atan(std::hypot(0.025, 0.025)) / degree, 1e-5);
}

TEST_F(Probe, TellsItInWords) {
  render_wall({"--aov", "objectId,doppler,Z"});
  const Outcome outcome = run({"probe", "wall.exr", "20,10"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words : {"wall.exr: pixel 20,10\n", "wall (object 1 of the scene)",
                            "redshift: 550 nm arrive as ", "it moves at 0.6 c against the camera",
                            "emissionTime,properTime,P,N  (render with --aov emissionTime,properTime,P,N)"}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << " in\n" << outcome.out;
  }
}

TEST_F(Probe, KnowsTheSkyAndMatterInMotion) {
  write("wheel.toml",
        "[film]\nresolution = [40, 20]\n[camera]\nposition = [0, 0, -10]\nfov = 40\n[background]\ncolor = "
        "[0, 0, 1]\n"
        "[[object]]\nshape = \"cylinder\"\nradius = 1\nheight = 1\nrotate = [90, 0, \"30*t\"]\nmaterial = { "
        "color "
        "= [1, 1, 1] }\n");
  const Outcome made = run({"wheel.toml", "-q", "--aov", "objectId,Z,doppler"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Outcome outcome = run({"probe", "wheel.exr", "20,10", "0,0"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* words : {"object 1 of the scene, which has no name",
                            "not one: its matter turns or accelerates", "none: the ray meets no surface"}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << " in\n" << outcome.out;
  }
}

TEST_F(Probe, SaysWhatIsNotThere) {
  render_wall({"--crop", "10,5,30,15"});
  const auto expect = [this](int code, const std::vector<std::string>& arguments, const std::string& words) {
    std::vector<std::string> all{"probe"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, code) << words;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  EXPECT_EQ(run({"probe", "wall.exr", "10,5"}).code, 0);
  EXPECT_EQ(run({"probe", "wall.exr", "29,14"}).code, 0);
  const std::string crop = "is not in this crop, which has x from 10 to 29, y from 5 to 14";
  expect(2, {"wall.exr", "30,14"}, "wall.exr: pixel 30,14 " + crop);
  expect(2, {"wall.exr", "9,5"}, "wall.exr: pixel 9,5 " + crop);
  expect(2, {"wall.exr", "40,5"}, "wall.exr: pixel 40,5 is outside of the image");
  expect(2, {"wall.exr"}, "no pixel is given");
  expect(2, {"wall.exr", "3.5,4"}, "expected a pixel X,Y in whole numbers, such as 320,180, not '3.5,4'");
  expect(4, {"none.exr", "3,4"}, "cannot read none.exr: No such file or directory");
  expect(4, {"wall.exr", "10,5", "--eye", "right"}, "wall.exr has one view only, no right eye");
  write("text.exr", "no image");
  expect(4, {"text.exr", "0,0"}, "text.exr");
}

TEST_F(Probe, ReadsTheEyeThatIsAskedFor) {
  render_wall({"--aov", "Z,doppler"}, "stereo = { separation = 1 }\n");
  const Outcome left = run({"probe", "wall.exr", "20,10", "--json"});
  const Outcome right = run({"probe", "wall.exr", "20,10", "--json", "--eye", "right"});
  ASSERT_EQ(left.code, 0) << left.err;
  ASSERT_EQ(right.code, 0) << right.err;
  for (const Outcome* outcome : {&left, &right}) {
    EXPECT_EQ(outcome->out.find("left"), std::string::npos) << outcome->out;
    EXPECT_NEAR(number_in(outcome->out, "Z"), 9.0, 0.01);
  }
}

TEST_F(Probe, DoesNotTakeAPartialImageForAWholeOne) {
  ImageLayout layout;
  layout.display = layout.data = {0, 0, 2, 1};
  for (const char* name : {"R", "G", "B", "rendered.V"})
    layout.channels.push_back({name, ChannelPrecision::single});
  Image image(layout);
  image.at(3, 0, 0) = 1.0F;
  ASSERT_TRUE(write_exr(folder / "work" / "a.partial.exr", image, {}).ok());
  EXPECT_EQ(run({"probe", "a.partial.exr", "0,0"}).code, 0);
  const Outcome outcome = run({"probe", "a.partial.exr", "1,0", "0,0"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("pixel 1,0 is not rendered yet in this partial image"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.out.find("pixel 0,0"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace backlight::test
