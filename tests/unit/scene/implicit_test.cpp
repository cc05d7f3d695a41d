// Formulas in scene files: parameters, the object's own time, bounds, blends, and what absurd ones become.
#include <gtest/gtest.h>

#include <cmath>

#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;
using testing_scenes::mistakes;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string implicit_object(const std::string& f, const std::string& more = {}) {
  return "[[object]]\nshape = \"implicit\"\nf = \"" + f + "\"\n" + more;
}

double first_z(const Scene& scene, double x, double y, const RayClock& clock = {}) {
  return scene.frames[0].surfaces->nearest({x, y, -100}, {0, 0, 1}, infinity, clock).lambda - 100;
}

TEST(CompileImplicit, FormulaHasCoordinatesAndParameters) {
  const Scene scene =
      compiled(camera + "[params]\nradius = 2\n" + implicit_object("x^2 + y^2 + z^2 - radius^2"));
  EXPECT_NEAR(first_z(scene, 0, 0), -2.0, 1e-13);
  EXPECT_NEAR(first_z(scene, 1.2, 0), -1.6, 1e-13);
  EXPECT_FALSE(scene.frames[0].surfaces->nearest({2.1, 0, -100}, {0, 0, 1}).found());
}

TEST(CompileImplicit, CoordinatesGoBeforeParametersOfTheSameName) {
  EXPECT_NEAR(
      first_z(compiled(camera + "[params]\nx = 5\nq = \"x\"\n" + implicit_object("x^2+y^2+z^2-q*0-1")), 0, 0),
      -1.0, 1e-13);
}

// t is the proper time where the ray is: the sphere has shrunk less where it is seen later.
TEST(CompileImplicit, TimeIsTheObjectsOwnAlongTheRay) {
  const Scene scene = compiled("c = 2\n" + camera + implicit_object("x^2+y^2+z^2-(1+0.5*sin(t))^2"));
  const double start = 3.0;  // times c
  const double z = first_z(scene, 0, 0, {start, -1.0});
  EXPECT_NEAR(z, -(1.0 + 0.5 * std::sin((start - (z + 100)) / 2.0)), 1e-12);
}

TEST(CompileImplicit, BoundsLeaveASheetOpenAndCloseASolid) {
  const std::string cut = implicit_object("x^2+z^2-1", "bounds = [[-2, -1, -2], [2, 1, 2]]\n");
  const Scene sheet = compiled(camera + cut);
  EXPECT_FALSE(sheet.frames[0].surfaces->nearest({0, 5, 0}, {0, -1, 0}).found());
  EXPECT_EQ(sheet.frames[0].surfaces->nearest({0, 0, -5}, {0, 0, 1}).lambda, 4.0);
  EXPECT_FALSE(sheet.frames[0].surfaces->nearest({0, 1.5, -5}, {0, 0, 1}).found());
  const Scene solid = compiled(camera +
                               "[[object]]\nshape = \"union\"\npart = [{ shape = \"implicit\", f = "
                               "\"x^2+z^2-1\", bounds = [[-2, -1, -2], [2, 1, 2]] }]\n");
  EXPECT_EQ(solid.frames[0].surfaces->nearest({0, 5, 0}, {0, -1, 0}).lambda, 4.0);
}

TEST(CompileImplicit, SaysWhetherUnresolvedRootsAreSeen) {
  const std::string doubled = implicit_object("(x^2+y^2+z^2-1)^2");
  const Hit taken = compiled(camera + doubled).frames[0].surfaces->nearest({0, 0, -5}, {0, 0, 1});
  EXPECT_TRUE(taken.unresolved);
  EXPECT_NEAR(taken.lambda, 4.0, 1e-6);
  EXPECT_FALSE(compiled(camera + doubled + "unresolved = \"skip\"\n")
                   .frames[0]
                   .surfaces->nearest({0, 0, -5}, {0, 0, 1})
                   .found());
}

TEST(CompileBlend, IsThePolynomialSmoothMinimum) {
  const Scene scene =
      compiled(camera +
               "[material.one]\ncolor = [1, 0, 0]\n[material.two]\ncolor = [0, 1, 0]\n"
               "[[object]]\nshape = \"union\"\nblend = 0.4\n"
               "part = [{ shape = \"sphere\", radius = 1, position = [1, 0, 0], material = \"one\" },"
               " { shape = \"implicit\", f = \"sqrt(x^2+y^2+z^2)-1\", position = [-1, 0, 0],"
               " material = \"two\" }]\n");
  const SurfaceSet& set = *scene.frames[0].surfaces;
  // Half way between the two, a = b: the surface is where a = k/4, at a distance 1 + 0.1 from both centres.
  EXPECT_NEAR(first_z(scene, 0, 0), -std::sqrt(1.1 * 1.1 - 1.0), 1e-13);
  const Hit near_one = set.nearest({1.7, 0, -9}, {0, 0, 1});
  ASSERT_TRUE(near_one.found());
  const SurfacePoint point = set.resolve(near_one, {1.7, 0, -9}, {0, 0, 1});
  EXPECT_EQ(scene
                .materials[static_cast<std::size_t>(
                    scene.objects[0].member_materials[static_cast<std::size_t>(point.member)])]
                .name,
            "one");
  EXPECT_NEAR(near_one.lambda - 9, -std::sqrt(1 - 0.49), 1e-13);  // beyond the blend: the sphere itself
}

// The flat faces of parts keep what they have: a certain root each; and near an edge the offset is round.
TEST(CompileBlend, FacesOfBoxAndCylinderAreResolved) {
  for (const char* part :
       {"shape = \"box\", size = [2, 2, 2]", "shape = \"cylinder\", radius = 1, height = 2"}) {
    const Scene scene =
        compiled(camera + "[[object]]\nshape = \"union\"\nblend = 0.4\nposition = [0.1, 0.2, 0.3]\n" +
                 "part = [{ " + part + " }, { shape = \"sphere\", radius = 1, position = [9, 0, 0] }]\n");
    const SurfaceSet& set = *scene.frames[0].surfaces;
    for (int i = 0; i < 60; ++i) {
      const Vec3 from{0.1 + 0.02 * i - 0.59, 8.0, 0.3 + 0.013 * i - 0.4};
      const Hit top = set.nearest(from, {0.01, -1.0, 0.02});
      EXPECT_FALSE(top.unresolved) << part << i;
      EXPECT_NEAR(top.lambda, 6.8, 1e-13) << part << i;
    }
  }
  const Scene two =
      compiled(camera + "[[object]]\nshape = \"union\"\nblend = 1\nbounds = [[-4, -4, -4], [4, 4, 4]]\n" +
               "part = [{ shape = \"box\", size = [2, 2, 2] }, { shape = \"box\", size = [2, 2, 2] }]\n");
  // The same twice: f = d - 1/4, whose corner is an eighth of a sphere of radius 1/4.
  const Vec3 diagonal = glm::normalize(Vec3{1, 1, 1});
  const Hit corner = two.frames[0].surfaces->nearest(5.0 * diagonal, -diagonal);
  EXPECT_NEAR(5.0 - corner.lambda, std::sqrt(3.0) + 0.25, 1e-13);
}

// The bounds of one image are those of the next where the formula is the same, and only there.
TEST(CompileImplicit, BoundsAreProvedOnceForEachFormula) {
  const std::string text = camera +
                           "[animation]\nframes = [1, 3]\n[params]\nsize = \"floor(1 + image_time)\"\n" +
                           implicit_object("x^2 + y^2 + z^2 - size^2");
  ReadResult read = read_scene_text(text, "test.toml", {});
  ASSERT_TRUE(read.description) << testing_scenes::all_messages(read.diagnostics);
  ResourceCache shared;
  for (const double time : {0.0, 0.5, 1.0, 0.25}) {
    ImageRequest request;
    request.time = time;
    ResourceCache fresh;
    const auto alone = compile(*read.description, request, fresh, read.diagnostics);
    const auto after_others = compile(*read.description, request, shared, read.diagnostics);
    ASSERT_TRUE(alone && after_others) << testing_scenes::all_messages(read.diagnostics);
    const double radius = alone->frames[0].surfaces->bounds().radius;
    EXPECT_EQ(after_others->frames[0].surfaces->bounds().radius, radius) << time;
    const double size = std::floor(1.0 + time);
    EXPECT_GE(radius, size);
    EXPECT_LT(radius, 1.8 * size);
  }
}

TEST(CompileImplicit, AbsurdFormulasAreErrorsOrEmpty) {
  for (const char* f : {"1", "t", "0*x", "0/0 + x", "sqrt(-1-x^2)", "1/0 + 0*x", "exp(x)"}) {
    const std::string text = camera + implicit_object(f, "bounds = [[-1, -1, -1], [1, 1, 1]]\n");
    const std::string said = mistakes(text);
    if (!said.empty()) continue;
    EXPECT_FALSE(compiled(text).frames[0].surfaces->nearest({0.3, 0.2, -5}, {0, 0, 1}).found()) << f;
  }
}

}  // namespace
}  // namespace backlight
