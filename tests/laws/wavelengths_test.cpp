// The default number of wavelengths on the figure scenes: within ΔE2000 0.5 of a sum over 400.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "backlight/colour/rgb.h"
#include "backlight/scene/needs.h"
#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

std::vector<std::string> figure_scenes() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / "scenes")) {
    const std::string name = entry.path().stem().string();
    // Figure 4 is a graph: its scene has no light, only angles.
    const bool is_figure = name.starts_with("fig") && !name.starts_with("fig4");
    if (entry.path().extension() == ".toml" && is_figure) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The luminance that 95 % of the pixels stay below: the exposure that a viewer would choose.
double white_of(const Rendering& r) {
  std::vector<double> y;
  for (int j = 0; j < r.height(); ++j)
    for (int i = 0; i < r.width(); ++i) y.push_back(luminance(r.rgb(i, j)));
  std::sort(y.begin(), y.end());
  return y[y.size() * 95 / 100];
}

class WavelengthCount : public testing::TestWithParam<std::string> {};

TEST_P(WavelengthCount, DefaultCountKeepsColours) {
  const std::string file = "scenes/" + GetParam() + ".toml";
  RenderChoices choices;
  choices.overrides = {"film.resolution=[72,52]", "film.samples=1"};
  const Rendering coarse = render_file(file, choices);
  if (!needs_of(coarse.scene).spectral) GTEST_SKIP() << "no colour is shifted in this scene";
  choices.wavelengths = 400;
  const Rendering fine = render_file(file, choices);
  const double white = white_of(fine);
  ASSERT_GT(white, 0.0);
  Worst worst;
  for (int y = 0; y < fine.height(); ++y) {
    for (int x = 0; x < fine.width(); ++x) {
      // Brighter than white is shown as white: scaled down to it, so that differences of hue count.
      const double scale = 1.0 / std::max(white, luminance(fine.rgb(x, y)));
      worst.take(delta_e_2000(lab_from_rgb(scale * coarse.rgb(x, y)), lab_from_rgb(scale * fine.rgb(x, y))),
                 "pixel " + std::to_string(x) + ", " + std::to_string(y));
    }
  }
  EXPECT_LT(worst.error, 0.5) << worst.where;
}

TEST(Wavelengths, AreNeededBySomeFigure) {
  int spectral = 0;
  for (const std::string& name : figure_scenes()) {
    const RenderChoices tiny{.overrides = {"film.resolution=[2,2]", "film.samples=1"}};
    spectral += needs_of(render_file("scenes/" + name + ".toml", tiny).scene).spectral ? 1 : 0;
  }
  EXPECT_GE(spectral, 2);
}

INSTANTIATE_TEST_SUITE_P(Figures, WavelengthCount, testing::ValuesIn(figure_scenes()), [](const auto& test) {
  std::string name = test.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

}  // namespace
}  // namespace backlight::test
