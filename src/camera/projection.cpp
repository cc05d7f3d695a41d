#include "backlight/camera/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// In the order of the enumeration.
constexpr std::array<std::string_view, 5> projection_names{"perspective", "equirectangular", "mercator",
                                                           "fisheye", "cubemap"};

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

// A face's own axes by those of the camera: where it looks, its right and its up.
struct FaceAxes {
  Vec3 forward, right, up;
};

FaceAxes axes_of(const Lens& lens, CubeFace face) {
  switch (face) {
    case CubeFace::right:
      return {lens.right, -lens.forward, lens.up};
    case CubeFace::left:
      return {-lens.right, lens.forward, lens.up};
    case CubeFace::up:
      return {lens.up, lens.right, -lens.forward};
    case CubeFace::down:
      return {-lens.up, lens.right, lens.forward};
    case CubeFace::back:
      return {-lens.forward, -lens.right, lens.up};
    case CubeFace::front:
      break;
  }
  return {lens.forward, lens.right, lens.up};
}

double face_edge(const Lens& lens) {
  return lens.width / 3.0;
}

Vec3 cube_direction(const Lens& lens, const ImagePoint& p) {
  const double edge = face_edge(lens);
  const double column = std::clamp(std::floor(p.x / edge), 0.0, 2.0);
  const double row = std::clamp(std::floor(p.y / edge), 0.0, 1.0);
  const FaceAxes face = axes_of(lens, static_cast<CubeFace>(static_cast<int>(3.0 * row + column)));
  const double x = 2.0 * (p.x - column * edge) / edge - 1.0;
  const double y = 1.0 - 2.0 * (p.y - row * edge) / edge;
  const Vec3 d = face.forward + x * face.right + y * face.up;
  return d * (1.0 / glm::length(d));
}

std::optional<ImagePoint> cube_point(const Lens& lens, const Vec3& direction) {
  int nearest = 0;
  double greatest = -2.0;
  for (int i = 0; i < 6; ++i) {
    const double along = glm::dot(direction, axes_of(lens, static_cast<CubeFace>(i)).forward);
    if (along > greatest) {
      greatest = along;
      nearest = i;
    }
  }
  const FaceAxes face = axes_of(lens, static_cast<CubeFace>(nearest));
  const double edge = face_edge(lens);
  // On the rim, within the face.
  const auto within = [edge](double place) { return std::clamp(place, 0.0, std::nextafter(edge, 0.0)); };
  const double x = within((glm::dot(direction, face.right) / greatest + 1.0) * 0.5 * edge);
  const double y = within((1.0 - glm::dot(direction, face.up) / greatest) * 0.5 * edge);
  return on_film(lens, nearest % 3 * edge + x, nearest / 3 * edge + y);
}

double flat_solid_angle(double x, double y, double step_x, double step_y) {
  const double square = 1.0 + x * x + y * y;
  return step_x * step_y / (square * std::sqrt(square));
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

ScreenFilm film_of(const Lens& lens) {
  if (lens.screen) return *lens.screen;
  const double step = 2.0 * std::tan(0.5 * lens.fov) / lens.width;
  return {{0.5 * lens.width, 0.5 * lens.height}, step, step};
}

bool fits_cubemap(int width, int height) {
  return width % 3 == 0 && std::int64_t{2} * width == std::int64_t{3} * height;
}

std::optional<Vec3> direction_at(const Lens& lens, const ImagePoint& point) {
  switch (lens.projection) {
    case Projection::perspective: {
      const ScreenFilm film = film_of(lens);
      const double x = (point.x - film.foot.x) * film.step_x;
      const double y = (film.foot.y - point.y) * film.step_y;
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
    case Projection::cubemap:
      return cube_direction(lens, point);
  }
  return std::nullopt;
}

std::optional<ImagePoint> point_of(const Lens& lens, const Vec3& direction) {
  const Vec3 c = components(lens, direction);
  switch (lens.projection) {
    case Projection::perspective: {
      if (c.x <= 0.0) return std::nullopt;
      if (lens.screen) {
        const ScreenFilm& film = *lens.screen;
        return on_film(lens, film.foot.x + c.y / c.x / film.step_x, film.foot.y - c.z / c.x / film.step_y);
      }
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
    case Projection::cubemap:
      return cube_point(lens, direction);
  }
  return std::nullopt;
}

ImagePoint straight_ahead(const Lens& lens) {
  if (lens.screen) return lens.screen->foot;
  return {0.5 * lens.width, (lens.projection == Projection::cubemap ? 0.75 : 0.5) * lens.height};
}

double pixel_solid_angle(const Lens& lens, const ImagePoint& point) {
  switch (lens.projection) {
    case Projection::perspective: {
      const ScreenFilm film = film_of(lens);
      return flat_solid_angle((point.x - film.foot.x) * film.step_x, (point.y - film.foot.y) * film.step_y,
                              film.step_x, film.step_y);
    }
    case Projection::cubemap: {
      const double edge = face_edge(lens);
      const auto place = [edge](double along) {
        return 2.0 * (along / edge - std::floor(along / edge)) - 1.0;
      };
      return flat_solid_angle(place(point.x), place(point.y), 2.0 / edge, 2.0 / edge);
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
