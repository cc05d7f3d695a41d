// Solids made of solids: against membership of points decided by the shapes' own inequalities, and the rules
// for coincident faces, members and normals.
#include "backlight/surface/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "backlight/surface/implicit_surface.h"
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

SolidTree formula_part(const std::string& text, double half, const Placement& placement = Placement{}) {
  const auto f = std::make_shared<const ImplicitFormula>(
      std::get<Expression>(Expression::parse(text, {"x", "y", "z", "t"})));
  return part(implicit(f, Vec3{-half}, Vec3{half}), placement);
}

/// Solids of formulas that are searched in each of the ways that there are, and some at random.
std::vector<SolidTree> solids_of_formulas() {
  const SolidTree ball = part(sphere(1.1));
  const SolidTree wall = formula_part("abs(sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x))-0.2", 1.2);
  const SolidTree sextic =
      formula_part("4.236*(x^2+y^2+z^2-1)^2-4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)", 1.2);
  const SolidTree root = formula_part("sqrt(x^2+y^2)-0.5+0.2*z", 1.0, Placement({0.2, 0, 0}, {30, 0, 20}));
  std::vector<SolidTree> solids{combined(SolidOperation::intersect, {wall, ball}),
                                combined(SolidOperation::difference, {ball, wall}),
                                combined(SolidOperation::intersect, {sextic, part(plane())}),
                                combined(SolidOperation::unite, {sextic, root, wall}),
                                combined(SolidOperation::difference, {ball, root, sextic})};
  Random random(23);
  for (int i = 0; i < 20; ++i) {
    solids.push_back(
        combined(static_cast<SolidOperation>(i % 3), {some_solid(random, 2), some_solid(random, 2)}));
  }
  return solids;
}

/// Rays at something about the origin: from outside, and from within.
struct Rays {
  static constexpr int count = 50;
  static constexpr std::uint64_t all = (std::uint64_t{1} << count) - 1;
  RaySheet sheet;

  explicit Rays(Random& random) {
    sheet.padded = 56;
    for (int i = 0; i < sheet.padded; ++i) {
      const Vec3 from = random.vector(i % 2 == 0 ? 3.0 : 0.9);
      const Vec3 towards = random.vector(0.8) - (i % 2 == 0 ? from : Vec3{0.0});
      for (int k = 0; k < 3; ++k) {
        sheet.origin[k][i] = from[k];
        sheet.direction[k][i] = towards[k];
      }
      sheet.length[i] = glm::length(towards);
      sheet.start_time[i] = sheet.time_rate[i] = 0.0;
    }
  }
  [[nodiscard]] Vec3 origin(int i) const {
    return {sheet.origin[0][i], sheet.origin[1][i], sheet.origin[2][i]};
  }
  [[nodiscard]] Vec3 direction(int i) const {
    return {sheet.direction[0][i], sheet.direction[1][i], sheet.direction[2][i]};
  }
};

// What is found of a ray does not depend on those that are asked together with it.
TEST(Solid, RaysFindTogetherWhatEachFindsAlone) {
  Random random(11);
  int found = 0;
  for (const SolidTree& tree : solids_of_formulas()) {
    const SurfaceSet set = set_of(tree);
    const Rays rays(random);
    SheetHits hits;
    hits.clear(sheet_size);
    set.nearest(rays.sheet, Rays::all, 0.0, hits);
    const std::uint64_t blocked = set.blocked(rays.sheet, Rays::all, 0.7);
    SheetPoints points;
    for (int i = 0; i < Rays::count; ++i) {
      const Hit alone = set.first_crossing_of(0, rays.origin(i), rays.direction(i));
      ASSERT_EQ(hits.who[i] == 0.0, alone.found());
      EXPECT_EQ((blocked >> i) & 1U, alone.found() && alone.lambda < 0.7 ? 1U : 0U);
      if (!alone.found()) continue;
      ++found;
      EXPECT_EQ(hits.lambda[i], alone.lambda);
      EXPECT_EQ(hits.part_of(i), alone.part);
      EXPECT_EQ(hits.is_unresolved(i), alone.unresolved);
      set.points(rays.sheet, 0, i, i + 1, hits, true, points);
      const SurfacePoint point = set.resolve(alone, rays.origin(i), rays.direction(i));
      EXPECT_EQ((Vec3{points.position[0][i], points.position[1][i], points.position[2][i]}), point.position);
      EXPECT_EQ((Vec3{points.normal[0][i], points.normal[1][i], points.normal[2][i]}), point.normal);
      EXPECT_EQ(points.u[i], point.u);
      EXPECT_EQ(points.v[i], point.v);
      EXPECT_EQ(points.member[i], point.member);
      EXPECT_EQ(points.error_bound[i], point.error_bound);
    }
  }
  EXPECT_GT(found, 500);
}

// An ellipsoid whose formula is negative outside is solid there, also where the line is far from it.
TEST(Solid, AnEllipsoidThatIsSolidOutsideIsSolidEverywhereOutside) {
  const SolidTree outside = part(quadric({-1, -1, -1, 0, 0, 0, 0, 0, 0, 0.25}), Placement({5, 0, 0}));
  const SurfaceSet set = set_of(combined(SolidOperation::intersect, {part(sphere(1.0)), outside}));
  EXPECT_DOUBLE_EQ(set.nearest({-3, 0.0, 0.0}, {1, 0, 0}).lambda, 2.0);
  EXPECT_DOUBLE_EQ(set.nearest({0, -3, 0.0}, {0, 1, 0}).lambda, 2.0);
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
