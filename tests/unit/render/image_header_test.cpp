#include "backlight/render/image_header.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace backlight {
namespace {

TEST(ImageHeader, WritesEffectsAsInASceneFile) {
  Effects effects;
  EXPECT_EQ(effects_text(effects), "light_delay = true, doppler = true, searchlight = \"exact\"");
  effects.brightness.arrival_rate = ArrivalRate::dilation;
  effects.doppler = false;
  EXPECT_EQ(effects_text(effects), "light_delay = true, doppler = false, searchlight = \"paper\"");
  effects.brightness = {false, ArrivalRate::off, false};
  effects.light_delay = false;
  EXPECT_EQ(effects_text(effects), "light_delay = false, doppler = false, searchlight = \"off\"");
  effects.brightness = {true, ArrivalRate::off, false};
  EXPECT_EQ(effects_text(effects),
            "light_delay = false, doppler = false, energy = true, rate = \"off\", solid_angle = false");
}

TEST(ImageHeader, SaysHowTheImageWasMade) {
  Scene scene;
  scene.c = 5.0;
  scene.frame = 3.0;
  scene.time = 0.08;
  scene.camera.name = "driver";
  scene.camera.celerity = ExtendedVec3(Vec3{0.0, 0.0, 4.0 / 3.0});  // v = 0.8 c, γ = 5/3
  scene.camera.proper_time = 10.0;                                  // times c
  scene.film.samples = 16;
  scene.film.seed = 4294967295U;
  scene.regions.push_back({0.25, 0.5, 0.75, 1.0, {}});
  const ExrHeader header =
      image_header(scene, 24, {"Backlight 1.2.3", "tram.toml", "abc", {"camera.fov=40"}}, 1700000000);
  EXPECT_EQ(header.software, "Backlight 1.2.3");
  EXPECT_EQ(header.creation_time, 1700000000);
  EXPECT_EQ(*header.find<std::string>("backlight/scene"), "tram.toml");
  EXPECT_EQ(*header.find<std::string>("backlight/sceneSha256"), "abc");
  EXPECT_EQ(*header.find<std::vector<std::string>>("backlight/overrides"),
            std::vector<std::string>{"camera.fov=40"});
  EXPECT_EQ(*header.find<double>("backlight/frame"), 3.0);
  EXPECT_EQ(*header.find<double>("backlight/time"), 0.08);
  EXPECT_EQ(*header.find<std::string>("backlight/camera"), "driver");
  const double ulps = 4 * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(header.find<Vec3>("backlight/cameraVelocity")->z, 4.0, 4.0 * ulps);
  EXPECT_NEAR(header.find<Vec3>("backlight/cameraCelerity")->z, 20.0 / 3.0, 7.0 * ulps);
  EXPECT_EQ(*header.find<double>("backlight/cameraTime"), 2.0);
  EXPECT_EQ(*header.find<double>("backlight/c"), 5.0);
  EXPECT_EQ(*header.find<std::int32_t>("backlight/samples"), 16);
  EXPECT_EQ(*header.find<std::int32_t>("backlight/wavelengths"), 24);
  EXPECT_EQ(*header.find<double>("backlight/seed"), 4294967295.0);
  EXPECT_EQ(*header.find<std::int32_t>("backlight/complete"), 1);
  EXPECT_EQ(*header.find<std::vector<std::string>>("backlight/effectsRegions"),
            std::vector<std::string>{
                "rect = [0.25, 0.5, 0.75, 1], light_delay = true, doppler = true, searchlight = \"exact\""});
}

TEST(ImageHeader, LeavesOutWhatIsNotThere) {
  const ExrHeader header = image_header(Scene{}, 0, {"Backlight", "a.toml", "abc", {}}, std::nullopt);
  EXPECT_FALSE(header.creation_time.has_value());
  EXPECT_EQ(header.find<std::vector<std::string>>("backlight/overrides"), nullptr);
  EXPECT_EQ(header.find<std::string>("backlight/camera"), nullptr);
  EXPECT_EQ(header.find<std::vector<std::string>>("backlight/effectsRegions"), nullptr);
  EXPECT_EQ(header.find<double>("backlight/tolerance"), nullptr);
}

TEST(ImageHeader, SaysWhichErrorWasAskedForInsteadOfANumberOfSamples) {
  Scene scene;
  scene.film.tolerance = 0.01;
  scene.film.adaptive = true;
  const ExrHeader header = image_header(scene, 12, {"Backlight", "a.toml", "abc", {}}, std::nullopt);
  EXPECT_EQ(*header.find<double>("backlight/tolerance"), 0.01);
  EXPECT_EQ(header.find<std::int32_t>("backlight/samples"), nullptr);
}

Scene scene_of_objects(const std::vector<Vec3>& celerities) {
  Scene scene;
  std::vector<Object> objects;
  for (const Vec3& celerity : celerities) {
    SceneFrame frame;
    frame.motion.celerity = ExtendedVec3(celerity);
    auto surfaces = std::make_shared<SurfaceSet>();
    surfaces->add(sphere(1.0), {});
    surfaces->build();
    frame.surfaces = surfaces;
    const int number = static_cast<int>(objects.size());
    frame.object_of_surface = std::vector<int>{number};
    scene.frames.push_back(std::move(frame));
    objects.push_back({number == 1 ? "" : "ball " + std::to_string(number + 1), number + 1, 0, {}});
  }
  scene.objects = std::move(objects);
  scene.c = 5.0;
  return scene;
}

TEST(ImageHeader, NamesTheObjectsWhereTheirNumbersAre) {
  // As seen by a camera of 0.8 c, whose own velocity the last one shares.
  Scene scene = scene_of_objects({Vec3{0.0}, Vec3{0.0}, {0.0, 0.0, 4.0 / 3.0}});
  scene.camera.celerity = ExtendedVec3(Vec3{0.0, 0.0, 4.0 / 3.0});
  const ImageOrigin origin{"Backlight", "a.toml", "abc", {}};
  EXPECT_EQ(image_header(scene, 0, origin, std::nullopt).find<std::vector<std::string>>("backlight/objects"),
            nullptr);
  scene.film.aovs = {"objectId"};
  const ExrHeader header = image_header(scene, 0, origin, std::nullopt);
  EXPECT_EQ(*header.find<std::vector<std::string>>("backlight/objects"),
            (std::vector<std::string>{"ball 1", "", "ball 3"}));
  EXPECT_EQ(*header.find<std::vector<std::string>>("backlight/objectVelocities"),
            (std::vector<std::string>{"1 2 0 0 -4", "3 3 0 0 0"}));
}

TEST(ImageHeader, TellsTheLens) {
  Scene scene;
  scene.camera.lens.fov = std::numbers::pi / 3.0;
  const ImageOrigin origin{"Backlight", "a.toml", "abc", {}};
  const ExrHeader perspective = image_header(scene, 0, origin, std::nullopt);
  EXPECT_EQ(*perspective.find<std::string>("backlight/projection"), "perspective");
  EXPECT_DOUBLE_EQ(*perspective.find<double>("backlight/fov"), 60.0);
  scene.camera.lens.projection = Projection::mercator;
  EXPECT_EQ(image_header(scene, 0, origin, std::nullopt).find<double>("backlight/fov"), nullptr);
}

}  // namespace
}  // namespace backlight
