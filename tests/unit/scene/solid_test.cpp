// Solids in scene files: parts within parts, their places, materials and textures; copies; overrides.
#include <gtest/gtest.h>

#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;

const std::string holed =
    camera +
    "[material.skin]\ncolor = [1, 0, 0]\n[material.wall]\ncolor = [0, 0, 1]\n"
    "[[object]]\nname = \"block\"\nshape = \"difference\"\nmaterial = \"skin\"\nposition = [10, 0, 0]\n"
    "repeat = { count = [2, 1, 1], step = [20, 0, 0] }\n"
    "[[object.part]]\nshape = \"box\"\nsize = [2, 2, 2]\n"
    "[[object.part]]\nname = \"hole\"\nshape = \"union\"\nmaterial = \"wall\"\nposition = [0.25, 0, 0]\n"
    "[[object.part.part]]\nshape = \"cylinder\"\nradius = 0.5\nheight = 4\nrotate = [90, 0, 0]\n"
    "[[object.part.part]]\nshape = \"sphere\"\nradius = 0.75\nmaterial = \"skin\"\n";

struct Seen {
  double z;
  std::string material;
};

Seen look(const Scene& scene, double x, double y, double from = -50) {
  const SurfaceSet& surfaces = *scene.frames[0].surfaces;
  const Vec3 origin{x, y, from};
  const Hit hit = surfaces.nearest(origin, {0, 0, 1});
  if (!hit.found()) return {0.0, "nothing"};
  const SurfacePoint point = surfaces.resolve(hit, origin, {0, 0, 1});
  const Object& object = scene.objects[static_cast<std::size_t>(
      scene.frames[0].object_of_surface[static_cast<std::size_t>(hit.surface)])];
  const int material = object.member_materials[static_cast<std::size_t>(point.member)];
  return {point.position.z, scene.materials[static_cast<std::size_t>(material)].name};
}

TEST(CompileSolids, PartsArePlacedWithinTheirWhole) {
  const Scene scene = compiled(holed);
  EXPECT_EQ(look(scene, 9.5, 0).material, "skin");
  EXPECT_DOUBLE_EQ(look(scene, 9.5, 0).z, -1.0);
  EXPECT_EQ(look(scene, 10.25, 0).material, "nothing");    // through the hole
  EXPECT_EQ(look(scene, 10.85, 0, 0.0).material, "skin");  // from inside the hollow, its sphere
  EXPECT_NEAR(look(scene, 10.85, 0, 0.0).z, 0.45, 1e-14);
  EXPECT_DOUBLE_EQ(look(scene, 29.5, 0).z, -1.0);  // the copy
  EXPECT_EQ(look(scene, 30.25, 0).material, "nothing");
  EXPECT_EQ(scene.objects.size(), 1U);
}

TEST(CompileSolids, PartsInheritTheMaterialOfTheirWhole) {
  const Scene scene = compiled(holed);
  const SurfaceSet& surfaces = *scene.frames[0].surfaces;
  const Hit hit = surfaces.nearest({10.25, 0, -0.8}, {1, 0, 0});  // the cylinder's wall
  const SurfacePoint point = surfaces.resolve(hit, {10.25, 0, -0.8}, {1, 0, 0});
  const int material = scene.objects[0].member_materials[static_cast<std::size_t>(point.member)];
  EXPECT_EQ(scene.materials[static_cast<std::size_t>(material)].name, "wall");
  EXPECT_DOUBLE_EQ(point.position.x, 10.75);
  EXPECT_DOUBLE_EQ(point.normal.x, -1.0);
}

TEST(CompileSolids, OverridesReachIntoParts) {
  const Scene scene = compiled(
      holed, {}, {"object.block.part.hole.part.1.radius=0.1", "object.block.part.hole.part.2.radius=0.2"});
  EXPECT_EQ(look(scene, 10.6, 0).material, "skin");
  EXPECT_EQ(look(scene, 10.3, 0).material, "nothing");
}

}  // namespace
}  // namespace backlight
