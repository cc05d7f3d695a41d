// The principle of relativity where mirrors, glass, meshes and matter in motion see each other:
// docs/physics.md section 5, law 1.
#include <gtest/gtest.h>

#include <cmath>

#include "matter_scenes.h"
#include "meshes.h"
#include "redescription.h"

namespace backlight::test {
namespace {

SceneModel model() {
  const std::string path = ::testing::TempDir() + "laws_mixed.obj";
  write_obj(path, icosphere(2, 0.9));
  SceneModel m;
  m.film =
      "[film]\nresolution = [64, 48]\nbounces = 6\naovs = [\"Z\", \"doppler\", \"emissionTime\", "
      "\"properTime\", \"P\", \"N\", \"objectId\", \"mirror\"]\n";
  m.frames = {{"ground", {0, 0, 0}, {}},
              {"eye", {0.3, 0.05, 0.6}, {0.5, 0.2, 1.5, -8}},
              {"mirror", {-0.3, 0.1, -0.35}, {0, 0.5, 1, 4}},
              {"slab", {0.7, 0, 0.4}, {-6, 0.5, 0.9, -3}},
              {"fair", {0.8, 0, -0.4}, {-3, -1.5, 0.5, 2}},
              {"lamp", {0.9, 0, 0.9}, {-8, -9, 7, -12}}};
  m.camera = {"eye", {0, 0, 0}, {0.1, -0.15, 1}, {0, 1, 0}, 0.4};
  const auto part = [](const std::string& keys) { return "shape = \"union\"\n[[object.part]]\n" + keys; };
  m.objects = {
      {"ground",
       "shape = \"plane\"\nmaterial = { color = [0.6, 0.6, 0.5], mirror = [0.5, 0.4, 0.2] }",
       {0, -1.8, 0},
       {}},
      {"mirror", "shape = \"box\"\nsize = [5, 3, 0.2]\nmaterial = { mirror = 0.9 }", {0, 0, 0}, {10, 25, 5}},
      {"slab",
       "shape = \"box\"\nsize = [2.4, 2, 0.5]\nmaterial = { glass = { index = 1.5, tint = [0.9, 0.7, 0.5] } "
       "}",
       {0, 0, 0},
       {10, -20, 5}},
      {"fair",
       "shape = \"mesh\"\nfile = \"" + path + "\"\nmaterial = { color = [0.7, 0.2, 0.1] }",
       {0, 0, 0},
       {10, 35, -20}},
      {"ground",
       part("shape = \"cylinder\"\nradius = 0.9\nheight = 1\nrotate = [0, 0, \"45*t\"]\nmaterial = { mirror "
            "= [0.9, "
            "0.6, 0.3], color = [0.05, 0.05, 0.05] }"),
       {2.2, 2.4, 0},
       {30, 0, 20}},
      {"ground",
       part("shape = \"sphere\"\nradius = 0.7\nposition = [\"0.7*sin(0.9*t)\", \"0.2*cos(t)\", 0]\nmaterial "
            "= { "
            "color = [0.8, 0.8, 0.2], emission = 0.1, temperature = 4000 }"),
       {-3.6, 0.3, 0.5},
       {0, 10, 0}}};
  m.lights = {
      {"lamp", "type = \"point\"\nintensity = \"300*(1.5 + sin(2*t))\"\ntemperature = 5000", {0, 0, 0}}};
  return m;
}

TEST(MixedRedescription, OneCommonLorentzTransformationChangesNoPixel) {
  const Rendering a = render_text(to_toml(model()));
  for (const double celerity : {0.3, 30.0, 1000.0}) {
    const Redescription other = redescribed(model(), celerity * Vec3{0.48, -0.6, 0.64});
    const Rendering b = render_text(to_toml(other.model));
    const Match m = match(a, b);
    EXPECT_GT(m.seen, 1000) << celerity;
    EXPECT_EQ(m.other_id, 0) << celerity;
    EXPECT_LT(m.distance.error, 1e-6) << celerity;
    EXPECT_LT(m.doppler.error, 1e-6) << celerity;
    EXPECT_LT(m.own_time.error, 1e-6) << celerity;
    int in_sight = 0, passed_on = 0, off = 0;
    Worst doppler, distance;
    for (int y = 1; y + 1 < a.height(); ++y) {
      for (int x = 1; x + 1 < a.width(); ++x) {
        in_sight |= 1 << a.id(x, y);
        if (!a.is_inside(x, y) || a.at("mirror.D", x, y) == 0.0) continue;
        ++passed_on;
        const Vec3 rgb = a.rgb(x, y);
        const bool same = a.at("mirror.V", x, y) == b.at("mirror.V", x, y);
        const Vec3 change = glm::abs(rgb - b.rgb(x, y));
        off += !same || std::max({change.x, change.y, change.z}) > 1e-4 * std::max({rgb.x, rgb.y, rgb.z}) ? 1
                                                                                                          : 0;
        if (!same || a.at("mirror.V", x, y) == 0.0) continue;
        doppler.take(std::abs(b.at("mirror.D", x, y) / a.at("mirror.D", x, y) - 1.0));
        distance.take(std::abs(b.at("mirror.Z", x, y) / a.at("mirror.Z", x, y) - 1.0));
      }
    }
    EXPECT_EQ(in_sight & 0b1111110, 0b1111110) << "every object should be in view";
    EXPECT_GT(passed_on, 300) << celerity;
    EXPECT_GT(distance.compared, 25) << celerity;
    EXPECT_LT(doppler.error, 1e-5) << celerity;
    EXPECT_LT(distance.error, 1e-5) << celerity;
    EXPECT_LE(off, passed_on / 100) << celerity;  // at edges that are seen in mirrors
  }
}

}  // namespace
}  // namespace backlight::test
