#include "backlight/trace/trace_strategy.h"

#include <gtest/gtest.h>

namespace backlight {
namespace {

// Spheres, one to a frame, and all at rest in the last.
Scene spheres(int moving, int resting) {
  Scene scene;
  const auto add_frame = [&scene](double celerity, int count) {
    SceneFrame frame;
    frame.motion.celerity = ExtendedVec3{Vec3{celerity, 0.0, 0.0}};
    SurfaceSet surfaces;
    for (int i = 0; i < count; ++i) surfaces.add(sphere(1.0), Placement{});
    surfaces.build();
    frame.object_of_surface = std::vector<int>(surfaces.size(), 0);
    frame.surfaces = std::make_shared<const SurfaceSet>(std::move(surfaces));
    scene.frames.push_back(std::move(frame));
  };
  add_frame(0.0, resting);
  for (int i = 0; i < moving; ++i) add_frame(0.01 * (i + 1), 1);
  return scene;
}

TEST(TraceStrategy, CountsWhatEachLightHasToAsk) {
  Scene scene = spheres(10, 3);
  scene.lights.resize(3);
  scene.lights[1].kind = LightKind::distant;
  scene.lights[2].kind = LightKind::ambient;
  const TraceStrategy strategy = trace_strategy(scene);
  ASSERT_EQ(strategy.shadows.size(), 3u);
  EXPECT_EQ(in_words(strategy.camera), "camera-sky cones per tile: 13 surfaces");
  EXPECT_EQ(in_words(strategy.shadows[0]), "light-sky cones per sheet: 13 surfaces");
  EXPECT_EQ(in_words(strategy.shadows[1]), "shadow cylinders per sheet: 13 surfaces");
  EXPECT_EQ(in_words(strategy.shadows[2]), "none");
}

TEST(TraceStrategy, TakesOneTreeForManySurfacesOfAFrame) {
  Scene scene = spheres(60, 100);
  scene.lights.resize(1);
  EXPECT_EQ(in_words(trace_strategy(scene).shadows[0]),
            "light-sky cones per tile: 60 surfaces, 1 tree of a frame");
}

TEST(TraceStrategy, SortsShadowRaysForManyThatMove) {
  Scene scene = spheres(1500, 0);
  scene.lights.resize(1);
  EXPECT_EQ(in_words(trace_strategy(scene).shadows[0]), "light-sky cones per sorted packet: 1500 surfaces");
}

TEST(TraceStrategy, GoesRayByRayWhereEveryRayHasItsOwnEye) {
  Scene scene = spheres(2, 1);
  scene.camera.stereo.emplace();
  scene.camera.lens.projection = Projection::equirectangular;
  EXPECT_EQ(trace_strategy(scene).rays, "one ray at a time");
}

}  // namespace
}  // namespace backlight
