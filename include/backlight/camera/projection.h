// From pixels to directions and back: docs/physics.md section 2, Projections.
#pragma once

#include <optional>
#include <string_view>

#include "backlight/base/vector.h"

namespace backlight {

enum class Projection { perspective, equirectangular, mercator, fisheye, cubemap };

/// As in scene files: "perspective", "fisheye"...
std::string_view name_of(Projection projection);
/// The projection of this name, if there is one.
std::optional<Projection> projection_named(std::string_view name);

/// Whether `Lens::fov` says how much it shows.
bool has_fov(Projection projection);

/// A position on the image, in pixels: (0, 0) is the upper left corner of the upper left pixel, y down.
struct ImagePoint {
  double x = 0.0;
  double y = 0.0;
};

/// Of a perspective through a given rectangle, a wall or a screen, instead of one that is straight ahead:
/// pixels are in its plane, of which the lens's forward is the normal (docs/physics.md section 2).
struct ScreenFilm {
  ImagePoint foot;      ///< where the forward direction meets the plane; it may be beyond the image
  double step_x = 0.0;  ///< width of a pixel by the distance of the plane
  double step_y = 0.0;  ///< height of a pixel by the same
};

/// A pinhole's geometry in the camera's rest frame. Axes are orthonormal: right = forward × up.
struct Lens {
  Projection projection = Projection::perspective;
  int width = 1;                     ///< pixels of the full image
  int height = 1;                    ///< pixels of the full image
  double fov = 1.0471975511965976;   ///< perspective, fisheye: full horizontal angle in radians
  std::optional<ScreenFilm> screen;  ///< perspective: in place of `fov`
  Vec3 forward{0.0, 0.0, 1.0};
  Vec3 right{-1.0, 0.0, 0.0};
  Vec3 up{0.0, 1.0, 0.0};
};

/// Perspective: pixels in the plane at distance 1.
ScreenFilm film_of(const Lens& lens);

/// Of a cubemap: three faces across, two down, square, in this order (that of ffmpeg's c3x2), each as it is
/// seen with the camera's up above, or of those above and below, with forward at the near edge.
enum class CubeFace { right, left, up, down, front, back };

/// Whether the image has the shape that six faces need, 3:2.
bool fits_cubemap(int width, int height);

/// The unit looking direction through an image point, in the camera's frame. Empty where the projection
/// shows nothing (outside a fisheye's circle).
std::optional<Vec3> direction_at(const Lens& lens, const ImagePoint& point);

/// Where a direction (unit, camera frame) falls on the image. Empty when it is not on the film. The inverse
/// of direction_at, to a few ulp of the image size.
std::optional<ImagePoint> point_of(const Lens& lens, const Vec3& direction);

/// The point of the looking direction; through a screen, it may be beyond the image.
ImagePoint straight_ahead(const Lens& lens);

/// The solid angle in steradians of one pixel at an image point: the Jacobian of direction_at.
double pixel_solid_angle(const Lens& lens, const ImagePoint& point);

/// The lens's axes from a looking direction and an approximate up, both of any length but zero and not
/// parallel; false if they are.
bool aim(Lens& lens, const Vec3& direction, const Vec3& up);

}  // namespace backlight
