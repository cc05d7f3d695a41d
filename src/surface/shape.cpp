#include "backlight/surface/shape.h"

#include <algorithm>
#include <cmath>

namespace backlight {
namespace {

bool positive(double value) {
  return value > 0.0 && std::isfinite(value);
}

std::string unless_positive(const char* name, double value) {
  return positive(value) ? std::string{} : std::string(name) + " must be positive and finite";
}

std::string first_of(std::string one, std::string other) {
  return one.empty() ? other : one;
}

std::string cone_problem(double radius, double top_radius, double height) {
  const auto fits = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!fits(radius)) {
    return "radius must be finite and not negative";
  }
  if (!fits(top_radius)) {
    return "top_radius must be finite and not negative";
  }
  if (radius == 0.0 && top_radius == 0.0) {
    return "radius and top_radius must not both be zero";
  }
  return unless_positive("height", height);
}

std::string torus_problem(double major, double minor) {
  const std::string sizes = first_of(unless_positive("major", major), unless_positive("minor", minor));
  return sizes.empty() && minor >= major ? "minor must be less than major" : sizes;
}

std::string quadric_problem(const std::array<double, 10>& c) {
  if (!std::all_of(c.begin(), c.end(), [](double value) { return std::isfinite(value); })) {
    return "coefficients must be finite";
  }
  // The last one is a constant: it makes no surface.
  if (std::all_of(c.begin(), c.end() - 1, [](double value) { return value == 0.0; })) {
    return "at least one of the first nine coefficients must not be zero";
  }
  return {};
}

}  // namespace

Shape sphere(double radius) {
  return {ShapeKind::sphere, {radius}};
}
Shape box(Vec3 size) {
  return {ShapeKind::box, {size.x, size.y, size.z}};
}
Shape cylinder(double radius, double height) {
  return {ShapeKind::cylinder, {radius, height}};
}
Shape cone(double radius, double top_radius, double height) {
  return {ShapeKind::cone, {radius, top_radius, height}};
}
Shape torus(double major, double minor) {
  return {ShapeKind::torus, {major, minor}};
}
Shape disk(double radius) {
  return {ShapeKind::disk, {radius}};
}
Shape plane() {
  return {ShapeKind::plane, {}};
}
Shape quadric(const std::array<double, 10>& coefficients) {
  return {ShapeKind::quadric, coefficients};
}

bool is_infinite(const Shape& shape) {
  return shape.kind == ShapeKind::plane || shape.kind == ShapeKind::quadric;
}

std::string problem(const Shape& shape) {
  const auto& value = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
    case ShapeKind::disk:
      return unless_positive("radius", value[0]);
    case ShapeKind::box:
      return positive(value[0]) && positive(value[1]) && positive(value[2])
                 ? std::string{}
                 : std::string("size must be three positive finite numbers");
    case ShapeKind::cylinder:
      return first_of(unless_positive("radius", value[0]), unless_positive("height", value[1]));
    case ShapeKind::cone:
      return cone_problem(value[0], value[1], value[2]);
    case ShapeKind::torus:
      return torus_problem(value[0], value[1]);
    case ShapeKind::plane:
      return {};
    case ShapeKind::quadric:
      return quadric_problem(value);
  }
  return "unknown kind of shape";
}

}  // namespace backlight
