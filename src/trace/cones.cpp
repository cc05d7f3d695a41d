#include "cones.h"

#include <cmath>
#include <limits>

#include "sheet_scene.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void set(LaneCone& cone, const Vec3& axis, double level) {
  for (int i = 0; i < 3; ++i) cone.axis[i] = axis[i];
  cone.level = level;
}

}  // namespace

LaneCone cone_of(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere) {
  LaneCone cone;
  cone.level = -infinity;
  const auto& motion = view.from_camera;
  const Vec3 turned = glm::transpose(motion.rotation()) * (origin - sphere.centre);
  const Vec3& w = motion.celerity();
  const double square = glm::dot(turned, turned) - sphere.radius * sphere.radius;
  if (!(square > 0.0) || !std::isfinite(square)) return cone;  // the eye is inside
  const double q = std::sqrt(square);
  const double p = glm::dot(turned, w);
  const double level = q * motion.gamma() + p;
  // Room for some forty roundings of numbers of size γ|x'|, here and where the ray is boosted.
  const double room = motion.gamma() * (1e-13 * (q + sphere.radius) + 1e-14 * glm::length(origin));
  set(cone, -turned - (p * motion.inverse_gamma_plus_one() + q) * w, level - room);
  return cone;
}

// From the matrix of Λ in extended precision: n·m >= h with
// m_j = q Λ_0j - Σ x'_i Λ_ij, h = q Λ_00 - Σ x'_i Λ_i0.
LaneCone cone_of(const FarView& far, const BoundingSphere& sphere, const Displacement<Camera>& offset) {
  LaneCone cone;
  cone.level = -infinity;
  const ExtendedEvent moved = far.from_camera({Extended(offset.t), ExtendedVec3{offset.x}});
  const ExtendedVec3 place = far.camera_event.x + moved.x - ExtendedVec3{sphere.centre};
  const double size = glm::length(sphere.centre);
  const Extended radius(sphere.radius * (1.0 + 1e-9) + 1e-12 * size);
  const Extended square = dot(place, place) - radius * radius;
  if (!(double(square) > 0.0)) return cone;
  const Extended q = sqrt(square);
  const auto row = [&](const ExtendedEvent& column) { return q * column.t - dot(place, column.x); };
  const Extended level = row(far.from_camera({Extended(1.0), {}}));
  Vec3 axis;
  axis.x = double(row(far.from_camera({Extended(0.0), {Extended(1.0), Extended(0.0), Extended(0.0)}})));
  axis.y = double(row(far.from_camera({Extended(0.0), {Extended(0.0), Extended(1.0), Extended(0.0)}})));
  axis.z = double(row(far.from_camera({Extended(0.0), {Extended(0.0), Extended(0.0), Extended(1.0)}})));
  set(cone, axis, double(level) - 1e-13 * (std::abs(double(level)) + glm::length(axis)));
  return cone;
}

// The contracted sphere is inside a sphere of its rest size.
LaneCone cone_of_now(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere) {
  LaneCone cone;
  cone.level = -infinity;
  const auto& motion = view.from_camera;
  const Vec3 turned = glm::transpose(motion.rotation()) * (sphere.centre - origin);
  const Vec3& w = motion.celerity();
  const double along = glm::dot(turned, w);
  const Vec3 now = turned - (along * motion.inverse_gamma_plus_one() / motion.gamma()) * w;
  const double radius = sphere.radius + 1e-12 * motion.gamma() * glm::length(turned);
  const double square = glm::dot(now, now) - radius * radius;
  if (!(square > 0.0) || !std::isfinite(square)) return cone;
  set(cone, now, std::sqrt(square) * (1.0 - 1e-13));
  return cone;
}

Event<Rest> eye_event(const FrameView& view, const CameraView& camera, int eye) {
  Event<Rest> event = view.camera_event;
  if (eye != 0) {
    const Displacement<Rest> moved = view.from_camera(eye_offset(camera, eye));
    event.x += moved.x;
    event.t += moved.t;
  }
  return event;
}

}  // namespace backlight
