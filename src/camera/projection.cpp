#include "backlight/camera/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// In the order of the enumeration.
constexpr std::array<std::string_view, 4> projection_names{"perspective", "equirectangular", "mercator",
                                                           "fisheye"};

Vec3 on_sphere(const Lens& lens, double longitude, double sin_latitude, double cos_latitude) {
  return cos_latitude * (std::cos(longitude) * lens.forward + std::sin(longitude) * lens.right) +
         sin_latitude * lens.up;
}

double longitude_at(const Lens& lens, double x) {
  return (x / lens.width - 0.5) * 2.0 * pi;
}

// A direction's components along forward, right, up.
Vec3 components(const Lens& lens, const Vec3& d) {
  return {glm::dot(d, lens.forward), glm::dot(d, lens.right), glm::dot(d, lens.up)};
}

// The seam behind the camera is both edges of the image; it is shown at the left one.
double longitude_to_x(const Lens& lens, const Vec3& c) {
  const double x = (std::atan2(c.y, c.x) / (2.0 * pi) + 0.5) * lens.width;
  return x < lens.width ? x : 0.0;
}

std::optional<ImagePoint> on_film(const Lens& lens, double x, double y) {
  if (!(x >= 0.0 && x < lens.width && y >= 0.0 && y < lens.height)) return std::nullopt;
  return ImagePoint{x, y};
}

std::optional<Vec3> fisheye_direction(const Lens& lens, const ImagePoint& p) {
  const double half_width = 0.5 * lens.width;
  const double x = (p.x - half_width) / half_width;
  const double y = (0.5 * lens.height - p.y) / half_width;
  const double radius = std::sqrt(x * x + y * y);
  if (radius > 1.0) return std::nullopt;
  if (radius == 0.0) return lens.forward;
  const double angle = radius * 0.5 * lens.fov;
  const double s = std::sin(angle) / radius;
  return std::cos(angle) * lens.forward + s * x * lens.right + s * y * lens.up;
}

std::optional<ImagePoint> fisheye_point(const Lens& lens, const Vec3& c) {
  const double transverse = std::sqrt(c.y * c.y + c.z * c.z);
  const double radius = std::atan2(transverse, c.x) / (0.5 * lens.fov);
  if (radius > 1.0) return std::nullopt;
  const double half_width = 0.5 * lens.width;
  const double k = transverse > 0.0 ? radius / transverse * half_width : 0.0;
  return on_film(lens, half_width + k * c.y, 0.5 * lens.height - k * c.z);
}

}  // namespace

std::string_view name_of(Projection projection) {
  return projection_names[static_cast<std::size_t>(projection)];
}

std::optional<Projection> projection_named(std::string_view name) {
  const auto found = std::ranges::find(projection_names, name);
  if (found == projection_names.end()) return std::nullopt;
  return static_cast<Projection>(found - projection_names.begin());
}

bool has_fov(Projection projection) {
  return projection == Projection::perspective || projection == Projection::fisheye;
}

double perspective_step(const Lens& lens) {
  return 2.0 * std::tan(0.5 * lens.fov) / lens.width;
}

std::optional<Vec3> direction_at(const Lens& lens, const ImagePoint& point) {
  switch (lens.projection) {
    case Projection::perspective: {
      const double step = perspective_step(lens);
      const double x = (point.x - 0.5 * lens.width) * step;
      const double y = (0.5 * lens.height - point.y) * step;
      const Vec3 d = lens.forward + x * lens.right + y * lens.up;
      return d * (1.0 / glm::length(d));
    }
    case Projection::equirectangular: {
      const double latitude = (0.5 - point.y / lens.height) * pi;
      return on_sphere(lens, longitude_at(lens, point.x), std::sin(latitude), std::cos(latitude));
    }
    case Projection::mercator: {
      // The Gudermannian: sin gd(m) = tanh m, cos gd(m) = 1/cosh m.
      const double m = 2.0 * pi * (0.5 - point.y / lens.height) * lens.height / lens.width;
      return on_sphere(lens, longitude_at(lens, point.x), std::tanh(m), 1.0 / std::cosh(m));
    }
    case Projection::fisheye:
      return fisheye_direction(lens, point);
  }
  return std::nullopt;
}

std::optional<ImagePoint> point_of(const Lens& lens, const Vec3& direction) {
  const Vec3 c = components(lens, direction);
  switch (lens.projection) {
    case Projection::perspective: {
      if (c.x <= 0.0) return std::nullopt;
      const double scale = 0.5 * lens.width / std::tan(0.5 * lens.fov) / c.x;
      return on_film(lens, 0.5 * lens.width + scale * c.y, 0.5 * lens.height - scale * c.z);
    }
    case Projection::equirectangular: {
      const double latitude = std::atan2(c.z, std::sqrt(c.x * c.x + c.y * c.y));
      const double y = (0.5 - latitude / pi) * lens.height;
      return on_film(lens, longitude_to_x(lens, c), std::min(y, std::nextafter(lens.height, 0.0)));
    }
    case Projection::mercator: {
      const double m = std::asinh(c.z / std::sqrt(c.x * c.x + c.y * c.y));
      return on_film(lens, longitude_to_x(lens, c), 0.5 * lens.height - m * lens.width / (2.0 * pi));
    }
    case Projection::fisheye:
      return fisheye_point(lens, c);
  }
  return std::nullopt;
}

double pixel_solid_angle(const Lens& lens, const ImagePoint& point) {
  switch (lens.projection) {
    case Projection::perspective: {
      const double edge = 2.0 * std::tan(0.5 * lens.fov) / lens.width;
      const double x = (point.x - 0.5 * lens.width) * edge;
      const double y = (point.y - 0.5 * lens.height) * edge;
      const double square = 1.0 + x * x + y * y;
      return edge * edge / (square * std::sqrt(square));
    }
    case Projection::equirectangular: {
      const double latitude = (0.5 - point.y / lens.height) * pi;
      return 2.0 * pi / lens.width * (pi / lens.height) * std::cos(latitude);
    }
    case Projection::mercator: {
      const double m = 2.0 * pi * (0.5 - point.y / lens.height) * lens.height / lens.width;
      const double edge = 2.0 * pi / lens.width / std::cosh(m);
      return edge * edge;
    }
    case Projection::fisheye: {
      const double half_width = 0.5 * lens.width;
      const double x = (point.x - half_width) / half_width;
      const double y = (point.y - 0.5 * lens.height) / half_width;
      const double angle = std::sqrt(x * x + y * y) * 0.5 * lens.fov;
      const double edge = 0.5 * lens.fov / half_width;
      return edge * edge * (angle > 0.0 ? std::sin(angle) / angle : 1.0);
    }
  }
  return 0.0;
}

bool aim(Lens& lens, const Vec3& looking, const Vec3& upward) {
  const Vec3 direction = of_size_one(looking);
  const Vec3 up = of_size_one(upward);
  const double length = glm::length(direction);
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  const Vec3 forward = direction / length;
  const Vec3 right = glm::cross(forward, up);
  const double right_length = glm::length(right);
  if (!(right_length > 1e-12 * glm::length(up))) return false;
  lens.forward = forward;
  lens.right = right / right_length;
  lens.up = glm::cross(lens.right, forward);
  return true;
}

}  // namespace backlight
