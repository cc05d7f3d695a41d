#include "backlight/render/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace backlight {
namespace {

Scene empty_scene() {
  Scene scene;
  scene.frames.emplace_back();
  scene.film = {40, 30, 4, 0, {"Z", "objectId"}};
  scene.camera.lens.width = 40;
  scene.camera.lens.height = 30;
  scene.sky.given = scene.sky.emits = true;
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

TEST(RenderMissing, TracesWhatIsNotDoneAndNothingElse) {
  const Scene scene = empty_scene();
  const RenderSettings settings{.threads = 2};
  const auto partial = begin_image(scene, settings);
  EXPECT_EQ(partial->view_count(), 1U);
  EXPECT_FALSE(partial->is_complete());
  EXPECT_FALSE(partial->has_any());
  ASSERT_EQ(partial->band_count(), 1U);
  RowBand& band = *partial->begin(0);
  std::ranges::fill(band.done[0], std::uint8_t{1});
  band.done[0][band.image.offset(7, 11)] = 0;
  band.missing = 1;
  const RenderStatistics statistics = render_missing(scene, settings, *partial, go_on, nullptr);
  EXPECT_EQ(statistics.rays.primary, 4U);
  EXPECT_TRUE(partial->is_complete());
  EXPECT_EQ(partial->whole().at(0, 7, 11), 1.0F);
  EXPECT_EQ(partial->whole().at(0, 8, 11), 0.0F);
}

TEST(RenderMissing, GoesOnWhereItWasStopped) {
  Scene scene = empty_scene();
  scene.camera.stereo = Stereo{};
  const RenderSettings settings{.threads = 1};
  const auto whole = render_image(scene, settings, go_on, nullptr);
  const auto partial = begin_image(scene, settings);
  ASSERT_EQ(partial->view_count(), 2U);
  RowBand& band = *partial->begin(0);
  for (std::size_t i = 0; i < band.done[1].size(); i += 3) {
    band.done[1][i] = 1;
    --band.missing;
  }
  const std::vector<std::uint8_t> left_alone = band.done[1];
  render_missing(scene, settings, *partial, go_on, nullptr);
  EXPECT_TRUE(partial->is_complete());
  const Image image = partial->whole();
  const auto right = static_cast<std::size_t>(image.find_channel("right.R"));
  for (std::size_t i = 0; i < left_alone.size(); ++i) {
    EXPECT_EQ(image.plane(right)[i], left_alone[i] != 0 ? 0.0F : whole->image.plane(right)[i]);
  }
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
