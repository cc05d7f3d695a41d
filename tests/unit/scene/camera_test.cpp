// The exposure: where and when, by the rules of the scene reference's [camera].
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "backlight/scene/compile.h"
#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::compiled;
using testing_scenes::mistakes;

const std::string moving_frame = "[frame.f]\nvelocity = [3, 0, 0]\norigin = [10, 0, 0]\norigin_time = 2\n";

TEST(Camera, AtRestIsAtItsPositionAndTime) {
  const Scene scene = compiled("c = 5\n[camera]\nposition = [1, 2, 3]\ntime = 0.25\n");
  EXPECT_EQ(scene.camera.event.t, Extended(1.25));
  EXPECT_EQ(scene.camera.event.x.rounded(), (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.camera.proper_time, 1.25);
  EXPECT_EQ(scene.camera.celerity, ExtendedVec3{});
}

TEST(Camera, TimeIsThatOfTheSceneByDefault) {
  ImageRequest request;
  request.time = 0.5;
  EXPECT_EQ(compiled("c = 5\n[camera]\n", request).camera.event.t, Extended(2.5));
}

// β = 0.6, γ = 1.25, c = 5.
TEST(Camera, WithAVelocityItsTimeIsItsOwn) {
  const Scene scene = compiled("c = 5\n[camera]\nposition = [1, 2, 3]\nvelocity = [3, 0, 0]\ntime = 2\n");
  EXPECT_NEAR(double(scene.camera.event.t), 12.5, 1e-14);    // γ c τ
  EXPECT_NEAR(double(scene.camera.event.x[0]), 8.5, 1e-14);  // 1 + γβ c τ
  EXPECT_EQ(double(scene.camera.event.x[1]), 2.0);
  EXPECT_EQ(scene.camera.proper_time, 10.0);
}

TEST(Camera, WorldTimeIsTheWorlds) {
  const Scene scene =
      compiled("c = 5\n[camera]\nposition = [1, 2, 3]\nvelocity = [3, 0, 0]\nworld_time = 2.5\n");
  EXPECT_EQ(scene.camera.event.t, Extended(12.5));
  EXPECT_NEAR(double(scene.camera.event.x[0]), 8.5, 1e-14);
  EXPECT_NEAR(scene.camera.proper_time, 10.0, 1e-14);
}

TEST(Camera, WithAFrameItsPositionAndTimeAreTheFrames) {
  const Scene scene =
      compiled("c = 5\n[camera]\nposition = [2, 1, 0]\nframe = \"f\"\ntime = 1\n" + moving_frame);
  // t = c·2 + γ(c·1 + β·2), x = 10 + γ(2 + β c·1).
  EXPECT_NEAR(double(scene.camera.event.t), 10.0 + 1.25 * (5.0 + 0.6 * 2.0), 1e-14);
  EXPECT_NEAR(double(scene.camera.event.x[0]), 10.0 + 1.25 * (2.0 + 0.6 * 5.0), 1e-14);
  EXPECT_EQ(double(scene.camera.event.x[1]), 1.0);
  EXPECT_EQ(scene.camera.proper_time, 5.0);
  EXPECT_NEAR(double(scene.camera.celerity[0]), 0.75, 1e-16);
}

TEST(Camera, WithAFrameAndWorldTime) {
  const std::string text =
      "c = 5\n[camera]\nposition = [2, 1, 0]\nframe = \"f\"\nworld_time = 3.55\n" + moving_frame;
  const Scene scene = compiled(text);
  EXPECT_EQ(scene.camera.event.t, Extended(5.0) * Extended(3.55));
  EXPECT_NEAR(scene.camera.proper_time, 5.0, 1e-13);
  EXPECT_NEAR(double(scene.camera.event.x[0]), 10.0 + 1.25 * (2.0 + 0.6 * 5.0), 1e-13);
}

TEST(Camera, ZeroVelocityIsRestBitForBit) {
  const std::string rest = "[camera]\nposition = [0.1, 0.2, 0.3]\ntime = 0.7\n";
  const CameraView a = compiled(rest).camera;
  const CameraView b = compiled(rest + "velocity = [0, 0, 0]\n").camera;
  EXPECT_EQ(a.event, b.event);
  EXPECT_EQ(a.celerity, b.celerity);
  EXPECT_EQ(a.proper_time, b.proper_time);
}

TEST(Camera, LooksFromItsPositionAsWritten) {
  const Scene scene =
      compiled("[camera]\nposition = [1, 2, 3]\nlook_at = [1, 2, 8]\nvelocity = [0.5, 0, 0]\n");
  EXPECT_EQ(scene.camera.lens.forward, (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.camera.lens.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(scene.camera.lens.right, (Vec3{-1, 0, 0}));
}

TEST(Camera, LooksAlongZByDefault) {
  const Scene scene = compiled("[camera]\n");
  EXPECT_EQ(scene.camera.lens.forward, (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.camera.lens.fov, 60.0 * (std::numbers::pi / 180.0));
  EXPECT_EQ(scene.camera.lens.projection, Projection::perspective);
  EXPECT_EQ(scene.camera.lens.width, 720);
  EXPECT_EQ(scene.camera.lens.height, 526);
  EXPECT_FALSE(scene.camera.stereo.has_value());
}

TEST(Camera, Projections) {
  EXPECT_EQ(compiled("[camera]\nprojection = \"mercator\"\n").camera.lens.projection, Projection::mercator);
  EXPECT_EQ(compiled("[camera]\nprojection = \"fisheye\"\nfov = 360\n").camera.lens.projection,
            Projection::fisheye);
  EXPECT_EQ(compiled("[camera]\nprojection = \"equirectangular\"\n").camera.lens.projection,
            Projection::equirectangular);
}

TEST(Camera, Stereo) {
  EXPECT_EQ(compiled("[camera]\nstereo = { separation = 0.1 }\n").camera.stereo->separation, 0.1);
  EXPECT_EQ(compiled("[camera]\nstereo = {}\n").camera.stereo->separation, 0.065);
}

TEST(Camera, IsChosenByName) {
  const std::string two =
      "[[camera]]\nname = \"left\"\nposition = [1, 0, 0]\n[[camera]]\nname = \"right\"\nposition = [2, 0, "
      "0]\n";
  EXPECT_EQ(compiled(two).camera.event.x.rounded().x, 1.0);
  ImageRequest request;
  request.camera = "right";
  EXPECT_EQ(compiled(two, request).camera.event.x.rounded().x, 2.0);
  EXPECT_EQ(compiled(two, request).camera.name, "right");
  request.camera = "middle";
  EXPECT_EQ(mistakes(two, request), "error: there is no camera 'middle'\n  the cameras are left and right\n");
}

}  // namespace
}  // namespace backlight
