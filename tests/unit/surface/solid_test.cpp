// Solids made of solids: against membership of points decided by the shapes' own inequalities, and the rules
// for coincident faces, members and normals.
#include "backlight/surface/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SolidTree part(const Shape& shape, const Placement& placement = Placement{}, int member = 0) {
  return {shape, placement, SolidOperation::unite, {}, member};
}

SolidTree combined(SolidOperation operation, std::vector<SolidTree> parts,
                   const Placement& placement = Placement{}) {
  return {{}, placement, operation, std::move(parts), 0};
}

SurfaceSet set_of(const SolidTree& tree, const Placement& placement = Placement{}) {
  EXPECT_EQ(problem(tree), "");
  SurfaceSet set;
  set.add(csg(tree), placement);
  set.build();
  return set;
}

struct Seen {
  Hit hit;
  SurfacePoint point;
};

Seen look(const SurfaceSet& set, const Vec3& origin, const Vec3& direction) {
  const Hit hit = set.nearest(origin, direction);
  return {hit, hit.found() ? set.resolve(hit, origin, direction) : SurfacePoint{}};
}

// The other way to say what is inside: the inequalities of the shapes, and and, or, not.
bool inside(const Shape& shape, const Vec3& p) {
  const auto& v = shape.values;
  const double rho = std::hypot(p.x, p.z);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return glm::length(p) < v[0];
    case ShapeKind::box:
      return std::abs(p.x) < v[0] / 2 && std::abs(p.y) < v[1] / 2 && std::abs(p.z) < v[2] / 2;
    case ShapeKind::cylinder:
      return rho < v[0] && std::abs(p.y) < v[1] / 2;
    case ShapeKind::torus:
      return std::hypot(rho - v[0], p.y) < v[1];
    case ShapeKind::plane:
      return p.y < 0.0;
    case ShapeKind::quadric:
      return v[0] * p.x * p.x + v[1] * p.y * p.y + v[2] * p.z * p.z + v[9] < 0.0;
    default:
      ADD_FAILURE() << "no inequality for this shape";
      return false;
  }
}

bool inside(const SolidTree& tree, const Vec3& outer) {
  const Vec3 p = tree.placement.local_from_rest() * (outer - tree.placement.position());
  if (tree.parts.empty()) return inside(tree.shape, p);
  bool result = inside(tree.parts[0], p);
  for (std::size_t i = 1; i < tree.parts.size(); ++i) {
    const bool other = inside(tree.parts[i], p);
    if (tree.operation == SolidOperation::unite) result = result || other;
    if (tree.operation == SolidOperation::intersect) result = result && other;
    if (tree.operation == SolidOperation::difference) result = result && !other;
  }
  return result;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  Vec3 vector(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }

  Shape shape() {
    const double a = uniform(0.3, 1.0);
    const double b = uniform(0.3, 1.0);
    switch (below(6)) {
      case 0:
        return sphere(a);
      case 1:
        return box({a, 2 * b, 1.0});
      case 2:
        return cylinder(a, 2 * b);
      case 3:
        return torus(a, 0.6 * a * b);
      case 4:
        return plane();
      default:
        return quadric({1, below(2) == 0 ? 1.0 : -b, 0.5, 0, 0, 0, 0, 0, 0, -a * a});
    }
  }
  SolidTree tree(int depth) {
    const Placement placement(vector(0.6), vector(180.0), Vec3{uniform(0.6, 1.4), uniform(0.6, 1.4), 1.0});
    if (depth == 0 || below(4) == 0) return part(shape(), placement, below(5));
    SolidTree node = combined(static_cast<SolidOperation>(below(3)), {}, placement);
    const int parts = 1 + below(4);
    for (int i = 0; i < parts; ++i) node.parts.push_back(tree(depth - 1));
    return node;
  }

 private:
  std::mt19937_64 engine_;
};

// Along each ray, hit after hit: between two of them membership never changes, across each it does, and the
// normal points to the outside.
TEST(Solid, BoundaryIsWhereMembershipChanges) {
  Random random(7);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const SolidTree tree = combined(static_cast<SolidOperation>(i % 3), {random.tree(2), random.tree(2)});
    const SurfaceSet set = set_of(tree);
    for (int j = 0; j < 40; ++j) {
      const Vec3 origin = random.vector(1.5);
      const Vec3 direction = glm::normalize(random.vector(1.0));
      double from = 0.0;
      for (int k = 0; k < 12 && from < 12.0; ++k) {
        const Hit hit = set.nearest(origin + from * direction, direction);
        const double to = std::min(hit.found() ? from + hit.lambda : infinity, 12.0);
        const bool state = inside(tree, origin + 0.5 * (from + to) * direction);
        for (int m = 1; m < 32; ++m) {
          EXPECT_EQ(inside(tree, origin + (from + (to - from) * m / 32.0) * direction), state);
        }
        if (!hit.found() || to == 12.0 || to - from < 1e-9) break;
        const SurfacePoint point = set.resolve(hit, origin + from * direction, direction);
        EXPECT_LE(glm::length(point.position - (origin + to * direction)), 1e-11);
        if (std::abs(glm::dot(point.normal, direction)) > 1e-3) {
          EXPECT_TRUE(inside(tree, point.position - 1e-7 * point.normal));
          EXPECT_FALSE(inside(tree, point.position + 1e-7 * point.normal));
          EXPECT_EQ(glm::dot(point.normal, direction) > 0.0, state);
        }
        from = to + 1e-9;
        ++hits;
      }
    }
  }
  EXPECT_GT(hits, 2000);
}

const SolidTree lens = combined(SolidOperation::intersect, {part(sphere(1.0), Placement({0.5, 0, 0}), 0),
                                                            part(sphere(1.0), Placement({-0.5, 0, 0}), 1)});

TEST(Solid, MemberNormalAndTextureAreThoseOfThePartThatWasHit) {
  const SurfaceSet set = set_of(lens);
  const Seen left = look(set, {-5, 0, 0}, {1, 0, 0});  // meets the sphere that stands on the right
  EXPECT_EQ(left.point.member, 0);
  EXPECT_DOUBLE_EQ(left.hit.lambda, 4.5);
  EXPECT_DOUBLE_EQ(left.point.normal.x, -1.0);
  EXPECT_DOUBLE_EQ(left.point.u, 0.25);
  const Seen right = look(set, {5, 0, 0}, {-1, 0, 0});
  EXPECT_EQ(right.point.member, 1);
  EXPECT_DOUBLE_EQ(right.point.normal.x, 1.0);
}

TEST(Solid, WallsOfAHoleFaceIntoTheHole) {
  const SurfaceSet set =
      set_of(combined(SolidOperation::difference,
                      {part(box({2, 2, 2}), Placement{}, 0), part(cylinder(0.5, 4), Placement{}, 1)}));
  EXPECT_FALSE(set.nearest({0, 5, 0}, {0, -1, 0}).found());  // through the hole
  const Seen wall = look(set, {0, 0, 0}, {1, 0, 0});         // the camera is in the hole
  EXPECT_DOUBLE_EQ(wall.hit.lambda, 0.5);
  EXPECT_EQ(wall.point.member, 1);
  EXPECT_DOUBLE_EQ(wall.point.normal.x, -1.0);
  const Seen within = look(set, {0.75, 0, 0}, {-1, 0, 0});  // the camera is in the material
  EXPECT_DOUBLE_EQ(within.hit.lambda, 0.25);
  EXPECT_DOUBLE_EQ(within.point.normal.x, -1.0);
  EXPECT_EQ(look(set, {0.75, 0, 0}, {1, 0, 0}).point.member, 0);
  EXPECT_TRUE(set.blocked({0, 0, 0}, {1, 0, 0}, 0.0, 0.6));
  EXPECT_FALSE(set.blocked({0, 0, 0}, {0, 1, 0}, 0.0, infinity));
}

// Glued boxes: one solid, from any side, turned or not and far away or near.
TEST(Solid, TouchingPartsHaveNoWallBetweenThem) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Placement whole(std::pow(10.0, i % 9) * random.vector(1.0), random.vector(180.0));
    const SurfaceSet set =
        set_of(combined(SolidOperation::unite, {part(box({1, 1, 1}), Placement({0.5, 0, 0})),
                                                part(box({1, 1, 1}), Placement({-0.5, 0, 0}))}),
               whole);
    const Vec3 direction = whole.rest_from_local() * glm::normalize(Vec3{1.0, 0.0, 0.0} + random.vector(0.2));
    const Seen out = look(set, whole.position() + whole.rest_from_local() * Vec3{-0.9, 0.0, 0.0}, direction);
    ASSERT_TRUE(out.hit.found());
    const double middle = glm::dot(whole.rest_from_local()[0], out.point.position - whole.position());
    EXPECT_GT(middle, 0.1) << i;
  }
}

TEST(Solid, FlushDifferenceLeavesNoSkin) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const Placement whole(random.vector(100.0), random.vector(180.0));
    // A cut that ends in the plane of the face, made of a part that is placed quite differently.
    const SurfaceSet set = set_of(
        combined(SolidOperation::difference,
                 {part(box({2, 2, 2}), Placement{}, 0),
                  part(cylinder(0.4, 2.0 / 0.7), Placement({0, 0, 0}, {0, 35, 0}, Vec3{1.0, 0.7, 1.0}), 1)}),
        whole);
    const Vec3 target = whole.position() + whole.rest_from_local() * Vec3{0.1, 1.0, 0.05};
    const Vec3 away =
        whole.rest_from_local() * Vec3{random.uniform(-0.1, 0.1), 1.0, random.uniform(-0.1, 0.1)};
    EXPECT_FALSE(set.nearest(target + 3.0 * away, -away).found()) << i;
  }
}

TEST(Solid, CoincidentFacesAreOfTheFirstPart) {
  const auto two = [](int first, int second) {
    return set_of(combined(SolidOperation::unite, {part(box({2, 2, 2}), Placement{}, first),
                                                   part(box({4, 1, 1}), Placement({-1, 0.5, 0}), second)}));
  };
  for (const double x : {0.3, -0.6}) {
    EXPECT_EQ(look(two(4, 9), {x, 5, 0.1}, {0, -1, 0}).point.member, 4);
  }
  EXPECT_EQ(look(two(4, 9), {-2, 5, 0.1}, {0, -1, 0}).point.member, 9);
}

TEST(Solid, SolidsThatOnlyTouchHaveNoCommonPart) {
  const SurfaceSet set =
      set_of(combined(SolidOperation::intersect, {part(box({1, 1, 1}), Placement({0.5, 0, 0})),
                                                  part(box({1, 1, 1}), Placement({-0.5, 0, 0}))}));
  EXPECT_FALSE(set.nearest({-3, 0.1, 0.2}, {1, 0, 0}).found());
  EXPECT_FALSE(set.nearest({-3, 0.1, 0.2}, {1, 0.01, 0.02}).found());
}

// A shell of 1e-9 seen from 1e9 sizes away, where λ itself cannot tell its two sides apart.
TEST(Solid, ThinShellFromAfar) {
  const SurfaceSet set =
      set_of(combined(SolidOperation::difference,
                      {part(sphere(1.0), Placement{}, 0), part(sphere(1.0 - 1e-9), Placement{}, 1)}));
  const Seen seen = look(set, {-1e9, 0.6, 0}, {1, 0, 0});
  ASSERT_TRUE(seen.hit.found());
  EXPECT_EQ(seen.point.member, 0);
  EXPECT_NEAR(seen.point.position.x, -0.8, 1e-14);
  const Seen within = look(set, {0, 0.6, 0}, {1, 0, 0});
  EXPECT_EQ(within.point.member, 1);
  EXPECT_NEAR(within.hit.lambda, 0.8 - 1e-9 / 0.8, 1e-15);
}

TEST(Solid, HalfSpacesMakeACube) {
  const auto half_space = [](Vec3 rotate, Vec3 position) {
    return part(plane(), Placement(position, rotate));
  };
  const SolidTree cube = combined(SolidOperation::intersect,
                                  {half_space({0, 0, 0}, {0, 1, 0}), half_space({180, 0, 0}, {0, -1, 0}),
                                   half_space({90, 0, 0}, {0, 0, 1}), half_space({-90, 0, 0}, {0, 0, -1}),
                                   half_space({0, 0, -90}, {1, 0, 0}), half_space({0, 0, 90}, {-1, 0, 0})});
  const SurfaceSet set = set_of(cube);
  EXPECT_DOUBLE_EQ(look(set, {-3, 0.2, 0.3}, {1, 0, 0}).hit.lambda, 2.0);
  EXPECT_DOUBLE_EQ(look(set, {0, 0.2, 0.3}, {0, 0, -1}).hit.lambda, 1.3);
  EXPECT_FALSE(set.nearest({-3, 1.2, 0.3}, {1, 0, 0}).found());
}

TEST(Solid, BoundsFollowTheOperations) {
  const SolidTree unbounded = combined(SolidOperation::unite, {part(sphere(1)), part(plane())});
  EXPECT_TRUE(is_infinite(csg(unbounded)));
  const SolidTree cut = combined(SolidOperation::intersect, {part(plane()), part(sphere(2))});
  EXPECT_FALSE(is_infinite(csg(cut)));
  EXPECT_NEAR(set_of(cut).bounds(0).radius, 2.0 * std::sqrt(3.0), 1e-10);
  const SolidTree first = combined(SolidOperation::difference, {part(sphere(2)), part(plane())});
  EXPECT_FALSE(is_infinite(csg(first)));
  const SolidTree apart =
      combined(SolidOperation::intersect, {part(sphere(1), Placement({5, 0, 0})), part(sphere(1))});
  EXPECT_EQ(set_of(apart).bounds(0).radius, 0.0);
}

TEST(Solid, ManyAndDeeplyNestedParts) {
  SolidTree many = combined(SolidOperation::unite, {});
  for (int i = 0; i < 1000; ++i) many.parts.push_back(part(sphere(0.4), Placement({double(i), 0, 0}), i));
  const SurfaceSet row = set_of(many);
  EXPECT_EQ(look(row, {777, 3, 0}, {0, -1, 0}).point.member, 777);
  EXPECT_EQ(look(row, {2000, 0, 0}, {-1, 0, 0}).point.member, 999);

  SolidTree deep = part(sphere(1.0), Placement{}, 3);
  for (int i = 0; i < deepest_solid; ++i) {
    deep = combined(i % 2 == 0 ? SolidOperation::unite : SolidOperation::intersect, {deep});
  }
  EXPECT_DOUBLE_EQ(look(set_of(deep), {0, 0, -2}, {0, 0, 1}).hit.lambda, 1.0);
  EXPECT_EQ(problem(combined(SolidOperation::unite, {deep})), "solids are nested deeper than 64 operations");
}

TEST(Solid, SaysWhatIsWrong) {
  EXPECT_EQ(problem(combined(SolidOperation::unite, {part(disk(1))})),
            "a disk encloses nothing, and cannot be part of a solid");
  EXPECT_EQ(problem(combined(SolidOperation::unite, {part(sphere(-1))})),
            "radius must be positive and finite");
  EXPECT_EQ(
      problem(combined(SolidOperation::unite, {part(sphere(1), Placement({0, 0, 0}, {0, 0, 0}, {1, 0, 1}))})),
      "scale must be finite and not zero");
}

}  // namespace
}  // namespace backlight
