// The search (tree against list, ties, limits), shadow rays from resolved points, and bounds.
#include "backlight/surface/surface_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 18446744073709551616.0);
  }
  Vec3 in_cube(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    const double z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3 unit() {
    Vec3 v{0.0};
    do {
      v = in_cube(1.0);
    } while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 0.01);
    return glm::normalize(v);
  }

 private:
  std::mt19937_64 engine_;
};

Shape some_shape(Random& random, int kind) {
  const double a = random.uniform(0.1, 1.0);
  const double b = random.uniform(0.1, 1.0);
  switch (kind) {
    case 0:
      return sphere(a);
    case 1:
      return box({a, b, 0.5});
    case 2:
      return cylinder(a, b);
    case 3:
      return cone(a, 0.5 * b, 1.0);
    case 4:
      return torus(a, 0.5 * a);
    case 5:
      return disk(a);
    case 6:
      return plane();
    default:
      return quadric({1, b, 1, 0.2, 0, 0, 0, 0, 0, -a});
  }
}

Placement some_placement(Random& random, double spread, bool turned) {
  const Vec3 position = random.in_cube(spread);
  const Vec3 rotate = turned ? random.in_cube(180.0) : Vec3{0.0};
  const double one = random.uniform(0.5, 2.0);
  const double two = random.uniform(0.5, 2.0);
  return Placement(position, rotate, turned ? Vec3{one, two, -1.0} : Vec3{1.0});
}

/// Surfaces that are searched by the tree, alone and in sheets of every width, and by asking each of them.
struct Twins {
  SurfaceSet set;

  void add(const Shape& shape, const Placement& placement) { set.add(shape, placement); }
  void build() { set.build(); }
  /// True if something was hit.
  bool agree(const Vec3& origin, const Vec3& direction, double limit) const {
    const Hit one = set.nearest(origin, direction, limit, {}, Search::every_surface);
    expect_same(one, set.nearest(origin, direction, limit, {}, Search::tree));
    for (const InstructionSet width :
         {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::widest}) {
      for (const bool one_origin : {true, false}) {
        RaySheet sheet = sheet_of(origin, direction, width, one_origin);
        SheetHits hits;
        hits.clear(8);
        std::fill_n(hits.lambda, 8, limit);
        set.nearest(sheet, 0x81, 0.0, hits);
        expect_same(one, hit_of(hits, 0));
        expect_same(one, hit_of(hits, 7));
        EXPECT_EQ(set.blocked(sheet, 0x81, limit), one.found() ? 0x81U : 0U);
      }
    }
    EXPECT_EQ(set.blocked(origin, direction, limit, {}, Search::every_surface), one.found());
    EXPECT_EQ(set.blocked(origin, direction, limit, {}, Search::tree), one.found());
    return one.found();
  }

 private:
  static void expect_same(const Hit& one, const Hit& two) {
    EXPECT_EQ(one.surface, two.surface);
    EXPECT_EQ(one.lambda, two.lambda);
    EXPECT_EQ(one.part, two.part);
  }
  static RaySheet sheet_of(const Vec3& origin, const Vec3& direction, InstructionSet width, bool one_origin) {
    RaySheet sheet;
    sheet.padded = 8;
    sheet.one_origin = one_origin;
    sheet.instructions = width;
    for (int i = 0; i < 8; ++i) {
      for (int k = 0; k < 3; ++k) {
        sheet.origin[k][i] = origin[k];
        sheet.direction[k][i] = direction[k];
      }
      sheet.length[i] = glm::length(direction);
      sheet.start_time[i] = sheet.time_rate[i] = 0.0;
    }
    return sheet;
  }
  static Hit hit_of(const SheetHits& hits, int ray) {
    if (hits.who[ray] < 0.0) return {};
    return {hits.lambda[ray], static_cast<int>(hits.who[ray]), hits.part_of(ray)};
  }
};

TEST(SurfaceSet, TreeEqualsListBitForBit) {
  for (const int count : {1, 5, 9, 40, 300}) {
    Random random(static_cast<unsigned>(count));
    Twins twins;
    for (int i = 0; i < count; ++i) {
      const Shape shape = some_shape(random, i % 6);
      twins.add(shape, some_placement(random, 4.0, i % 3 == 0));
    }
    twins.build();
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
      const double distance = std::pow(10.0, random.uniform(-1.0, 9.0));
      const Vec3 along = i % 5 == 0 ? Vec3{0, 0, i % 2 == 0 ? 1.0 : -1.0} : random.unit();
      const Vec3 aim = random.in_cube(3.0);
      const Vec3 origin = aim - distance * along;
      const double length = std::pow(10.0, random.uniform(-8.0, 8.0));
      const double limit = i % 4 == 0 ? distance / length : infinity;
      hits += twins.agree(origin, length * along, limit) ? 1 : 0;
      ASSERT_FALSE(HasFailure()) << count << " surfaces, ray " << i;
    }
    EXPECT_GT(hits, count < 40 ? 0 : 1000);
  }
}

TEST(SurfaceSet, HundredThousandSurfaces) {
  Random random(7);
  Twins twins;
  for (int i = 0; i < 100000; ++i) {
    twins.add(sphere(0.02), Placement(random.in_cube(1.0)));
  }
  twins.build();
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 along = random.unit();
    const Vec3 origin = random.in_cube(0.5) - 1000.0 * along;
    hits += twins.agree(origin, 1e-3 * along, infinity) ? 1 : 0;
  }
  EXPECT_GT(hits, 50);
}

TEST(SurfaceSet, EqualLambdaGoesToTheSmallerIndex) {
  Twins twins;
  for (int i = 0; i < 100; ++i) {  // each stands there twice, far apart in index
    twins.add(box({1, 1, 1}), Placement({static_cast<double>((i * 37) % 50), 0, 0}));
  }
  twins.add(plane(), Placement({0, 0.5, 0}));  // flush with the tops
  twins.build();
  for (int place = 0; place < 50; ++place) {
    int first = 0;
    while ((first * 37) % 50 != place) {
      ++first;
    }
    const Vec3 origin{place + 0.25, 3, 0.1};
    ASSERT_TRUE(twins.agree(origin, {0, -1, 0}, infinity));
    EXPECT_EQ(twins.set.nearest(origin, {0, -1, 0}).surface, first);
    EXPECT_EQ(twins.set.nearest(origin, {0, -1, 0}).lambda, 2.5);
  }
}

TEST(SurfaceSet, IntervalsAreOpen) {
  SurfaceSet set;
  set.add(box({2, 2, 2}), Placement());
  set.build();
  const Vec3 origin{3, 0, 0};
  const Vec3 direction{-0.5, 0, 0};  // faces at λ = 4 and 8
  EXPECT_EQ(set.nearest(origin, direction).lambda, 4.0);
  EXPECT_EQ(set.nearest(origin, direction).part, 1);
  EXPECT_FALSE(set.nearest(origin, direction, 4.0).found());
  EXPECT_TRUE(set.blocked(origin, direction, 4.5));
  const Vec3 face = origin + 4.0 * direction;
  EXPECT_FALSE(set.blocked(face, direction, 4.0));
  EXPECT_TRUE(set.blocked(face, direction, 4.5));
  EXPECT_FALSE(set.blocked(face + 4.0 * direction, direction, infinity));
  EXPECT_EQ(set.nearest({0, 0, 0}, direction).lambda, 2.0);  // from inside
}

TEST(SurfaceSet, EmptySetAndSenselessRaysHitNothing) {
  SurfaceSet set;
  set.build();
  EXPECT_FALSE(set.nearest({0, 0, 0}, {0, 0, 1}).found());
  EXPECT_LT(set.bounds().radius, 0.0);
  const double nan = std::nan("");
  for (int kind = 0; kind < 8; ++kind) {
    Random random(1);
    Twins twins;
    twins.add(some_shape(random, kind), Placement());
    twins.build();
    EXPECT_FALSE(twins.agree({0, 0.01, 0}, {0, 0, 0}, infinity)) << kind;
    EXPECT_FALSE(twins.agree({0, 1, 0}, {nan, 1, 0}, infinity)) << kind;
    EXPECT_FALSE(twins.agree({nan, 1, 0}, {0, -1, 0}, infinity)) << kind;
  }
}

/// Leaves the surface from a resolved point, offset by its error bound, in a direction away from it. A convex
/// surface must not be met again.
TEST(SurfaceSet, ShadowRaysDoNotMeetTheirOwnStart) {
  Random random(11);
  int starts = 0;
  for (int i = 0; i < 60000; ++i) {
    const int kind = i % 8;  // the torus is not convex: it gets the direction of its normal
    SurfaceSet set;
    const Shape shape = some_shape(random, kind);
    set.add(shape, some_placement(random, i % 2 == 0 ? 1.0 : 1e4, i % 3 != 0));
    set.build();
    const double distance = std::pow(10.0, random.uniform(0.0, 9.0));
    const Vec3 along = random.unit();
    const Vec3 origin = set.bounds(0).centre + random.in_cube(0.5) - distance * along;
    const Hit hit = set.nearest(origin, along);
    if (!hit.found()) {
      continue;
    }
    const SurfacePoint point = set.resolve(hit, origin, along);
    const Vec3 start = point.position + point.error_bound * point.normal;
    Vec3 away = random.unit();
    away = glm::dot(away, point.normal) < 0.0 ? -away : away;
    const double tilt = std::pow(10.0, random.uniform(-12.0, 0.0));
    const Vec3 tangent = away - glm::dot(away, point.normal) * point.normal;
    away = kind == 4 ? point.normal : glm::normalize(tangent) + tilt * point.normal;
    const double limit = kind == 4 ? 0.01 : infinity;
    EXPECT_FALSE(set.blocked(start, away, limit)) << "kind " << kind << ", ray " << i << ", tilt " << tilt;
    EXPECT_LT(point.error_bound, 1e-9 * (1.0 + glm::length(point.position)));
    ++starts;
  }
  EXPECT_GT(starts, 20000);
}

TEST(SurfaceSet, BoundsHoldWhatTheyBound) {
  Random random(5);
  SurfaceSet all;
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) {
    SurfaceSet set;
    const Shape shape = some_shape(random, i % 6);
    const Placement placement = some_placement(random, 4.0, i % 2 == 0);
    set.add(shape, placement);
    all.add(shape, placement);
    set.build();
    const BoundingSphere bounds = set.bounds(0);
    EXPECT_EQ(bounds.centre, placement.position());
    const Vec3 along = random.unit();
    const Vec3 origin = bounds.centre + bounds.radius * random.in_cube(0.5) - 10.0 * along;
    const Hit hit = set.nearest(origin, along);
    if (hit.found()) {
      const Vec3 point = set.resolve(hit, origin, along).position;
      EXPECT_LE(glm::length(point - bounds.centre), bounds.radius);
      points.push_back(point);
    }
  }
  ASSERT_GT(points.size(), 1000U);
  all.build();
  const BoundingSphere whole = all.bounds();
  EXPECT_LT(whole.radius, 4.0 * std::sqrt(3.0) + 3.0);
  for (const Vec3& point : points) {
    EXPECT_LE(glm::length(point - whole.centre), whole.radius);
  }
  all.add(plane(), Placement());
  all.build();
  EXPECT_EQ(all.bounds().radius, infinity);
}

TEST(SurfaceSet, SphereBoundIsTight) {
  SurfaceSet set;
  set.add(sphere(2), Placement({1, 2, 3}, {10, 20, 30}, {1, 3, 1}));
  set.build();
  EXPECT_NEAR(set.bounds(0).radius, 6.0, 1e-11);
  EXPECT_NEAR(set.bounds().radius, 6.0, 1e-11);
}

}  // namespace
}  // namespace backlight
