#include "backlight/surface/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace backlight {
namespace {

struct SineCosine {
  double sine;
  double cosine;
};

/// Exact at multiples of 90 degrees, where sin(x π/180) is not.
SineCosine of_degrees(double degrees) {
  const double turn = std::remainder(degrees, 360.0);  // -180..180
  const double quarter = std::nearbyint(turn / 90.0);  // -2..2
  const double rest = (turn - 90.0 * quarter) * (std::numbers::pi / 180.0);
  const double sine = std::sin(rest);
  const double cosine = std::cos(rest);
  if (!std::isfinite(quarter)) return {sine, cosine};  // neither is a number
  switch ((static_cast<int>(quarter) + 4) % 4) {
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    case 3:
      return {-cosine, sine};
    default:
      return {sine, cosine};
  }
}

Mat3 rotation(const Vec3& degrees) {
  const SineCosine x = of_degrees(degrees.x);
  const SineCosine y = of_degrees(degrees.y);
  const SineCosine z = of_degrees(degrees.z);
  // GLM's matrices are written column by column.
  const Mat3 about_x{Vec3{1.0, 0.0, 0.0}, Vec3{0.0, x.cosine, x.sine}, Vec3{0.0, -x.sine, x.cosine}};
  const Mat3 about_y{Vec3{y.cosine, 0.0, -y.sine}, Vec3{0.0, 1.0, 0.0}, Vec3{y.sine, 0.0, y.cosine}};
  const Mat3 about_z{Vec3{z.cosine, z.sine, 0.0}, Vec3{-z.sine, z.cosine, 0.0}, Vec3{0.0, 0.0, 1.0}};
  return about_z * about_y * about_x;
}

}  // namespace

Placement::Placement(Vec3 position, Vec3 rotate_degrees, Vec3 scale) : position_(position), scale_(scale) {
  const Mat3 turned = rotation(rotate_degrees);
  rest_from_local_ = Mat3{turned[0] * scale.x, turned[1] * scale.y, turned[2] * scale.z};
  local_from_rest_ = glm::transpose(Mat3{turned[0] / scale.x, turned[1] / scale.y, turned[2] / scale.z});
}

Placement Placement::around(const Placement& inner) const {
  Placement whole;
  whole.position_ = position_ + rest_from_local_ * inner.position_;
  whole.rest_from_local_ = rest_from_local_ * inner.rest_from_local_;
  whole.local_from_rest_ = inner.local_from_rest_ * local_from_rest_;
  const Vec3 outer = glm::abs(scale_);
  whole.scale_ = std::max({outer.x, outer.y, outer.z}) * inner.scale_;
  return whole;
}

std::string problem(const Placement& placement) {
  for (int i = 0; i < 3; ++i) {
    const Vec3& column = placement.rest_from_local()[i];
    if (!std::isfinite(placement.position()[i])) {
      return "position must be finite";
    }
    if (placement.scale()[i] == 0.0 || !std::isfinite(placement.scale()[i])) {
      return "scale must be finite and not zero";
    }
    if (!std::isfinite(column.x) || !std::isfinite(column.y) || !std::isfinite(column.z)) {
      return "rotate must be finite";
    }
  }
  return {};
}

}  // namespace backlight
