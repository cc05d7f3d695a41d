// Rendered pixels against values computed with 60 digits by another program (tests/oracle).
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

using nlohmann::json;

std::vector<std::string> value_files() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(BACKLIGHT_SOURCE_DIR) /
                                                               "tests/analytic/values")) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// A quantity is compared where the pixel's own direction determines it: where moving that direction by 1e-16
// changes it by less than 1e-8 of itself.
constexpr double well_conditioned = 1e-8;

void compare_scalar(const json& pixel, const char* key, double value, Worst& worst,
                    const std::string& place) {
  if (pixel["condition"][key].get<double>() > well_conditioned) return;
  const double exact = pixel[key].get<double>();
  worst.take(exact == value ? 0.0 : std::abs(value - exact) / std::abs(exact), place + key);
}

void compare_vector(const json& pixel, const char* key, const Vec3& value, Worst& worst,
                    const std::string& place) {
  if (pixel["condition"][key].get<double>() > well_conditioned) return;
  const Vec3 exact{pixel[key][0].get<double>(), pixel[key][1].get<double>(), pixel[key][2].get<double>()};
  const double length = glm::length(exact);
  worst.take(length == 0.0 ? glm::length(value) : glm::length(value - exact) / length, place + key);
}

json read(const std::string& name) {
  std::ifstream stream(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / "tests/analytic/values" /
                       (name + ".json"));
  return json::parse(stream);
}

Rendering rendering_of(const json& values, std::optional<PixelBox> crop = {}) {
  RenderChoices choices;
  choices.overrides = {
      "film.samples=1",
      R"(film.aovs=["Z","doppler","emissionTime","properTime","P","N","objectId","mirror"])"};
  choices.crop = crop;
  if (values.contains("frame")) choices.frame = values["frame"].get<int>();
  return render_file("tests/oracle/scenes/" + values["scene"].get<std::string>(), choices);
}

class SixtyDigits : public testing::TestWithParam<std::string> {};

TEST_P(SixtyDigits, Agree) {
  const json values = read(GetParam());
  const Rendering r = rendering_of(values);

  Worst data;
  Worst colour;
  for (const json& pixel : values["pixels"]) {
    if (pixel["edge"].get<bool>()) continue;
    const int x = pixel["pixel"][0];
    const int y = pixel["pixel"][1];
    const std::string place = std::to_string(x) + "," + std::to_string(y) + " ";
    const int id = pixel["objectId"].get<int>();
    ASSERT_EQ(r.id(x, y), id) << "at " << place;
    if (pixel.contains("RGB") && pixel["condition"].contains("RGB")) {
      compare_vector(pixel, "RGB", r.rgb(x, y), colour, place);
    }
    if (id == 0) continue;
    compare_scalar(pixel, "Z", r.at("Z", x, y), data, place);
    compare_scalar(pixel, "doppler", r.at("doppler.D", x, y), data, place);
    compare_scalar(pixel, "emissionTime", r.at("emissionTime.T", x, y), data, place);
    compare_scalar(pixel, "properTime", r.at("properTime.T", x, y), data, place);
    compare_vector(pixel, "P", r.position(x, y), data, place);
    compare_vector(pixel, "N", r.normal(x, y), data, place);
    constexpr std::pair<const char*, const char*> in_mirrors[] = {
        {"mirrorZ", "mirror.Z"}, {"mirrorD", "mirror.D"}, {"mirrorT", "mirror.T"}};
    for (const auto& [key, channel] : in_mirrors) {
      if (pixel.contains(key)) compare_scalar(pixel, key, r.at(channel, x, y), data, place);
    }
  }
  EXPECT_GT(data.compared, 20);
  EXPECT_LT(data.error, 1e-6) << data.where;
  EXPECT_LT(colour.error, 1e-5) << colour.where;
  // Colours are exact only without a model of spectra: the reference leaves them out where there is one.
  const bool has_colours = GetParam() != "relativity_spectral";
  EXPECT_EQ(colour.compared > 20, has_colours);
}

// The same before the rounding to the file's floats: docs/accuracy.md. The worst is a proper time at γ = 10,
// approaching, where the plain boost is still in use.
TEST_P(SixtyDigits, AgreeInDouble) {
  const json values = read(GetParam());
  const Rendering r = rendering_of(values, PixelBox{0, 0, 1, 1});
  const Tracer tracer(r.scene, 0);
  Scratch scratch = tracer.make_scratch();
  Worst worst;
  for (const json& pixel : values["pixels"]) {
    if (pixel["edge"].get<bool>() || pixel["objectId"].get<int>() == 0) continue;
    const ImagePoint centre{pixel["pixel"][0].get<double>() + 0.5, pixel["pixel"][1].get<double>() + 0.5};
    const auto ray = camera_ray(r.scene.camera, centre, effects_at(r.scene, centre), 0);
    ASSERT_TRUE(ray);
    const SurfaceRecord seen = tracer.surface(*ray, scratch);
    const std::string place = pixel["pixel"].dump() + " ";
    compare_scalar(pixel, "Z", seen.distance, worst, place);
    compare_scalar(pixel, "doppler", seen.doppler, worst, place);
    compare_scalar(pixel, "emissionTime", seen.emission_time, worst, place);
    compare_scalar(pixel, "properTime", seen.proper_time, worst, place);
    compare_vector(pixel, "P", seen.position, worst, place);
    compare_vector(pixel, "N", seen.normal, worst, place);
  }
  EXPECT_GT(worst.compared, 20);
  EXPECT_LT(worst.error, 3e-11) << worst.where;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SixtyDigits, testing::ValuesIn(value_files()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace backlight::test
