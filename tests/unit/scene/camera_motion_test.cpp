// Cameras on paths and aboard rockets: docs/physics.md, equations (18) to (21).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "backlight/scene/compile.h"
#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::all_messages;
using testing_scenes::compiled;
using testing_scenes::mistakes;

ImageRequest at(double t) {
  ImageRequest request;
  request.time = t;
  return request;
}

// How far a double-double is from a value of which 32 digits are written.
double distance(const Extended& value, double high, double low) {
  return std::abs(double(value - Extended(high) - Extended(low)));
}

TEST(CameraPath, HasTheVelocityOfItsFormulas) {
  const Scene scene =
      compiled("c = 5\n[params]\nw = 0.5\n[camera]\nposition = [\"2*sin(w*t)\", \"t^3/40\", -4]\n", at(2));
  const double vx = std::cos(1.0);
  const double vy = 3.0 * 4.0 / 40.0;
  const double gamma = 1.0 / std::sqrt(1.0 - (vx * vx + vy * vy) / 25.0);
  EXPECT_NEAR(double(scene.camera.celerity[0]), gamma * vx / 5.0, 1e-15);
  EXPECT_NEAR(double(scene.camera.celerity[1]), gamma * vy / 5.0, 1e-15);
  EXPECT_EQ(double(scene.camera.celerity[2]), 0.0);
  EXPECT_EQ(scene.camera.event.t, Extended(10.0));
  EXPECT_NEAR(double(scene.camera.event.x[0]), 2.0 * std::sin(1.0), 1e-15);
  EXPECT_EQ(double(scene.camera.event.x[2]), -4.0);
}

TEST(CameraPath, IsTheSameAsAVelocityWhereItIsStraight) {
  const Scene path = compiled("[camera]\nposition = [\"1 + 0.6*t\", 2, \"-0.3*t\"]\n", at(3));
  const Scene moving =
      compiled("[camera]\nposition = [1, 2, 0]\nvelocity = [0.6, 0, -0.3]\nworld_time = \"t\"\n", at(3));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(double(path.camera.celerity[i]), double(moving.camera.celerity[i]), 1e-15);
    EXPECT_NEAR(double(path.camera.event.x[i]), double(moving.camera.event.x[i]), 1e-15);
  }
  EXPECT_NEAR(path.camera.proper_time, moving.camera.proper_time, 1e-14);
}

TEST(CameraPath, GoesThroughParametersAndFrameNumbers) {
  const std::string animation = "[animation]\nfps = 4\nframes = [1, 9]\n";
  const std::string params = "[params]\na = \"b + 1\"\nb = \"0.25*t\"\n";
  ImageRequest request;
  request.frame = 5;
  const Scene parameter = compiled(animation + params + "[camera]\nposition = [\"a\", 0, 0]\n", request);
  EXPECT_NEAR(double(parameter.camera.celerity[0]), 0.25 / std::sqrt(1.0 - 0.0625), 1e-15);
  EXPECT_EQ(double(parameter.camera.event.x[0]), 1.25);
  const Scene frame = compiled(animation + "[camera]\nposition = [0, \"frame/16\", 0]\n", request);
  EXPECT_NEAR(double(frame.camera.celerity[1]), 0.25 / std::sqrt(1.0 - 0.0625), 1e-15);
}

TEST(CameraPath, MayBeRunThroughSlowlyOrBackwards) {
  for (const char* key : {"time", "world_time"}) {
    const Scene slow = compiled(
        "[params]\nT = \"t/10\"\n[camera]\nposition = [\"0.6*T\", 0, 0]\n" + std::string(key) + " = \"T\"\n",
        at(20));
    EXPECT_NEAR(double(slow.camera.celerity[0]), 0.75, 1e-15) << key;
    EXPECT_EQ(slow.camera.event.t, Extended(2.0));
  }
  const Scene back = compiled("[camera]\nposition = [\"-0.6*t\", 0, 0]\ntime = \"-t\"\n", at(2));
  EXPECT_NEAR(double(back.camera.celerity[0]), 0.75, 1e-15);
}

// The clock of a camera on a circle goes at 1/γ of the world's.
TEST(CameraPath, CountsItsOwnTime) {
  const Scene circle = compiled("[camera]\nposition = [\"2*cos(0.4*t)\", \"2*sin(0.4*t)\", 0]\n", at(7));
  EXPECT_NEAR(circle.camera.proper_time, 7.0 * 0.6, 1e-12);
  // x = (√(1 + g²t²) - 1)/g is uniformly accelerated: τ = asinh(gt)/g.
  const Scene rocket = compiled("[camera]\nposition = [\"(sqrt(1 + 4*t^2) - 1)/2\", 0, 0]\n", at(1.5));
  EXPECT_NEAR(rocket.camera.proper_time, std::asinh(3.0) / 2.0, 1e-12);
}

TEST(CameraPath, InAFrameIsThatFrames) {
  const std::string frame = "[frame.f]\nvelocity = [0.6, 0, 0]\norigin = [10, 0, 0]\norigin_time = 2\n";
  const Scene scene =
      compiled(frame + "[camera]\nframe = \"f\"\nposition = [\"0.5*t\", \"0.2*t\", 0]\n", at(4));
  const double gamma = 1.25;
  EXPECT_NEAR(double(scene.camera.event.t), 2.0 + gamma * (4.0 + 0.6 * 2.0), 1e-14);
  EXPECT_NEAR(double(scene.camera.event.x[0]), 10.0 + gamma * (2.0 + 0.6 * 4.0), 1e-14);
  // Einstein's addition of velocities.
  const Vec3 u = scene.camera.celerity.rounded();
  const double world_gamma = std::sqrt(1.0 + glm::dot(u, u));
  EXPECT_NEAR(u.x / world_gamma, (0.5 + 0.6) / (1.0 + 0.3), 1e-14);
  EXPECT_NEAR(u.y / world_gamma, 0.2 / (gamma * 1.3), 1e-14);
  // By the world's time the path is run through otherwise, and is the same.
  const Scene by_world =
      compiled(frame + "[params]\nW = \"2 + 1.25*(T + 0.3*T)\"\nT = \"t\"\n[camera]\n" +
                   "frame = \"f\"\nposition = [\"0.5*T\", \"0.2*T\", 0]\nworld_time = \"W\"\n",
               at(4));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(double(by_world.camera.celerity[i]), double(scene.camera.celerity[i]), 1e-14);
    EXPECT_NEAR(double(by_world.camera.event.x[i]), double(scene.camera.event.x[i]), 1e-13);
  }
}

TEST(CameraPath, IsNotDerivedWhereAVelocityIsGiven) {
  const Scene still = compiled("[camera]\nposition = [\"3*t\", 0, 0]\nvelocity = [0, 0, 0]\n", at(2));
  EXPECT_EQ(still.camera.celerity, ExtendedVec3{});
  EXPECT_EQ(double(still.camera.event.x[0]), 6.0);
  EXPECT_EQ(still.camera.event.t, Extended(2.0));
}

TEST(CameraPath, TooFastIsToldWithTheInstant) {
  const std::string scene = "c = 2\n[camera]\nposition = [\"t^2\", 0, 0]\n";
  EXPECT_EQ(mistakes(scene, at(0.9)), "");
  const std::string text = mistakes(scene, at(1.5));
  EXPECT_NE(text.find("test.toml:3:"), std::string::npos) << text;
  EXPECT_NE(text.find("|velocity| = 3 at t = 1.5, which is not below the speed of light, c = 2"),
            std::string::npos)
      << text;
  EXPECT_NE(mistakes("[camera]\nposition = [\"t\", 0, 0]\n", at(0.0)).find("|velocity| = 1 at t = 0"),
            std::string::npos);
  // Another place at the same time.
  EXPECT_NE(mistakes("[camera]\nposition = [\"t\", 0, 0]\ntime = 3\n", at(0.0)).find("infinite"),
            std::string::npos);
  EXPECT_NE(mistakes("[camera]\nposition = [\"sqrt(t)\", 0, 0]\n", at(0.0)).find("infinite"),
            std::string::npos);
}

std::string between_images(const std::string& scene) {
  const ReadResult read = read_scene_text(scene, "test.toml");
  Diagnostics diagnostics;
  check_camera_path(*read.description, {}, diagnostics);
  return all_messages(diagnostics);
}

TEST(CameraPath, IsCheckedBetweenTheImagesToo) {
  // At the whole seconds sin² has no slope; it has up to 3.14 in between, and passes 1 at asin(1/π)/2π.
  const std::string scene =
      "[animation]\nfps = 1\nframes = [1, 5]\n[camera]\nposition = [\"sin(pi*t)^2\", 0, 0]\n";
  ImageRequest request;
  for (int frame = 1; frame <= 5; ++frame) {
    request.frame = frame;
    EXPECT_EQ(mistakes(scene, request), "");
  }
  const std::string text = between_images(scene);
  const std::size_t place = text.find("at t = ");
  ASSERT_NE(place, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(place + 7)), std::asin(1.0 / std::numbers::pi) / (2.0 * std::numbers::pi),
              1e-12);
  EXPECT_EQ(between_images("[animation]\nframes = [1, 5]\n[camera]\nposition = [\"sin(t)/2\", 0, 0]\n"), "");
}

// Against 50 digits.
TEST(CameraRocket, MovesHyperbolically) {
  const std::string scene =
      "c = 299792458\n[camera]\nrocket = { acceleration = 9.81, along = [0, 0, 2] }\ntime = \"t\"\n";
  const Scene soon = compiled(scene, at(1));
  EXPECT_NEAR(double(soon.camera.event.x[2]) / 4.905000000000000686, 1.0, 1e-15);
  EXPECT_NEAR(double(soon.camera.celerity[2]) / 3.2722637738938723562e-8, 1.0, 1e-15);
  EXPECT_EQ(double(soon.camera.celerity[0]), 0.0);
  const Scene late = compiled(scene, at(315576000));  // ten years aboard
  EXPECT_NEAR(double(late.camera.event.t) / 299792458.0 / 466503172772.741612, 1.0, 1e-15);
  EXPECT_NEAR(double(late.camera.event.x[2]) / 139844971507803479812.0, 1.0, 1e-15);
  EXPECT_NEAR(double(late.camera.celerity[2]) / 15265.2143267079635808, 1.0, 1e-15);
  EXPECT_EQ(late.camera.proper_time, 299792458.0 * 315576000.0);
}

TEST(CameraRocket, KeepsMoreDigitsThanADoubleHas) {
  const Scene scene = compiled("[camera]\nrocket = { acceleration = 1, along = [1, 0, 0] }\ntime = 20\n");
  // sinh 20 = 242582597.70489514 and cosh 20 = 242582597.70489514 + e^-20 differ in their 18th digit.
  const Extended difference = lorentz_factor(scene.camera.celerity) - scene.camera.celerity[0];
  EXPECT_NEAR(double(difference) / std::exp(-20.0), 1.0, 1e-10);
  EXPECT_LT(distance(scene.camera.event.t, 242582597.70489514, 0.0), 3e-8);
}

// Against 50 digits: hyperbolic in the frame in which it begins, and the thrust is oblique to its velocity.
TEST(CameraRocket, BeginsWithItsVelocity) {
  const std::string camera =
      "[camera]\nposition = [1, 2, 3]\nvelocity = [0.547722557505166, 0.182574185835055, "
      "-0.365148371670111]\n"
      "rocket = { acceleration = 0.5, along = [1, 2, 2] }\n";
  for (const char* when : {"time = 3\n", "world_time = 6.056673546479241\n"}) {
    const Scene scene = compiled(camera + when);
    EXPECT_NEAR(double(scene.camera.event.t), 6.0566735464792409, 2e-14) << when;
    EXPECT_NEAR(double(scene.camera.event.x[0]), 5.1668760953609304, 2e-14);
    EXPECT_NEAR(double(scene.camera.event.x[1]), 4.8916360487239183, 2e-14);
    EXPECT_NEAR(double(scene.camera.event.x[2]), 2.6263663635251527, 2e-14);
    EXPECT_NEAR(double(scene.camera.celerity[0]), 2.5302353524312698, 2e-14);
    EXPECT_NEAR(double(scene.camera.celerity[1]), 2.0263448147519886, 2e-14);
    EXPECT_NEAR(double(scene.camera.celerity[2]), 0.2058692806856579, 2e-14);
    EXPECT_NEAR(scene.camera.proper_time, 3.0, 1e-14);
  }
}

TEST(CameraRocket, GoesByTheWorldsClockToo) {
  for (const double t : {-1e6, -3.0, 0.0, 1e-9, 5.0, 1e8}) {
    const Scene scene =
        compiled("[camera]\nrocket = { acceleration = 2, along = [0, 1, 0] }\nworld_time = \"t\"\n", at(t));
    EXPECT_NEAR(double(scene.camera.event.t), t, 1e-15 * std::abs(t));
    EXPECT_NEAR(double(scene.camera.celerity[1]), 2.0 * t, 1e-14 * std::abs(t));
    EXPECT_NEAR(scene.camera.proper_time, std::asinh(2.0 * t) / 2.0, 1e-14);
  }
}

TEST(CameraRocket, SaysWhatIsMissing) {
  EXPECT_NE(mistakes("[camera]\nrocket = { acceleration = 1 }\n").find("along"), std::string::npos);
  EXPECT_NE(mistakes("[camera]\nrocket = { acceleration = 0, along = [1, 0, 0] }\n").find("greater than 0"),
            std::string::npos);
  EXPECT_NE(mistakes("[camera]\nrocket = { acceleration = 1, along = [0, 0, 0] }\n").find("is zero"),
            std::string::npos);
  EXPECT_NE(
      mistakes("[camera]\nrocket = { acceleration = 1, along = [1, 0, 0] }\ntime = 1e9\n").find("too much"),
      std::string::npos);
}

}  // namespace
}  // namespace backlight
