// The row of meshes in the table of shapes.
#include <algorithm>

#include "backlight/surface/mesh.h"
#include "hierarchy.h"
#include "one_lane.h"
#include "solid_walk.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

MeshView view_of(const Shape& shape) {
  static_assert(sizeof(Vec3) == sizeof(double[3]));
  const Mesh& mesh = *shape.mesh;
  const MeshData& data = mesh.data();
  MeshView view{.nodes = mesh.nodes().data(),
                .places = reinterpret_cast<const double(*)[3]>(data.places.data()),
                .triangles = reinterpret_cast<const std::uint32_t(*)[3]>(data.triangles.data()),
                .radius = mesh.radius()};
  if (!data.normals.empty()) view.normals = reinterpret_cast<const double(*)[3]>(data.normals.data());
  if (!data.texture.empty()) view.texture = reinterpret_cast<const double(*)[2]>(data.texture.data());
  if (shape.values[0] == 1.0 && !data.members.empty()) view.members = data.members.data();
  for (int k = 0; k < 3; ++k) {
    view.low[k] = mesh.low()[k];
    view.high[k] = mesh.high()[k];
  }
  return view;
}

std::string problem_of(const Shape& shape) {
  return shape.mesh && shape.mesh->triangles() > 0 ? std::string{}
                                                   : std::string("it has no triangle with an area");
}

Vec3 half_of(const Shape& shape) {
  return glm::max(glm::abs(shape.mesh->low()), glm::abs(shape.mesh->high()));
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  return std::min(glm::length(half_of(shape) * factor),
                  shape.mesh->radius() * std::max({factor.x, factor.y, factor.z}));
}

double half_extent(const Shape& shape, const Extent& e) {
  return std::min(glm::dot(half_of(shape), Vec3{e.x, e.y, e.z}), shape.mesh->radius() * e.sphere);
}

void first_crossings_of(const Shape& shape, const LocalLines& lines, double lambda_min,
                        std::span<FirstOnLine> results) {
  alignas(64) double t[LocalLines::most], triangle[LocalLines::most];
  surface_kernels().mesh_crossings({view_of(shape), lambda_min}, lines, t, triangle);
  for (std::size_t k = 0; k < lines.count; ++k) {
    results[k] = {};
    if (t[k] < infinite) results[k] = {t[k], false, static_cast<int>(triangle[k])};
  }
}

void blocks(const Shape& shape, const LocalLines& lines, double lambda_min, double lambda_max,
            std::span<bool> results) {
  alignas(64) double t[LocalLines::most], triangle[LocalLines::most];
  surface_kernels().mesh_crossings({view_of(shape), lambda_min, true, lambda_max}, lines, t, triangle);
  for (std::size_t k = 0; k < lines.count; ++k) results[k] = t[k] < infinite;
}

void begin_walk(const Shape& shape, const LocalLine& line, double /*from*/, const Stretch& /*within*/,
                SolidWalk& walk) {
  LocalLines one;
  one.add(line);
  std::vector<Crossing> found;
  MeshWalk<1>::all(view_of(shape), one, [&](double t, int triangle) {
    found.push_back({t, triangle, false});
  });
  std::ranges::sort(found, [](const Crossing& a, const Crossing& b) {
    return a.t < b.t || (a.t == b.t && a.part < b.part);
  });
  walk.begin(found);
}

LocalPoint point_on(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const MeshView mesh = view_of(shape);
  const auto number = static_cast<std::uint32_t>(crossing.part);
  const MeshPoints<1>::Point found = MeshPoints<1>::at(mesh, {number}, one_lane(line), true);
  LocalPoint point{.position = vec3(found.position), .gradient = vec3(found.gradient)};
  if (mesh.normals != nullptr) point.shading = vec3(found.shading);
  point.u = found.u.v;
  point.v = found.v.v;
  if (mesh.members != nullptr) point.member = static_cast<int>(mesh.members[number]);
  return point;
}

void points_on(const Shape& shape, const LocalLines& lines, std::span<const Crossing> crossings,
               TextureCoordinates /*wanted*/, std::span<LocalPoint> points) {
  for (std::size_t i = 0; i < lines.count; ++i) points[i] = point_on(shape, lines.line(i), crossings[i]);
}

void sheet_points(const PlacedSurface& surface, const RaySheet& rays, int first, int last,
                  const SheetHits& hits, TextureCoordinates wanted, SheetPoints& points) {
  surface_kernels(rays.instructions)
      .mesh_points(view_of(surface.shape), surface.lanes, rays, first, last, hits,
                   wanted == TextureCoordinates::wanted, points);
}

RootFinder finder_of(const Shape& /*shape*/) {
  return RootFinder::triangles;
}

bool is_smooth_mesh(const Shape& shape) {
  return shape.mesh->is_smooth();
}

}  // namespace

const ShapeMethods mesh_methods{.kind = ShapeKind::mesh,
                                .name = "mesh",
                                .encloses = true,
                                .problem = problem_of,
                                .bounding_radius = bounding_radius,
                                .half_extent = half_extent,
                                .crossings = crossings_of_one,
                                .point = point_on,
                                .begin_walk = begin_walk,
                                .first_crossings = first_crossings_of,
                                .finder = finder_of,
                                .points = points_on,
                                .sheet_points = sheet_points,
                                .blocks = blocks,
                                .has_many_parts = true,
                                .is_smooth = is_smooth_mesh};

Shape mesh(std::shared_ptr<const Mesh> mesh, bool has_members) {
  Shape shape{ShapeKind::mesh, {has_members ? 1.0 : 0.0}, {}, {}, {}};
  shape.mesh = std::move(mesh);
  return shape;
}

}  // namespace backlight
