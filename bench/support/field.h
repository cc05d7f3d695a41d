// Fields of spheres of any size, for Backlight and for other tracers: what the speed of whole frames is
// measured on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "backlight/base/vector.h"

namespace backlight::bench {

struct FieldSphere {
  Vec3 seen_at{0.0};  ///< where the camera sees its centre at its time 0
  double radius = 0.0;
  Vec3 colour{0.0};
  Vec3 velocity{0.0};  ///< of the world, c = 1; 0 at rest
  /// Of `circling`: a level circle about where it would be seen; angle by the time and at time 0.
  double orbit = 0.0;
  double turning = 0.0;
  double phase = 0.0;
};

/// How many velocities a field has.
enum class FieldMotion {
  at_rest,
  shared,    ///< `frames` of them, each of a whole crowd
  distinct,  ///< one for each sphere
  circling   ///< each on a circle of its own, with the speeds of `distinct`
};

struct FieldRequest {
  int spheres = 200;
  FieldMotion motion = FieldMotion::at_rest;
  int frames = 1;           ///< of `shared`
  double most_gamma = 3.0;  ///< Lorentz factors are spread evenly from 1 to this
};

/// The camera and the lamp of every field; a plane at y = -1 is below all.
inline constexpr Vec3 field_eye{0.0, 3.0, -14.0};
inline constexpr Vec3 field_lamp{-8.0, 12.0, -10.0};

/// The same spheres for the same request, on any machine. From 200 on they get smaller as they become more,
/// so that the picture is about as full.
std::vector<FieldSphere> sphere_field(const FieldRequest& request);

/// Each sphere is placed so that it is seen where it would be at rest: at x(t) = seen_at for the t at which
/// its light leaves, -|seen_at - eye|. With `shared`, the velocity is that of a [frame].
std::string field_for_backlight(const FieldRequest& request);

/// The field at rest, in the language of POV-Ray 3.7: left-handed, so x changes its sign.
std::string field_for_povray(const FieldRequest& request);

}  // namespace backlight::bench
