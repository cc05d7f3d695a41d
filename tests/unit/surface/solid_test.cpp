// Solids made of solids: against membership of points decided by the shapes' own inequalities, and the rules
// for coincident faces, members and normals.
#include "backlight/surface/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "backlight/surface/surface_set.h"
#include "solid_oracle.h"

namespace backlight {
namespace {

using testing::Choices;
using testing::some_solid;
using testing::wrong_along;

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

class Random final : public Choices {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) override {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int count) override { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937_64 engine_;
};

TEST(Solid, BoundaryIsWhereMembershipChanges) {
  Random random(7);
  testing::Looked looked;
  for (int i = 0; i < 400; ++i) {
    const SolidTree tree =
        combined(static_cast<SolidOperation>(i % 3), {some_solid(random, 2), some_solid(random, 2)});
    const SurfaceSet set = set_of(tree);
    for (int j = 0; j < 40; ++j) {
      const Vec3 origin = random.vector(1.5);
      const Vec3 direction = glm::normalize(random.vector(1.0));
      EXPECT_EQ(wrong_along(tree, set, origin, direction, looked), "") << i << ", ray " << j;
    }
  }
  EXPECT_GT(looked.hits, 2000);
  EXPECT_LT(looked.edges, looked.hits / 1000);
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
  EXPECT_TRUE(set.blocked({0, 0, 0}, {1, 0, 0}, 0.6));
  EXPECT_FALSE(set.blocked({0, 0, 0}, {0, 1, 0}, infinity));
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

// A ball of two parts, less one of them: what is left begins where that one ends, and faces inwards there.
TEST(Solid, NormalOfCoincidentFacesIsThatOfTheBoundary) {
  const SolidTree small = part(sphere(1.0), Placement{}, 5);
  const SurfaceSet set =
      set_of(combined(SolidOperation::difference,
                      {combined(SolidOperation::unite, {small, part(sphere(2.0), Placement{}, 6)}), small}));
  const Seen seen = look(set, {0.2, 0.1, 0.0}, {1, 0, 0});
  EXPECT_EQ(seen.point.member, 5);
  EXPECT_NEAR(glm::dot(seen.point.normal, seen.point.position), -1.0, 1e-15);
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

// 0.1/x - 0.2 < 0 holds for x < 0 and for x > 0.5: between them there are a pole and a root.
TEST(Solid, PolesAreNoSurfaceButCountForWhatIsInside) {
  const SolidTree formula = part(implicit(std::make_shared<const ImplicitFormula>(std::get<Expression>(
                                              Expression::parse("0.1/x - 0.2", {"x", "y", "z", "t"}))),
                                          {-1, -1, -1}, {1, 1, 1}));
  const SurfaceSet alone = set_of(combined(SolidOperation::unite, {formula}));
  const Vec3 right{1, 0, 0};
  EXPECT_DOUBLE_EQ(alone.nearest({-3, 0.1, 0.1}, right).lambda, 2.0);
  EXPECT_DOUBLE_EQ(alone.nearest({-0.5, 0.1, 0.1}, right).lambda, 1.0);
  EXPECT_DOUBLE_EQ(look(alone, {-0.5, 0.1, 0.1}, right).point.normal.x, -1.0);
  EXPECT_DOUBLE_EQ(alone.nearest({0.7, 0.1, 0.1}, right).lambda, 0.3);
  EXPECT_DOUBLE_EQ(alone.nearest({0.25, 0.1, 0.1}, -right).lambda, 1.25);
  const SurfaceSet rest = set_of(combined(SolidOperation::difference, {part(sphere(0.5)), formula}));
  const Seen back = look(rest, {-3, 0.0, 0.0}, right);
  EXPECT_DOUBLE_EQ(back.hit.lambda, 3.5);
  EXPECT_DOUBLE_EQ(back.point.normal.x, 1.0);
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
