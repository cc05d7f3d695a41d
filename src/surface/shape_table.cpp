#include "shape_table.h"

#include <array>
#include <numbers>

#include "csg_solid.h"

namespace backlight {
namespace {

// In the order of ShapeKind.
constexpr std::array<const ShapeMethods*, 12> table{
    &sphere_methods, &box_methods,      &cylinder_methods, &cone_methods,
    &torus_methods,  &disk_methods,     &plane_methods,    &quadric_methods,
    &csg_methods,    &implicit_methods, &mesh_methods,     &travelling_ball_methods};

}  // namespace

const ShapeMethods& methods(ShapeKind kind) {
  return *table[static_cast<std::size_t>(kind)];
}

Crossings crossings_of_one(const Shape& shape, const LocalLine& line, double lambda_min, Wanted /*first*/) {
  LocalLines one;
  one.add(line);
  FirstOnLine first;
  methods(shape).first_crossings(shape, one, lambda_min, {&first, 1});
  Crossings result;
  if (first.t < infinite) result.list[result.count++] = {first.t, first.part, first.unresolved};
  return result;
}

LocalPoint point_of_one(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  LocalLines one;
  one.add(line);
  LocalPoint point;
  methods(shape).points(shape, one, {&crossing, 1}, TextureCoordinates::wanted, {&point, 1});
  return point;
}

bool Presence::at(double own_time) const {
  const std::array<double, 4> values{seconds_per_length * own_time, 0.0, 0.0, 0.0};
  return of_own_time.evaluate(values) > 0.0;
}

std::string unless_positive(const char* name, double value) {
  return value > 0.0 && std::isfinite(value) ? std::string{}
                                             : std::string(name) + " must be positive and finite";
}

std::string first_of(std::string one, std::string other) {
  return one.empty() ? other : one;
}

double longitude(double x, double z) {
  return 0.5 + std::atan2(x, z) * (0.5 * std::numbers::inv_pi);
}

void texture_of_disc(double radius, double side, LocalPoint& point) {
  const double scale = 0.5 / radius;
  point.u = 0.5 + point.position.x * scale;
  point.v = 0.5 + side * point.position.z * scale;
}

void texture_of_body(const Shape& body, LocalPoint& point) {
  const ShapeMethods& has = methods(body);
  if (has.texture == nullptr) return sphere_methods.texture(body, 0, point);
  has.texture(body, has.part_at != nullptr ? has.part_at(body, point.position) : 0, point);
}

void texture_of_place(const Shape& /*shape*/, int /*part*/, LocalPoint& point) {
  point.u = point.position.x;
  point.v = point.position.z;
}

bool is_infinite(const Shape& shape) {
  return std::isinf(methods(shape).bounding_radius(shape, Vec3{1.0}));
}

RootFinder root_finder(const Shape& shape) {
  const auto finder = methods(shape).finder;
  return finder == nullptr ? RootFinder::closed_form : finder(shape);
}

std::string_view name(RootFinder finder) {
  switch (finder) {
    case RootFinder::closed_form:
      return "closed form";
    case RootFinder::quartic:
      return "quartic";
    case RootFinder::interval:
      return "interval + derivative";
    case RootFinder::polynomial:
      return "polynomial";
    case RootFinder::affine:
      return "reduced affine";
    case RootFinder::triangles:
      return "triangles";
    case RootFinder::taylor:
      return "Taylor";
    case RootFinder::solid:
      break;
  }
  return "CSG";
}

std::string root_finding(const Shape& shape) {
  std::string words{name(root_finder(shape))};
  if (!shape.solid) return words;
  std::array<bool, 7> named{};
  const char* before = " of ";
  for (const Solid::Leaf& leaf : shape.solid->leaves()) {
    const RootFinder finder = root_finder(leaf.surface.shape);
    bool& known = named[static_cast<std::size_t>(finder)];
    if (known) continue;
    known = true;
    words += before;
    words += name(finder);
    before = " and ";
  }
  return words;
}

std::string_view name(ShapeKind kind) {
  return kind == ShapeKind::csg ? "solid" : methods(kind).name;
}

bool is_smooth(const Shape& shape) {
  const auto smooth = methods(shape).is_smooth;
  return smooth != nullptr && smooth(shape);
}

bool is_solid(const Shape& shape) {
  return methods(shape).encloses;
}

std::string problem(const Shape& shape) {
  return methods(shape).problem(shape);
}

}  // namespace backlight
