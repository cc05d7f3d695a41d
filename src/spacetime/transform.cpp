#include "backlight/spacetime/transform.h"

namespace backlight {
namespace {

using Matrix4 = std::array<std::array<Extended, 4>, 4>;

// The matrix of B(u): rows and columns (t, x, y, z).
Matrix4 boost_matrix(const ExtendedVec3& u) {
  const Extended gamma = lorentz_factor(u);
  const Extended k = Extended(1.0) / (Extended(1.0) + gamma);
  Matrix4 m{};
  m[0][0] = gamma;
  for (std::size_t i = 0; i < 3; ++i) {
    m[0][i + 1] = m[i + 1][0] = -u.v[i];
    for (std::size_t j = 0; j < 3; ++j) {
      m[i + 1][j + 1] = Extended(i == j ? 1.0 : 0.0) + k * u.v[i] * u.v[j];
    }
  }
  return m;
}

Matrix4 product(const Matrix4& a, const Matrix4& b) {
  Matrix4 m{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) m[i][j] = m[i][j] + a[i][k] * b[k][j];
  return m;
}

ExtendedVec3 cross(const ExtendedVec3& a, const ExtendedVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The rotation R of B(to) B(from)⁻¹ = R B(w): docs/physics.md equation (1a). Neither part of the quaternion
// is a difference of large numbers of which a small one is left, as the elements of the product R = Λ B(w)⁻¹
// are: those lose γ² ulps of the relative γ, and rays that come from γ lengths away γ³.
Mat3 wigner_rotation(const ExtendedVec3& to, const ExtendedVec3& from) {
  const Extended one(1.0);
  const Extended s = (one + lorentz_factor(to)) * (one + lorentz_factor(from)) - dot(to, from);
  const ExtendedVec3 v = cross(to, from);
  const Extended square = dot(v, v);
  const Extended scale = Extended(2.0) / (s * s + square);
  Mat3 r{1.0};
  for (int row = 0; row < 3; ++row) {
    r[row][row] = double(one + scale * (v[row] * v[row] - square));
    const int next = (row + 1) % 3;
    const int last = (row + 2) % 3;
    r[last][next] = double(scale * (v[next] * v[last] - s * v[row]));
    r[next][last] = double(scale * (v[next] * v[last] + s * v[row]));
  }
  return r;
}

double determinant2(double a, double b, double c, double d) {  // a d - b c, Kahan
  const double bc = b * c;
  const double error = std::fma(-b, c, bc);
  return std::fma(a, d, -bc) + error;
}

}  // namespace

Extended lorentz_factor(const ExtendedVec3& celerity) {
  return sqrt(Extended(1.0) + dot(celerity, celerity));
}

ExtendedEvent boost(const ExtendedVec3& celerity, const ExtendedEvent& displacement) {
  const Extended gamma = lorentz_factor(celerity);
  const Extended along = dot(celerity, displacement.x);
  const Extended step = along / (Extended(1.0) + gamma) - displacement.t;
  return {gamma * displacement.t - along, displacement.x + step * celerity};
}

ExtendedEvent to_frame(const InertialFrame& frame, const ExtendedEvent& world_event) {
  return boost(frame.celerity, {world_event.t - frame.origin.t, world_event.x - frame.origin.x});
}

ExtendedEvent to_world(const InertialFrame& frame, const ExtendedEvent& frame_event) {
  const ExtendedEvent d = boost(Extended(-1.0) * frame.celerity, frame_event);
  return {d.t + frame.origin.t, d.x + frame.origin.x};
}

InertialFrame within(const InertialFrame& outer, const InertialFrame& inner) {
  // The inner frame's four-velocity (γ; u) carried from the outer frame's coordinates to the world's.
  const ExtendedEvent four_velocity =
      boost(Extended(-1.0) * outer.celerity, {lorentz_factor(inner.celerity), inner.celerity});
  return {four_velocity.x, to_world(outer, inner.origin)};
}

ExtendedTransform::ExtendedTransform(const ExtendedVec3& to, const ExtendedVec3& from)
    : matrix_(boost_matrix(to)) {
  if (from != ExtendedVec3{}) matrix_ = product(matrix_, boost_matrix(Extended(-1.0) * from));
}

ExtendedEvent ExtendedTransform::operator()(const ExtendedEvent& d) const {
  const auto row = [&](std::size_t i) {
    const auto& m = matrix_[i];
    return m[0] * d.t + m[1] * d.x[0] + m[2] * d.x[1] + m[3] * d.x[2];
  };
  return {row(0), {row(1), row(2), row(3)}};
}

RelativeMotion relative_motion(const ExtendedVec3& to, const ExtendedVec3& from) {
  if (to == from) return {Vec3{0.0}, 1.0, 0.0, Mat3{1.0}, true, false};
  const ExtendedVec3 rest;
  if (to == rest || from == rest) {  // a pure boost: no rotation, to the last bit
    const ExtendedVec3 u = from == rest ? to : Extended(-1.0) * from;
    return {u.rounded(), double(lorentz_factor(u)), double(sqrt(dot(u, u))), Mat3{1.0}, false, false};
  }
  // w is the space part of the four-velocity of To, (γ; u), carried to From.
  const ExtendedEvent four_velocity = boost(from, {lorentz_factor(to), to});
  RelativeMotion motion;
  motion.celerity = four_velocity.x.rounded();
  motion.gamma = double(four_velocity.t);
  motion.speed = double(sqrt(dot(four_velocity.x, four_velocity.x)));
  motion.rotation = wigner_rotation(to, from);
  motion.identity = motion.speed == 0.0;
  motion.rotated = motion.rotation != Mat3{1.0};
  return motion;
}

Vec3 accurate_cross(const Vec3& a, const Vec3& b) {
  return {determinant2(a.y, a.z, b.y, b.z), determinant2(a.z, a.x, b.z, b.x),
          determinant2(a.x, a.y, b.x, b.y)};
}

}  // namespace backlight
