// Lorentz transformations between two frames, and inertial frames in the world.
#pragma once

#include <array>
#include <cmath>

#include "backlight/spacetime/extended.h"
#include "backlight/spacetime/frame.h"

namespace backlight {

/// An event of the world in extended precision, for setting up.
struct ExtendedEvent {
  Extended t;
  ExtendedVec3 x;
  friend bool operator==(const ExtendedEvent&, const ExtendedEvent&) = default;
};

/// An inertial frame as the world sees it: docs/physics.md equation (1).
///
/// event_F = B(celerity) (event_W - origin): the world's axes carried by the pure boost B. Celerity u = γv,
/// because no double v can say γ > 7e7, and 1 - v² loses γ² ulps.
struct InertialFrame {
  ExtendedVec3 celerity;  ///< of the frame in the world
  ExtendedEvent origin;   ///< world event of the frame's own origin at frame time 0
  friend bool operator==(const InertialFrame&, const InertialFrame&) = default;
};

/// γ = √(1 + u²).
Extended lorentz_factor(const ExtendedVec3& celerity);

/// B(u) (t; x): an event's displacement into the frame that moves with celerity u.
ExtendedEvent boost(const ExtendedVec3& celerity, const ExtendedEvent& displacement);

/// The event's coordinates in `frame`.
ExtendedEvent to_frame(const InertialFrame& frame, const ExtendedEvent& world_event);

/// The world event at these coordinates of `frame`.
ExtendedEvent to_world(const InertialFrame& frame, const ExtendedEvent& frame_event);

/// A frame whose velocity and origin are given in the coordinates of `outer` (scene key `within`), as a
/// frame of the world. Its axes are the pure boost of the world's, as every frame's are.
InertialFrame within(const InertialFrame& outer, const InertialFrame& inner);

/// The Lorentz transformation Λ from frame From to frame To, as a boost followed by a rotation of the axes:
/// Λ = R B(w), w the celerity of To as seen from From. (A composition of boosts is not a boost.)
template <class To, class From>
class LorentzTransform {
 public:
  LorentzTransform() = default;

  /// The past-directed null vector n in To (docs/physics.md equations (4) and (14)). A few ulp for any γ: the
  /// small light-cone component is never a difference of large ones.
  [[nodiscard]] NullDirection<To> operator()(const NullDirection<From>& n) const {
    if (identity_) return {n.x, n.length};
    const NullDirection<To> boosted = robust_ ? robust(n) : standard(n);
    return rotated_ ? NullDirection<To>{rotation_ * boosted.x, boosted.length} : boosted;
  }

  /// Any displacement in To. Loses γ ulps where the two terms of the boost cancel.
  [[nodiscard]] Displacement<To> operator()(const Displacement<From>& d) const {
    if (identity_) return {d.t, d.x};
    const double along = glm::dot(celerity_, d.x);
    const Vec3 x = d.x + (along * inverse_gamma_plus_one_ - d.t) * celerity_;
    return {gamma_ * d.t - along, rotated_ ? rotation_ * x : x};
  }

  /// The celerity of To as seen from From, in From's axes.
  [[nodiscard]] const Vec3& celerity() const { return celerity_; }
  [[nodiscard]] double gamma() const { return gamma_; }
  [[nodiscard]] double inverse_gamma_plus_one() const { return inverse_gamma_plus_one_; }
  /// The rotation R of Λ = R B(w).
  [[nodiscard]] const Mat3& rotation() const { return rotation_; }
  /// Whether R is not the unit matrix.
  [[nodiscard]] bool is_rotated() const { return rotated_; }
  /// Whether null vectors take the robust path: γ > robust_gamma.
  [[nodiscard]] bool is_robust() const { return robust_; }
  /// True when the frames are at rest to each other: the transformation then changes no bit.
  [[nodiscard]] bool is_identity() const { return identity_; }

  template <class T, class F>
  friend LorentzTransform<T, F> relative_transform(const ExtendedVec3& to, const ExtendedVec3& from,
                                                   double robust_from);
  template <class T, class F>
  friend LorentzTransform<T, F> boost_by(const Vec3& velocity);

 private:
  [[nodiscard]] NullDirection<To> standard(const NullDirection<From>& n) const {
    const double along = glm::dot(celerity_, n.x);
    return {n.x + (along * inverse_gamma_plus_one_ + n.length) * celerity_, gamma_ * n.length + along};
  }
  [[nodiscard]] NullDirection<To> robust(const NullDirection<From>& n) const;

  Vec3 celerity_{0.0};
  double gamma_ = 1.0;
  double speed_ = 0.0;  // |celerity|
  double inverse_gamma_plus_one_ = 0.5;
  Mat3 rotation_{1.0};
  bool identity_ = true;
  bool rotated_ = false;
  bool robust_ = false;
};

/// The same transformation in extended precision, as a matrix: for the few numbers of a ray that double
/// cannot hold where frames move with a large γ.
class ExtendedTransform {
 public:
  ExtendedTransform() = default;
  /// From the frame of celerity `from` to that of celerity `to` (both of the world).
  ExtendedTransform(const ExtendedVec3& to, const ExtendedVec3& from);

  ExtendedEvent operator()(const ExtendedEvent& displacement) const;

 private:
  std::array<std::array<Extended, 4>, 4> matrix_{};
};

/// The parts of Λ = R B(w), rounded from extended precision.
struct RelativeMotion {
  Vec3 celerity;  ///< w, of To as seen from From
  double gamma;
  double speed;  ///< |w|
  Mat3 rotation;
  bool identity;  ///< the two frames have the same celerity
  bool rotated;   ///< the rotation is not the unit matrix
};

/// Composes B(to) B(from)⁻¹ in extended precision.
RelativeMotion relative_motion(const ExtendedVec3& to, const ExtendedVec3& from);

/// The product a×b with each component a fused 2x2 determinant (Kahan), so that nearly parallel vectors keep
/// the relative accuracy of their own digits.
Vec3 accurate_cross(const Vec3& a, const Vec3& b);

/// Relative γ above which null vectors take the robust path; below, the standard form is good to 1e-12.
inline constexpr double robust_gamma = 30.0;

/// The transformation from the frame of celerity `from` to that of celerity `to` (both of the world).
/// `robust_from`: the relative γ above which it is robust.
template <class To, class From>
LorentzTransform<To, From> relative_transform(const ExtendedVec3& to, const ExtendedVec3& from,
                                              double robust_from = robust_gamma) {
  const RelativeMotion motion = relative_motion(to, from);
  LorentzTransform<To, From> t;
  t.celerity_ = motion.celerity;
  t.gamma_ = motion.gamma;
  t.speed_ = motion.speed;
  t.inverse_gamma_plus_one_ = 1.0 / (1.0 + motion.gamma);
  t.rotation_ = motion.rotation;
  t.identity_ = motion.identity;
  t.rotated_ = motion.rotated;
  t.robust_ = motion.gamma > robust_from;
  return t;
}

/// B of what moves with this velocity in From, |v| < 1, along From's axes.
template <class To, class From>
LorentzTransform<To, From> boost_by(const Vec3& velocity) {
  const double speed = glm::length(velocity);
  LorentzTransform<To, From> t;
  t.gamma_ = 1.0 / std::sqrt((1.0 - speed) * (1.0 + speed));
  t.celerity_ = t.gamma_ * velocity;
  t.speed_ = t.gamma_ * speed;
  t.inverse_gamma_plus_one_ = 1.0 / (1.0 + t.gamma_);
  t.identity_ = speed == 0.0;
  t.robust_ = t.gamma_ > robust_gamma;
  return t;
}

// With U = |w|, n = (-l; x), δ = U l - |w·x| = |w×x|²/(U l + |w·x|) when w·x < 0 (the frame To comes towards
// the place the light came from): the length γl + w·x is l/(γ+U) + δ and the part along ŵ is
// γδ/U - l/(γ+U); docs/physics.md equation (14).
template <class To, class From>
NullDirection<To> LorentzTransform<To, From>::robust(const NullDirection<From>& n) const {
  const Vec3 axis = celerity_ / speed_;
  const double along = glm::dot(celerity_, n.x);
  const Vec3 cross = accurate_cross(celerity_, n.x);
  const Vec3 transverse = glm::cross(cross, axis) / speed_;
  if (along >= 0.0) {
    const double parallel = gamma_ * (along / speed_) + speed_ * n.length;
    return {transverse + parallel * axis, gamma_ * n.length + along};
  }
  const double small = n.length / (gamma_ + speed_);
  const double gap = glm::dot(cross, cross) / (speed_ * n.length - along);
  return {transverse + (gamma_ * (gap / speed_) - small) * axis, small + gap};
}

}  // namespace backlight
