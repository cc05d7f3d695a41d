// Where a surface stands in its rest frame.
#pragma once

#include <string>

#include "backlight/base/vector.h"

namespace backlight {

/// rest = position + R·S·local, S = diag(scale) and R the rotation by `rotate` degrees about the fixed x
/// axis, then y, then z. A negative scale mirrors. The inverse is built from the factors, not by elimination;
/// angles that are multiples of 90 degrees are exact.
class Placement {
 public:
  Placement() : Placement(Vec3{0.0}) {}
  explicit Placement(Vec3 position, Vec3 rotate_degrees = Vec3{0.0}, Vec3 scale = Vec3{1.0});

  /// The placement of a part within something that is itself placed: first `inner`, then this.
  [[nodiscard]] Placement around(const Placement& inner) const;

  [[nodiscard]] const Vec3& position() const { return position_; }
  /// How much at most each local axis is stretched (with sign, unless one placement is around another).
  [[nodiscard]] const Vec3& scale() const { return scale_; }
  /// R·S: takes displacements (not points) from local to rest coordinates.
  [[nodiscard]] const Mat3& rest_from_local() const { return rest_from_local_; }
  /// S⁻¹·Rᵀ: takes displacements from rest to local coordinates.
  [[nodiscard]] const Mat3& local_from_rest() const { return local_from_rest_; }

 private:
  Vec3 position_;
  Vec3 scale_;
  Mat3 rest_from_local_;
  Mat3 local_from_rest_;
};

/// What is wrong with the placement (a scale of zero, a number that is not finite), or an empty text.
std::string problem(const Placement& placement);

}  // namespace backlight
