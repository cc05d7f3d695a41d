// The scenes that people render, by sheets and by the law that asks every surface: the same bits.
#include <gtest/gtest.h>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

class RealScenes : public testing::TestWithParam<const char*> {};

TEST_P(RealScenes, AreTheLaw) {
  const std::string path = std::string("scenes/") + GetParam() + ".toml";
  RenderChoices choices{.overrides = {"film.resolution=[54,39]", "film.samples=2"}};
  const Rendering sheets = render_file(path, choices);
  choices.path = RayPath::one_by_one;
  const Rendering law = render_file(path, choices);
  expect_same_bits(sheets.image, law.image);
  EXPECT_EQ(sheets.statistics.rays.shadow, law.statistics.rays.shadow);
}

INSTANTIATE_TEST_SUITE_P(Gallery, RealScenes,
                         testing::Values("algebraic-0.9c", "default", "fig1-tram-interior", "fig2a-tram-rest",
                                         "fig2b-tram-terrell", "fig2c-tram-no-light-delay",
                                         "fig5b-street-mercator-0.9c", "fig7-tram-shadow", "rocket",
                                         "street-lamp-flicker", "terrell-row"));

}  // namespace
}  // namespace backlight::test
