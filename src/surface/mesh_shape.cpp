// The row of meshes in the table of shapes.
#include <algorithm>

#include "backlight/surface/mesh.h"
#include "hierarchy.h"
#include "one_lane.h"
#include "solid_walk.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

MeshView view_of(const Mesh& mesh) {
  static_assert(sizeof(Vec3) == sizeof(double[3]));
  MeshView view{mesh.nodes().data(),
                reinterpret_cast<const double(*)[3]>(mesh.data().places.data()),
                reinterpret_cast<const std::uint32_t(*)[3]>(mesh.data().triangles.data()),
                {},
                {}};
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
  surface_kernels().mesh_crossings({view_of(*shape.mesh), lambda_min}, lines, t, triangle);
  for (std::size_t k = 0; k < lines.count; ++k) {
    results[k] = {};
    if (t[k] < infinite) results[k] = {t[k], false, static_cast<int>(triangle[k])};
  }
}

void blocks(const Shape& shape, const LocalLines& lines, double lambda_min, double lambda_max,
            std::span<bool> results) {
  alignas(64) double t[LocalLines::most], triangle[LocalLines::most];
  surface_kernels().mesh_crossings({view_of(*shape.mesh), lambda_min, true, lambda_max}, lines, t, triangle);
  for (std::size_t k = 0; k < lines.count; ++k) results[k] = t[k] < infinite;
}

void begin_walk(const Shape& shape, const LocalLine& line, double /*from*/, SolidWalk& walk) {
  LocalLines one;
  one.add(line);
  std::vector<Crossing> found;
  MeshWalk<1>::all(view_of(*shape.mesh), one, [&](double t, int triangle) {
    found.push_back({t, triangle, false});
  });
  std::ranges::sort(found, [](const Crossing& a, const Crossing& b) {
    return a.t < b.t || (a.t == b.t && a.part < b.part);
  });
  walk.begin(found);
}

LocalPoint point_on(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const MeshData& data = shape.mesh->data();
  const auto& corner = data.triangles[static_cast<std::size_t>(crossing.part)];
  const Vec3 weight = vec3(MeshWalk<1>::weights(view_of(*shape.mesh), crossing.part, one_lane(line)));
  const auto mean = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return weight.x * a + weight.y * b + weight.z * c;
  };
  const Vec3 &a = data.places[corner[0]], &b = data.places[corner[1]], &c = data.places[corner[2]];
  LocalPoint point;
  point.position = a + (weight.y * (b - a) + weight.z * (c - a));
  const double unit = 1.0 / shape.mesh->radius();  // so that no product over- or underflows
  point.gradient = glm::cross(unit * (b - a), unit * (c - a));
  if (!data.normals.empty()) {
    point.shading = mean(data.normals[corner[0]], data.normals[corner[1]], data.normals[corner[2]]);
    if (glm::dot(point.shading, point.gradient) < 0.0) point.shading = -point.shading;
  }
  if (!data.texture.empty()) {
    const auto &at = data.texture[corner[0]], &bt = data.texture[corner[1]], &ct = data.texture[corner[2]];
    point.u = weight.x * at[0] + weight.y * bt[0] + weight.z * ct[0];
    point.v = weight.x * at[1] + weight.y * bt[1] + weight.z * ct[1];
    if (!(point.v >= 0.0 && point.v <= 1.0)) point.v -= std::floor(point.v);
  }
  if (shape.values[0] == 1.0 && !data.members.empty())
    point.member = static_cast<int>(data.members[static_cast<std::size_t>(crossing.part)]);
  return point;
}

void points_on(const Shape& shape, const LocalLines& lines, std::span<const Crossing> crossings,
               TextureCoordinates /*wanted*/, std::span<LocalPoint> points) {
  for (std::size_t i = 0; i < lines.count; ++i) points[i] = point_on(shape, lines.line(i), crossings[i]);
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
                                .blocks = blocks,
                                .has_many_parts = true,
                                .is_smooth = is_smooth_mesh};

Shape mesh(std::shared_ptr<const Mesh> mesh, bool has_members) {
  Shape shape{ShapeKind::mesh, {has_members ? 1.0 : 0.0}, {}, {}, {}};
  shape.mesh = std::move(mesh);
  return shape;
}

}  // namespace backlight
