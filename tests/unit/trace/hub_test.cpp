#include "backlight/trace/hub.h"

#include <gtest/gtest.h>

#include <cmath>

#include "backlight/trace/visibility.h"

namespace backlight {
namespace {

SceneFrame frame_of(const Vec3& celerity, const Vec3& origin, double radius) {
  SceneFrame frame;
  frame.motion = {ExtendedVec3{celerity}, {Extended(0.0), ExtendedVec3{origin}}};
  SurfaceSet surfaces;
  if (radius > 0.0) surfaces.add(sphere(radius), Placement{});
  surfaces.build();
  frame.object_of_surface = std::vector<int>(surfaces.size(), 0);
  frame.surfaces = std::make_shared<const SurfaceSet>(std::move(surfaces));
  return frame;
}

Scene two_spheres() {
  Scene scene;
  scene.frames.push_back(frame_of({0, 0, 0}, {0, 0, 0}, 0.0));
  scene.frames.push_back(frame_of({0, 0, 1.5}, {0, 0, 10}, 1.0));
  scene.frames.push_back(frame_of({0, 0, 0}, {0, 0, 20}, 1.0));
  return scene;
}

TEST(Hub, KnowsWhichFramesHaveSurfaces) {
  const Scene scene = two_spheres();
  const Hub hub = make_hub(scene);
  EXPECT_EQ(hub.occupied, (std::vector<int>{1, 2}));
}

TEST(Hub, HasTheCameraEventInEachFrame) {
  Scene scene = two_spheres();
  scene.camera.event = {Extended(2.0), ExtendedVec3{Vec3{1.0, 0.0, 10.0}}};
  const Hub hub = make_hub(scene);
  const double gamma = std::sqrt(1.0 + 1.5 * 1.5);
  EXPECT_DOUBLE_EQ(hub.frames[1].camera_event.t, 2.0 * gamma);
  EXPECT_DOUBLE_EQ(hub.frames[1].camera_event.x.x, 1.0);
  EXPECT_DOUBLE_EQ(hub.frames[1].camera_event.x.z, -3.0);
  EXPECT_DOUBLE_EQ(hub.frames[2].camera_event.x.z, -10.0);
}

// What nothing moves against needs no boost: the transformation hands its argument on, to the bit.
TEST(Hub, BoostsNothingWhereNothingMoves) {
  for (const Vec3& celerity : {Vec3{0.0}, Vec3{0.3, -2.0, 1.1}}) {  // at rest, and all with one velocity
    Scene scene;
    for (int i = 0; i < 3; ++i) scene.frames.push_back(frame_of(celerity, {0.0, 0.0, 5.0 * i}, 1.0));
    scene.camera.celerity = ExtendedVec3{celerity};
    scene.lights.resize(2);
    scene.lights[1].kind = LightKind::distant;
    const Hub hub = make_hub(scene);
    for (const FrameView& frame : hub.frames) EXPECT_TRUE(frame.from_camera.is_identity());
    for (const LightView& light : hub.lights) {
      for (const auto& to_frame : light.to_frame) EXPECT_TRUE(to_frame.is_identity());
    }
    EXPECT_TRUE(hub.camera_from_sky.is_identity());
    const NullDirection<Camera> n{{0.1, 0.7, -0.4}, 0.8124038404635961};
    const NullDirection<Rest> same = hub.frames[1].from_camera(n);
    EXPECT_EQ(same.x, n.x);
    EXPECT_EQ(same.length, n.length);
  }
  Scene moving = two_spheres();
  moving.lights.resize(1);
  EXPECT_FALSE(make_hub(moving).frames[1].from_camera.is_identity());
  EXPECT_FALSE(make_hub(moving).lights[0].to_frame[1].is_identity());
}

TEST(FirstHit, IsTheSmallestLambdaOverFrames) {
  const Scene scene = two_spheres();
  const Hub hub = make_hub(scene);
  RayInFrames rays(hub);
  CameraRay ray;
  rays.start(ray);
  const FirstHit hit = first_hit(hub, rays);
  ASSERT_TRUE(hit.found());
  EXPECT_EQ(hit.frame, 1);
  // The receding sphere's near pole, z = -1 in its frame, was on the past light cone when it stood at
  // z = 10 - 1/γ + v t with t = -z: z = (10 - 1/γ)/(1 + v).
  const double gamma = std::sqrt(1.0 + 1.5 * 1.5);
  const double v = 1.5 / gamma;
  EXPECT_NEAR(double(hit.lambda), (10.0 - 1.0 / gamma) / (1.0 + v), 1e-13);
}

TEST(FirstHit, WithoutLightDelayFindsTheContractedSphereWhereItIsNow) {
  const Scene scene = two_spheres();
  const Hub hub = make_hub(scene);
  RayInFrames rays(hub);
  CameraRay ray;
  ray.light_delay = false;
  rays.start(ray);
  const FirstHit hit = first_hit(hub, rays);
  ASSERT_EQ(hit.frame, 1);
  EXPECT_NEAR(double(hit.lambda), 10.0 - 1.0 / std::sqrt(1.0 + 1.5 * 1.5), 1e-13);
}

TEST(RayInFrames, BoostsEachFrameOnceARay) {
  const Scene scene = two_spheres();
  const Hub hub = make_hub(scene);
  RayInFrames rays(hub);
  CameraRay ray;
  rays.start(ray);
  const double toward = rays.in(1).doppler(true).value;
  EXPECT_LT(toward, 1.0);  // receding
  ray.direction = {0, 0, -1};
  EXPECT_EQ(rays.in(1).doppler(true).value, toward);  // still the old ray
  rays.start(ray);
  EXPECT_NEAR(rays.in(1).doppler(true).value * toward, 1.0, 1e-15);  // opposite directions: D and 1/D
}

}  // namespace
}  // namespace backlight
