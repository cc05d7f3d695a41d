// Meshes in motion: the principle of relativity, and against the shapes that they are meshes of.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "matter_scenes.h"
#include "meshes.h"
#include "redescription.h"

namespace backlight::test {
namespace {

/// The keys of a mesh, whose file is written.
std::string mesh_keys(const std::string& name, const MeshData& mesh, const std::string& more) {
  const std::string path = ::testing::TempDir() + "laws_" + name + ".obj";
  write_obj(path, mesh);
  return "shape = \"mesh\"\nfile = \"" + path + "\"\n" + more;
}

SceneModel model() {
  SceneModel m = passing_frames(film(64, 48));
  m.objects = {{"ground",
                mesh_keys("floor", box_mesh({40, 1, 40}), "material = { color = [0.6, 0.6, 0.5] }"),
                {0, -1.5, 8},
                {}},
               {"fair",
                mesh_keys("ball", icosphere(3, 1.1),
                          "scale = [1, 0.8, 0.9]\nmaterial = { color = [0.7, 0.2, 0.1], specular = 0.3 }"),
                {0, 0, 0},
                {10, 35, -20}},
               {"ground",
                mesh_keys("ring", torus_mesh(0.9, 0.35, 40, 20),
                          "smooth = false\nmaterial = { color = [0.1, 0.3, 0.8] }"),
                {2.5, 1.2, 1},
                {30, 0, 20}},
               {"ground",
                "shape = \"difference\"\nmaterial = { color = [0.8, 0.8, 0.2] }\n[[object.part]]\n" +
                    mesh_keys("cube", box_mesh({1.2, 1.2, 1.2}), "") +
                    "\n[[object.part]]\nshape = \"sphere\"\nradius = 0.75\n",
                {-1.6, 0.3, 0.5},
                {0, 10, 0}}};
  m.lights = {{"lamp", "type = \"point\"\nintensity = 300\ntemperature = 5000", {0, 0, 0}}};
  return m;
}

TEST(Meshes, OneCommonLorentzTransformationChangesNoPixel) {
  const Rendering a = render_text(to_toml(model()));
  for (const double celerity : {0.3, 100.0, 1000.0}) {
    const Redescription other = redescribed(model(), celerity * Vec3{0.48, -0.6, 0.64});
    const Rendering b = render_text(to_toml(other.model));
    const Match m = match(a, b);
    EXPECT_GT(m.seen, 1000);
    EXPECT_EQ(m.other_id, 0);
    EXPECT_LT(m.distance.error, 1e-6);
    EXPECT_LT(m.doppler.error, 1e-6);
    EXPECT_LT(m.own_time.error, 1e-6);
    EXPECT_LT(m.colour.error, 1e-5) << m.colour.where;
    int seen = 0;
    for (int y = 1; y < 47; ++y) {
      for (int x = 1; x < 63; ++x) {
        seen |= 1 << a.id(x, y);
        if (a.id(x, y) == 0 || !a.is_inside(x, y) || b.id(x, y) != a.id(x, y)) continue;
        const Mat3& turn = other.rotation_of_object[static_cast<std::size_t>(a.id(x, y) - 1)];
        EXPECT_LT(glm::length(turn * a.position(x, y) - b.position(x, y)),
                  1e-6 * (1.0 + glm::length(a.position(x, y))));
      }
    }
    EXPECT_EQ(seen & 0b11110, 0b11110) << "every object should be in view";
  }
}

/// Two images of the same bodies, as a mesh and as a shape.
void expect_twins(const std::string& scene, const std::string& mesh, const std::string& shape,
                  const std::string& more, double sagitta, double turned) {
  const Rendering a = render_text(scene + "[[object]]\n" + mesh + "\n" + more);
  const Rendering b = render_text(scene + "[[object]]\n" + shape + "\n" + more);
  int seen = 0;
  for (int y = 1; y < a.height() - 1; ++y) {
    for (int x = 1; x < a.width() - 1; ++x) {
      if (!a.is_inside(x, y) || !b.is_inside(x, y)) continue;
      ASSERT_EQ(a.id(x, y), b.id(x, y)) << x << ", " << y;
      if (a.id(x, y) == 0) continue;
      ++seen;
      EXPECT_LT(std::abs(a.at("Z", x, y) / b.at("Z", x, y) - 1.0), sagitta + 1e-6);
      EXPECT_LT(glm::length(a.normal(x, y) - b.normal(x, y)), turned);
      EXPECT_LT(std::abs(a.at("doppler.D", x, y) / b.at("doppler.D", x, y) - 1.0), sagitta + 1e-6);
      if (turned > 1e-5) continue;
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.rgb(x, y)[k], b.rgb(x, y)[k], 2e-6 * (1.0 + b.rgb(x, y)[k]));
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Meshes, ShowWhatTheShapesDo) {
  const std::string near = "c = 1\n" + film(60, 45) +
                           "[camera]\nposition = [0, 0.5, -6]\nlook_at = [0, 0, 0]\n"
                           "[[light]]\nposition = [-3, 5, -6]\nintensity = 100\n";
  // As fast as frames of extended precision are for: the same accuracy.
  const std::string fast =
      "c = 1\n" + film(60, 45) +
      "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\ngamma = 1e6\n"
      "along = [0, 0, -1]\nfov = 140\n[[light]]\nposition = [0, 5, -5]\nintensity = 100\n";
  const std::string oblique = "rotate = [20, 30, 10]\nbeta = [0.6, 0.1, 0.3]\nposition = [2.8, 0.5, 1.5]";
  const std::string resting = "rotate = [20, 30, 10]\nposition = [0.3, 0.2, 3]\nscale = 1";
  const std::string box_shape = "shape = \"box\"\nsize = [1, 1.5, 2]",
                    cube = mesh_keys("box", box_mesh({1, 1.5, 2}), "");
  expect_twins(near, cube, box_shape, oblique, 0.0, 1e-6);
  expect_twins(near, cube, box_shape, resting, 0.0, 1e-6);
  expect_twins(fast, cube, box_shape, resting, 0.0, 1e-6);
  const std::string ball = mesh_keys("fine_ball", icosphere(5, 1.2), "");
  expect_twins(near, ball, "shape = \"sphere\"\nradius = 1.2", oblique, 2e-3, 0.02);
  const std::string ring = mesh_keys("fine_ring", torus_mesh(1.2, 0.5, 200, 100), "");
  expect_twins(near, ring, "shape = \"torus\"\nmajor = 1.2\nminor = 0.5", oblique, 5e-3, 0.03);
}

/// A body that goes on by a position of t, or by the velocity of its frame; it is stretched by γ along x
/// there.
struct Travelling {
  const char* name;
  std::string keys;   ///< of the object itself
  std::string parts;  ///< its tables
};

std::string by_path(const Travelling& body, const Vec3& start, const Oblique& motion) {
  return "[[object]]\n" + body.keys + path(start, motion.velocity()) + motion.rotate(20) + body.parts;
}

std::string by_frame(const Travelling& body, const Vec3& start, const Oblique& motion) {
  const Vec3 stretch{lorentz_factor(motion.velocity()), 1.0, 1.0};
  return "[[object]]\n" + body.keys + "position = " + list(start) + "\nbeta = " + list(motion.velocity()) +
         "\nscale = " + list(stretch) + "\n" + motion.rotate(20) + body.parts;
}

// Smooth normals obey equation (24), as the surface's own does.
TEST(Meshes, GoStraightOnByAPathAsByTheirFrame) {
  const std::string ball = mesh_keys("carried", icosphere(1, 1.1), ""), parts = "[[object.part]]\n";
  const std::string colour = "material = { color = [0.7, 0.2, 0.1], specular = 0.3 }\n";
  const std::vector<Travelling> bodies = {
      {"coloured", ball + colour, ""},
      {"mirror", ball + "material = { mirror = [0.9, 0.6, 0.3], color = [0.1, 0.1, 0.1] }\n", ""},
      {"solid", "shape = \"difference\"\n" + colour,
       parts + ball + parts + "shape = \"sphere\"\nradius = 0.7\nposition = [0, 0.3, -0.9]\n"},
      {"cut by a mesh", "shape = \"difference\"\n" + colour,
       parts + "shape = \"box\"\nsize = [2, 2, 2]\n" + parts + ball + "position = [0, 0.3, -0.9]\n"}};
  const std::string stage = "c = 1\n" + film(64, 48) +
                            "bounces = 3\n[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = 40\n"
                            "[[light]]\nposition = [-3, 5, -1]\nintensity = 100\n"
                            "[[light]]\ntype = \"distant\"\ndirection = [1, -1, 0.7]\nirradiance = 1\n"
                            "[[object]]\nshape = \"box\"\nsize = [40, 0.5, 40]\nposition = [0, -2, 0]\n"
                            "material = { color = [0.6, 0.6, 0.5] }\n";
  const Vec3 seen_at{0.2, 0.1, 5};
  for (const Oblique& motion : {Oblique{0.6, 0, 0}, Oblique{0.6}, Oblique{0.95}, Oblique{0.6, 90, 0}}) {
    const Vec3 start = seen_at + glm::length(seen_at) * motion.velocity();
    for (const Travelling& body : bodies) {
      const std::string what = std::string(body.name) + " at " + list(motion.velocity()) + ": ";
      const Match m = match(render_text(stage + by_path(body, start, motion)),
                            render_text(stage + by_frame(body, start, motion)));
      EXPECT_GT(m.seen, 700) << what;
      EXPECT_EQ(m.other_id, 0) << what;
      EXPECT_LT(m.distance.error, 1e-6) << what << m.distance.where;
      EXPECT_LT(m.doppler.error, 1e-6) << what << m.doppler.where;
      EXPECT_LT(m.normal.error, 1e-6) << what << m.normal.where;
      EXPECT_LT(m.colour.error, 1e-5) << what << m.colour.where;
    }
  }
}

}  // namespace
}  // namespace backlight::test
