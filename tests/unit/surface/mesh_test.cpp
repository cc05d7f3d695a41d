// Meshes: against all triangles one by one, watertight, against the shapes that they are meshes of, in
// solids.
#include "backlight/surface/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

#include "backlight/surface/solid.h"
#include "backlight/surface/surface_set.h"
#include "meshes.h"

namespace backlight {
namespace {

using test::box_mesh;
using test::icosphere;
using test::torus_mesh;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 18446744073709551616.0);
  }
  Vec3 in_cube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  std::mt19937_64 engine_;
};

Shape shape_of(const MeshData& data) {
  return mesh(std::make_shared<const Mesh>(data));
}

SurfaceSet set_of(const Shape& shape, const Placement& placement = {}) {
  SurfaceSet set;
  set.add(shape, placement);
  set.build();
  return set;
}

RaySheet sheet_of(const std::vector<Vec3>& origins, const std::vector<Vec3>& directions,
                  InstructionSet width) {
  RaySheet sheet;
  sheet.padded = static_cast<int>((origins.size() + 7) / 8 * 8);
  sheet.instructions = width;
  for (int i = 0; i < sheet.padded; ++i) {
    const std::size_t from = std::min(static_cast<std::size_t>(i), origins.size() - 1);
    for (int k = 0; k < 3; ++k) {
      sheet.origin[k][i] = origins[from][k];
      sheet.direction[k][i] = directions[from][k];
    }
    sheet.length[i] = glm::length(directions[from]);
    sheet.start_time[i] = sheet.time_rate[i] = 0.0;
  }
  return sheet;
}

std::uint64_t bits_of(std::size_t count) {
  return count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
}

/// Where a line meets one triangle, by Cramer's rule in extended precision; nothing within rounding of an
/// edge.
struct Oracle {
  bool met = false;
  bool sure = true;
  long double lambda = 0.0L;
};

Oracle oracle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& origin, const Vec3& direction) {
  using L = glm::vec<3, long double>;
  const L d(direction), e1 = L(b) - L(a), e2 = L(c) - L(a), s = L(origin) - L(a);
  const L p = glm::cross(d, e2);
  const long double det = glm::dot(e1, p);
  const L q = glm::cross(s, e1);
  const long double u = glm::dot(s, p), v = glm::dot(d, q), w = det - u - v;
  Oracle result;
  const long double noise = 1e-12L * (std::abs(det) + glm::length(p) * glm::length(s));
  result.sure = std::abs(u) > noise && std::abs(v) > noise && std::abs(w) > noise;
  result.met = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
  if (result.met) result.lambda = glm::dot(e2, q) / det;
  return result;
}

MeshData soup(Random& random, std::size_t count) {
  MeshData data;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 at = random.in_cube(1.0);
    for (int k = 0; k < 3; ++k) data.places.push_back(at + random.in_cube(random.uniform(0.01, 0.4)));
    data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return data;
}

TEST(Mesh, MeetsTheFirstOfAllTriangles) {
  Random random(1);
  int hits = 0;
  for (const std::size_t count : {1U, 2U, 9U, 300U}) {
    const auto made = std::make_shared<const Mesh>(soup(random, count));
    const SurfaceSet set = set_of(mesh(made), Placement(made->centre()));
    for (int i = 0; i < 12000; ++i) {
      const Vec3 origin = random.in_cube(2.0), direction = random.in_cube(1.0);
      Oracle first;
      bool sure = true;
      for (const auto& [a, b, c] : made->data().triangles) {
        const auto& places = made->data().places;
        const Oracle one = oracle(places[a], places[b], places[c], origin - made->centre(), direction);
        sure = sure && one.sure;
        if (one.met && one.lambda > 0.0L && (!first.met || one.lambda < first.lambda)) first = one;
      }
      if (!sure) continue;
      const Hit hit = set.nearest(origin, direction);
      ASSERT_EQ(hit.found(), first.met);
      EXPECT_EQ(set.blocked(origin, direction, 1e300), first.met);
      if (!first.met) continue;
      ++hits;
      EXPECT_NEAR(hit.lambda, static_cast<double>(first.lambda), 1e-13 * (1.0 + hit.lambda));
      EXPECT_TRUE(set.blocked(origin, direction, hit.lambda * (1.0 + 1e-10)));
      EXPECT_FALSE(set.blocked(origin, direction, hit.lambda * (1.0 - 1e-10)));
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(Mesh, HasTheSameBitsInSheetsOfEveryWidth) {
  Random random(2);
  const std::vector<Placement> placements{Placement{},
                                          Placement(Vec3{30, 20, -10}, Vec3{10, 20, 30}, Vec3{1, 2, -0.5})};
  int hits = 0;
  for (const Placement& placement : placements) {
    const SurfaceSet set = set_of(shape_of(icosphere(4, 1.0)), placement);
    for (int round = 0; round < 60; ++round) {
      std::vector<Vec3> origins, directions;
      const Vec3 from = placement.position() + random.in_cube(round % 3 == 0 ? 0.2 : 4.0);
      const double spread = round % 2 == 0 ? 0.05 : 2.0;
      for (int i = 0; i < 1 + round; ++i) {
        origins.push_back(from);
        directions.push_back(placement.position() - from + random.in_cube(spread));
      }
      SheetHits reference;
      reference.clear(64);
      for (const InstructionSet width :
           {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::widest}) {
        const RaySheet sheet = sheet_of(origins, directions, width);
        SheetHits found;
        found.clear(64);
        set.nearest(sheet, bits_of(origins.size()), 0.0, found);
        const std::uint64_t blocked = set.blocked(sheet, bits_of(origins.size()), 3.0);
        for (std::size_t i = 0; i < origins.size(); ++i) {
          const Hit hit = set.nearest(origins[i], directions[i], std::numeric_limits<double>::infinity(), {},
                                      Search::every_surface);
          EXPECT_EQ(found.lambda[i], hit.lambda);
          EXPECT_EQ((blocked >> i & 1U) != 0, set.blocked(origins[i], directions[i], 3.0));
          if (!hit.found()) continue;
          ++hits;
          EXPECT_EQ(found.part_of(static_cast<int>(i)), hit.part);
          EXPECT_EQ(found.along[i], hit.along);
        }
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

/// Rays from inside of a closed mesh to points on its edges and to its corners: each meets it.
void expect_no_leak(const MeshData& data, const Placement& placement, int sheets, unsigned seed) {
  Random random(seed);
  const SurfaceSet set = set_of(shape_of(data), placement);
  const auto in_frame = [&](const Vec3& local) {
    return placement.position() + placement.rest_from_local() * local;
  };
  // scripts/leaks.sh asks for many times as many.
  const char* const times = std::getenv("BACKLIGHT_LEAK_TIMES");
  if (times != nullptr) sheets *= std::atoi(times);
  int leaks = 0;
  for (int s = 0; s < sheets; ++s) {
    std::vector<Vec3> origins, directions;
    const auto& [a, b, c] = data.triangles[random.index(data.triangles.size())];
    const std::array<Vec3, 3> corners{data.places[a], data.places[b], data.places[c]};
    // Inside: a little below the middle of another face.
    const auto& [d, e, f] = data.triangles[random.index(data.triangles.size())];
    const Vec3 middle = (data.places[d] + data.places[e] + data.places[f]) / 3.0;
    const double size = glm::length(data.places[e] - data.places[d]);
    const Vec3 normal =
        glm::cross((data.places[e] - data.places[d]) / size, (data.places[f] - data.places[d]) / size);
    const Vec3 inside = in_frame(middle - 1e-3 * size * glm::normalize(normal));
    for (int i = 0; i < 64; ++i) {
      const std::size_t k = random.index(3);
      const double along = i % 4 == 0 ? 0.0 : random.uniform(0.0, 1.0);
      origins.push_back(inside);
      directions.push_back(in_frame(corners[k] + along * (corners[(k + 1) % 3] - corners[k])) - inside);
    }
    SheetHits found;
    found.clear(64);
    set.nearest(sheet_of(origins, directions, InstructionSet::widest), ~std::uint64_t{0}, 0.0, found);
    for (int i = 0; i < 64; ++i) leaks += found.who[i] < 0.0 ? 1 : 0;
  }
  EXPECT_EQ(leaks, 0);
}

TEST(Mesh, HasNoLeaksAtEdgesAndCorners) {
  expect_no_leak(icosphere(3, 1.0), Placement{}, 2000, 1);
  expect_no_leak(icosphere(3, 1.0), Placement(Vec3{1e6, -2e5, 7}, Vec3{10, 20, 30}, Vec3{1, 1e-3, 30}), 2000,
                 2);
  expect_no_leak(torus_mesh(1.0, 0.3, 60, 30), Placement{}, 2000, 3);
  expect_no_leak(box_mesh({1, 2, 3}), Placement{}, 4000, 4);  // along the axes: corners share coordinates
  expect_no_leak(icosphere(2, 1e-90), Placement{}, 1000, 5);
  expect_no_leak(icosphere(2, 1e90), Placement{}, 1000, 6);
  expect_no_leak(icosphere(1, 1.0), Placement(Vec3{0.0}, Vec3{90, 0, 0}, Vec3{1, 1, 1}), 4000, 7);
}

TEST(Mesh, LetsNoRayThroughFromAfar) {
  // From 10⁹ sizes away, at corners whose faces all look there.
  Random random(5);
  const MeshData data = icosphere(3, 1.0);
  const SurfaceSet set = set_of(shape_of(data));
  for (int i = 0; i < 20000; ++i) {
    const Vec3 corner = data.places[random.index(data.places.size())];
    const Vec3 from = 1e9 * (corner + random.in_cube(0.3));
    const Hit hit = set.nearest(from, corner - from);
    ASSERT_TRUE(hit.found());
    const SurfacePoint point = set.resolve(hit, from, corner - from);
    EXPECT_LT(glm::length(point.position - corner), 1e-6);  // as exactly as the direction is told
  }
}

TEST(Mesh, IsTheBoxThatItIsAMeshOf) {
  Random random(6);
  const Vec3 size{1.0, 2.0, 0.7};
  const Placement placement(Vec3{0.3, 0.2, 0.1}, Vec3{10, 20, 30});
  const SurfaceSet faces = set_of(shape_of(box_mesh(size)), placement), solid = set_of(box(size), placement);
  int hits = 0;
  for (int i = 0; i < 60000; ++i) {
    const Vec3 from = random.in_cube(3.0), direction = random.in_cube(1.0);
    const Hit one = faces.nearest(from, direction), other = solid.nearest(from, direction);
    ASSERT_EQ(one.found(), other.found());
    if (!one.found()) continue;
    ++hits;
    EXPECT_NEAR(one.lambda, other.lambda, 1e-13 * (1.0 + other.lambda));
    const SurfacePoint p = faces.resolve(one, from, direction), q = solid.resolve(other, from, direction);
    EXPECT_LT(glm::length(p.position - q.position), p.error_bound + q.error_bound);
    EXPECT_LT(glm::length(p.normal - q.normal), 1e-14);
    EXPECT_EQ(p.shading_normal, p.normal);
  }
  EXPECT_GT(hits, 2000);
}

TEST(Mesh, IsWithinTheSagittaOfTheSphere) {
  Random random(7);
  const MeshData data = icosphere(5, 1.0);
  double longest = 0.0;
  for (const auto& [a, b, c] : data.triangles)
    longest = std::max(longest, glm::length(data.places[a] - data.places[b]));
  const double sagitta = longest * longest / 6.0;  // of a face's circumscribed circle, of radius edge/√3
  const SurfaceSet faces = set_of(shape_of(data)), ball = set_of(sphere(1.0));
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = 3.0 * glm::normalize(random.in_cube(1.0)), to = random.in_cube(0.5);
    const Vec3 direction = glm::normalize(to - from);
    const Hit one = faces.nearest(from, direction), other = ball.nearest(from, direction);
    ASSERT_TRUE(one.found() && other.found());
    ++hits;
    const double cosine = -glm::dot(ball.resolve(other, from, direction).normal, direction);
    EXPECT_GE(one.lambda, other.lambda - 1e-14);
    EXPECT_LE(one.lambda, other.lambda + sagitta / cosine * 1.1);
  }
  EXPECT_EQ(hits, 20000);
}

TEST(Mesh, LeavesItsOwnSurfaceWithoutAShadow) {
  Random random(8);
  const SurfaceSet set = set_of(shape_of(icosphere(4, 1.0)), Placement(Vec3{100, 0, 0}));
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = Vec3{100, 0, 0} + 4.0 * glm::normalize(random.in_cube(1.0));
    const Vec3 direction = Vec3{100, 0, 0} + random.in_cube(0.5) - from;
    const Hit hit = set.nearest(from, direction);
    ASSERT_TRUE(hit.found());
    const SurfacePoint point = set.resolve(hit, from, direction);
    const Vec3 start = point.position + point.error_bound * point.normal;
    EXPECT_FALSE(set.blocked(start, point.normal, 10.0));
    EXPECT_TRUE(set.blocked(start, -point.normal, 10.0));
  }
}

TEST(Mesh, KnowsWhetherItIsClosed) {
  EXPECT_TRUE(Mesh(icosphere(2, 1.0)).is_closed());
  EXPECT_TRUE(Mesh(torus_mesh(1, 0.3, 8, 5)).is_closed());
  MeshData open = box_mesh(Vec3{1.0});
  open.triangles.pop_back();
  EXPECT_FALSE(Mesh(open).is_closed());
  MeshData turned = box_mesh(Vec3{1.0});
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_FALSE(Mesh(turned).is_closed());
  // Corners of their own for each face are the same places.
  MeshData apart;
  for (const auto& triangle : box_mesh(Vec3{1.0}).triangles) {
    const auto first = static_cast<std::uint32_t>(apart.places.size());
    for (const std::uint32_t corner : triangle) apart.places.push_back(box_mesh(Vec3{1.0}).places[corner]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(Mesh(apart).is_closed());
}

TEST(Mesh, DropsTrianglesWithoutAnArea) {
  MeshData data = box_mesh(Vec3{1.0});
  data.triangles.push_back({0, 0, 1});
  data.triangles.push_back({0, 1, 1});
  data.places.push_back({-0.5, -0.5, 0.25});  // on the edge from 0 to 1
  data.triangles.push_back({0, 1, 8});
  const Mesh mesh(data);
  EXPECT_EQ(mesh.dropped(), 3U);
  EXPECT_EQ(mesh.triangles(), 12U);
  EXPECT_FALSE(problem(backlight::mesh(std::make_shared<const Mesh>(MeshData{}))).empty());
}

TEST(Mesh, KeepsItsPlaceWhenItLiesFarOff) {
  MeshData data = icosphere(3, 1.0);
  for (Vec3& place : data.places) place += Vec3{1000.0, 0.0, 0.0};
  const auto made = std::make_shared<const Mesh>(data);
  EXPECT_LT(made->radius(), 1.2);
  const SurfaceSet set = set_of(mesh(made), Placement(made->centre()));
  const Hit hit = set.nearest({1000, 0.01, -5}, {0, 0, 1});
  ASSERT_TRUE(hit.found());
  EXPECT_NEAR(hit.lambda, 4.0, 0.01);
}

TEST(SmoothNormals, AreThoseOfTheSphereAndKeepCreases) {
  MeshData ball = icosphere(4, 2.0);
  add_smooth_normals(ball, 0.7);
  EXPECT_EQ(ball.places.size(), icosphere(4, 2.0).places.size());
  for (std::size_t i = 0; i < ball.places.size(); ++i)
    EXPECT_LT(glm::length(glm::normalize(ball.normals[i]) - glm::normalize(ball.places[i])), 4e-3);
  MeshData cube = box_mesh(Vec3{1.0});
  add_smooth_normals(cube, 0.7);
  EXPECT_EQ(cube.places.size(), 24U);
  for (const auto& [a, b, c] : cube.triangles) {
    const Vec3 own =
        glm::normalize(glm::cross(cube.places[b] - cube.places[a], cube.places[c] - cube.places[a]));
    for (const std::uint32_t corner : {a, b, c})
      EXPECT_LT(glm::length(glm::normalize(cube.normals[corner]) - own), 1e-14);
  }
  const SurfaceSet set = set_of(shape_of(ball));
  const Hit hit = set.nearest({0.3, 0.2, -5}, {0, 0, 1});
  const SurfacePoint point = set.resolve(hit, {0.3, 0.2, -5}, {0, 0, 1});
  EXPECT_LT(glm::length(point.shading_normal - glm::normalize(point.position)), 4e-3);
  EXPECT_NEAR(glm::length(point.shading_normal), 1.0, 1e-14);
  EXPECT_TRUE(set.is_smooth(0));
}

TEST(MeshSolids, AreCutAsTheShapesAre) {
  Random random(9);
  const auto difference = [&](const Shape& body) {
    SolidTree tree;
    tree.operation = SolidOperation::difference;
    SolidTree first, second;
    first.shape = body;
    second.shape = sphere(0.6);
    second.placement = Placement(Vec3{0.5, 0.4, -0.3});
    tree.parts = {first, second};
    return set_of(csg(tree));
  };
  const Vec3 size{1.0, 1.1, 0.9};
  const SurfaceSet of_mesh = difference(shape_of(box_mesh(size))), of_box = difference(box(size));
  int hits = 0, misses = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = random.in_cube(2.0), direction = random.in_cube(1.0);
    const Hit one = of_mesh.nearest(from, direction), other = of_box.nearest(from, direction);
    ASSERT_EQ(one.found(), other.found());
    (one.found() ? hits : misses) += 1;
    EXPECT_EQ(of_mesh.blocked(from, direction, 2.0), of_box.blocked(from, direction, 2.0));
    if (!one.found()) continue;
    EXPECT_NEAR(one.lambda, other.lambda, 1e-12 * (1.0 + other.lambda));
    const SurfacePoint p = of_mesh.resolve(one, from, direction), q = of_box.resolve(other, from, direction);
    EXPECT_LT(glm::length(p.normal - q.normal), 1e-12);
    EXPECT_LT(glm::length(p.position - q.position), 1e-13);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 2000);
}

}  // namespace
}  // namespace backlight
