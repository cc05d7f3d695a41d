// Surfaces that share a frame are seen as if each were alone in it, at any relative γ.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

// The parts of a scene's text that begin with [[object]], and what is before and behind them.
struct Parts {
  std::string before, behind;
  std::vector<std::string> objects;

  [[nodiscard]] std::string with(std::size_t object) const { return before + objects[object] + behind; }
};

Parts parts_of(const std::string& scene) {
  std::ifstream file(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / "tests/oracle/scenes" / (scene + ".toml"));
  std::stringstream text;
  text << file.rdbuf();
  Parts parts;
  std::string* into = &parts.before;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("[[object]]")) into = &parts.objects.emplace_back();
    if (line.starts_with("[effects]")) into = &parts.behind;
    *into += line + "\n";
  }
  return parts;
}

class SurfacesOfOneFastFrame : public testing::TestWithParam<const char*> {};

TEST_P(SurfacesOfOneFastFrame, AreSeenAsIfAlone) {
  const Parts parts = parts_of(GetParam());
  ASSERT_EQ(parts.objects.size(), 4u);
  std::string together = parts.before;
  for (const std::string& object : parts.objects) together += object;
  const Rendering all = render_text(together + parts.behind);
  std::vector<Rendering> alone;
  for (std::size_t i = 0; i < parts.objects.size(); ++i) alone.push_back(render_text(parts.with(i)));
  Worst worst;
  std::vector<int> seen(parts.objects.size() + 1, 0);
  for (int y = 0; y < all.height(); ++y) {
    for (int x = 0; x < all.width(); ++x) {
      int nearest = 0;
      for (int i = 0; i < int(alone.size()); ++i) {
        const Rendering& one = alone[std::size_t(i)];
        if (one.id(x, y) == 0) continue;
        if (nearest == 0 || one.at("Z", x, y) < alone[std::size_t(nearest - 1)].at("Z", x, y))
          nearest = i + 1;
      }
      if (!all.is_inside(std::clamp(x, 1, all.width() - 2), std::clamp(y, 1, all.height() - 2))) continue;
      ASSERT_EQ(all.id(x, y), nearest) << x << ", " << y;
      ++seen[std::size_t(nearest)];
      if (nearest == 0) continue;
      const Rendering& one = alone[std::size_t(nearest - 1)];
      worst.take(std::abs(all.at("Z", x, y) / one.at("Z", x, y) - 1.0), "Z");
      worst.take(glm::length(all.position(x, y) - one.position(x, y)), "P");
      worst.take(glm::length(all.normal(x, y) - one.normal(x, y)), "N");
    }
  }
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GT(seen[i], 40) << i;
  EXPECT_LT(worst.error, 1e-6) << worst.where;  // P is of size 10, and rounded to floats
}

INSTANTIATE_TEST_SUITE_P(Scenes, SurfacesOfOneFastFrame,
                         testing::Values("both_fast_across", "both_fast_oblique", "both_fast_receding",
                                         "celerity_1e12"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace backlight::test
