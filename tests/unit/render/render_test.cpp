#include "backlight/render/render.h"

#include <gtest/gtest.h>

#include <limits>

namespace backlight {
namespace {

Scene empty_scene() {
  Scene scene;
  scene.frames.emplace_back();
  scene.frames[0].surfaces.build();
  scene.film = {40, 30, 4, 0, {"Z", "objectId"}};
  scene.camera.lens.width = 40;
  scene.camera.lens.height = 30;
  scene.sky.emits = true;
  scene.sky.radiance = {Spectrum::d65(), LinearRgb{1.0}};
  return scene;
}

const std::atomic<bool> go_on{false};

TEST(RenderImage, CountsItsRays) {
  const Scene scene = empty_scene();
  const auto result = render_image(scene, {.threads = 2}, go_on, nullptr);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->statistics.rays.primary, 40U * 30U * 4U);
  EXPECT_EQ(result->statistics.rays.data, 40U * 30U);
  EXPECT_EQ(result->statistics.rays.non_finite, 0U);
}

TEST(RenderImage, MakesTheChannelsThatAreAskedFor) {
  const auto result = render_image(empty_scene(), {}, go_on, nullptr);
  for (const char* name : {"R", "G", "B", "A", "Z", "objectId.V"}) {
    EXPECT_GE(result->image.find_channel(name), 0) << name;
  }
  EXPECT_EQ(result->image.channel_count(), 6U);
  EXPECT_EQ(result->image.at(0, 3, 3), 1.0F);
}

TEST(RenderImage, GivesNothingWhenItIsStopped) {
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(render_image(empty_scene(), {}, stop, nullptr));
}

TEST(RenderImage, CountsPixelsThatAreNotFinite) {
  Scene scene = empty_scene();
  scene.sky.radiance.rgb = LinearRgb{std::numeric_limits<double>::quiet_NaN()};
  const auto result = render_image(scene, {.threads = 2}, go_on, nullptr);
  EXPECT_EQ(result->statistics.rays.non_finite, 40U * 30U);
}

TEST(RenderImage, LeavesPixelsOutsideAFisheyesCircleTransparent) {
  Scene scene = empty_scene();
  scene.camera.lens.projection = Projection::fisheye;
  const auto result = render_image(scene, {}, go_on, nullptr);
  const auto alpha = static_cast<std::size_t>(result->image.find_channel("A"));
  EXPECT_EQ(result->image.at(alpha, 0, 0), 0.0F);
  EXPECT_EQ(result->image.at(alpha, 20, 15), 1.0F);
}

TEST(RenderImage, KeepsACropsDataWindow) {
  const auto result = render_image(empty_scene(), {.crop = PixelBox{5, 6, 20, 9}}, go_on, nullptr);
  EXPECT_EQ(result->image.layout().data, (PixelBox{5, 6, 20, 9}));
  EXPECT_EQ(result->image.layout().display, (PixelBox{0, 0, 40, 30}));
  EXPECT_EQ(result->statistics.rays.primary, 15U * 3U * 4U);
}

}  // namespace
}  // namespace backlight
