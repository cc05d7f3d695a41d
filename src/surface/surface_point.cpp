#include "surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace backlight {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

SurfacePoint surface_point(const PlacedSurface& surface, const LocalLine& line, const Crossing& crossing) {
  return surface_point(surface, methods(surface.shape).point(surface.shape, line, crossing));
}

SurfacePoint surface_point(const PlacedSurface& surface, const LocalPoint& point) {
  const Vec3 offset = surface.aligned ? point.position : surface.placement.rest_from_local() * point.position;
  SurfacePoint result;
  result.position = surface.placement.position() + offset;
  // A gradient is a covector: it goes by the transposed inverse, which also keeps it outward in a mirror
  // image.
  result.normal = point.gradient;
  if (!surface.aligned) result.normal = glm::transpose(surface.placement.local_from_rest()) * point.gradient;
  if (!surface.aligned || !point.is_unit) result.normal = glm::normalize(result.normal);
  result.u = point.u;
  result.v = point.v;
  result.member = point.member;
  const double reach = std::isfinite(surface.radius) ? surface.radius : 2.0 * glm::length(offset);
  result.error_bound = 16.0 * epsilon * (largest(surface.placement.position()) + reach) +
                       point.error * largest(surface.placement.scale());
  return result;
}

}  // namespace backlight
