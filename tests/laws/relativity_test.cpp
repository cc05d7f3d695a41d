// The principle of relativity on rendered images: docs/physics.md section 5, law 1.
#include <gtest/gtest.h>

#include <cmath>

#include "redescription.h"
#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

constexpr int width = 72;
constexpr int height = 54;

Vec4 origin_event(double t, double x, double y, double z) {
  return {t, x, y, z};
}

// A moving camera looks at boxes, spheres and a plane, each in its own motion, under a moving lamp that
// flickers by its own clock.
SceneModel model() {
  SceneModel m;
  m.film = film(width, height);
  m.frames = {{"ground", {0, 0, 0}, {}},
              {"eye", {0.3, 0.05, 0.6}, origin_event(0.5, 0.2, 1.5, -8)},
              {"car", {1.2, 0, -0.4}, origin_event(-3, -1.5, 0.5, 2)},
              {"ball", {-0.7, 0.6, 0.2}, origin_event(-9.02, 2.5, 1.5, 2)},
              {"cube", {0, 0.2, 2.0}, origin_event(-11.86, -1, 2.2, 5)},
              {"lamp", {0.9, 0, 0.9}, origin_event(-8, -9, 7, -12)}};
  m.camera = {"eye", {0, 0, 0}, {0.1, -0.15, 1}, {0, 1, 0}, 0.4};
  m.objects = {{"ground", "shape = \"plane\"\nmaterial = { color = [0.6, 0.6, 0.5] }", {0, -1, 0}, {0, 0, 0}},
               {"car",
                "shape = \"box\"\nsize = [2, 1, 1.2]\nmaterial = { color = [0.7, 0.2, 0.1], specular = 0.3 }",
                {0, 0, 0},
                {10, 35, -20}},
               {"ball",
                "shape = \"sphere\"\nradius = 0.8\nmaterial = { color = [0.1, 0.3, 0.8] }",
                {0, 0, 0},
                {0, 0, 0}},
               {"cube",
                "shape = \"box\"\nsize = [1, 1, 1]\nmaterial = { color = [0.2, 0.7, 0.3], emission = 0.05, "
                "temperature = 4000 }",
                {0, 0, 0},
                {25, -40, 15}},
               {"ball",
                "shape = \"sphere\"\nradius = 0.5\nmaterial = { color = [0.8, 0.8, 0.2] }",
                {-1.6, 0.3, 0.5},
                {0, 0, 0}},
               {"ground",
                "shape = \"box\"\nsize = [1.5, 3, 1.5]\nmaterial = { color = [0.5, 0.5, 0.5] }",
                {-4, 0.5, 3},
                {0, 20, 0}}};
  m.lights = {
      {"lamp", "type = \"point\"\nintensity = \"300*(1.5 + sin(2*t))\"\ntemperature = 5000", {0, 0, 0}}};
  return m;
}

struct Comparison {
  int pixels = 0;
  int seen = 0;
  int other_id = 0;
  Worst data;  // relative errors
  Worst colour;
};

double relative(double a, double b, double scale) {
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), scale});
}

Comparison compare(const Rendering& a, const Rendering& b, const std::vector<Mat3>& rotation_of_object) {
  Comparison c;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      if (!a.is_inside(x, y)) continue;
      ++c.pixels;
      const int id = a.id(x, y);
      if (b.id(x, y) != id) {
        ++c.other_id;
        continue;
      }
      if (id == 0) continue;
      ++c.seen;
      for (const char* channel : {"Z", "doppler.D", "properTime.T"}) {
        c.data.take(relative(a.at(channel, x, y), b.at(channel, x, y), 1.0), channel);
      }
      const Mat3& rotation = rotation_of_object[static_cast<std::size_t>(id - 1)];
      const double size = std::max(glm::length(a.position(x, y)), 1.0);
      c.data.take(glm::length(rotation * a.position(x, y) - b.position(x, y)) / size, "P");
      c.data.take(glm::length(rotation * a.normal(x, y) - b.normal(x, y)), "N");
      const Vec3 colour = a.rgb(x, y);
      const double brightness = std::max({std::abs(colour.r), std::abs(colour.g), std::abs(colour.b)});
      const double difference = glm::length(colour - b.rgb(x, y));
      c.colour.take(difference == 0.0 ? 0.0 : difference / brightness);
    }
  }
  return c;
}

class Relativity : public testing::TestWithParam<double> {};

TEST_P(Relativity, OneCommonLorentzTransformationChangesNoPixel) {
  const SceneModel original = model();
  const Rendering a = render_text(to_toml(original));
  int hits = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) hits |= 1 << a.id(x, y);
  }
  ASSERT_EQ(hits & 0b1111110, 0b1111110) << "every object should be in view";
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0.48, -0.6, 0.64}, Vec3{0.1, 0.2, -1.0}}) {
    const Redescription other = redescribed(original, GetParam() * axis / glm::length(axis));
    const Rendering b = render_text(to_toml(other.model));
    const Comparison c = compare(a, b, other.rotation_of_object);
    EXPECT_GT(c.seen, 1500);
    EXPECT_EQ(c.other_id, 0) << "axis " << axis.x << ' ' << axis.y << ' ' << axis.z;
    EXPECT_LT(c.data.error, 1e-6) << c.data.where;
    // A shadow's edge may fall on the other side of a pixel's centre: no more than a handful of pixels, which
    // the worst colour would show. None does in this scene.
    EXPECT_LT(c.colour.error, 1e-5);
  }
}

// Within a frame of any celerity the numbers of the scene stay as they are, and so does the image.
TEST(RelativityWithin, AllOfASceneWithinAFastFrameIsTheSameImage) {
  const SceneModel original = model();
  const Rendering a = render_text(to_toml(original));
  for (const double celerity : {1e3, 1e6, 1e8}) {
    const Vec3 axis{0.48, -0.6, 0.64};
    const Redescription other = within_frame(original, celerity * axis);
    const Comparison c = compare(a, render_text(to_toml(other.model)), other.rotation_of_object);
    EXPECT_GT(c.seen, 1500);
    EXPECT_EQ(c.other_id, 0) << celerity;
    EXPECT_LT(c.data.error, 1e-6) << celerity << ' ' << c.data.where;
    EXPECT_LT(c.colour.error, 1e-5) << celerity;
  }
}

INSTANTIATE_TEST_SUITE_P(Celerities, Relativity, testing::Values(0.3, 3.0, 100.0, 1000.0));

}  // namespace
}  // namespace backlight::test
