// Frames as types, and the four-vectors that live in them.
//
// Units: c = 1 everywhere below the scene reader, so times are lengths. Metric (-,+,+,+).
// A frame tag is never instantiated: it only keeps numbers of different frames apart.
#pragma once

#include <cmath>

#include "backlight/base/vector.h"

namespace backlight {

/// The fiducial frame in which a scene is written. Reported emission times are its time.
struct World;

/// The camera's rest frame during the exposure of one image. Its axes are the world's carried by the pure
/// boost to the camera's velocity. Pixel directions and Z are its numbers.
struct Camera;

/// The rest frame of whatever is being looked at: an object, or the sky. To be honest: at run time this is
/// one of many frames; which one is known by the FrameView that the numbers came through.
struct Rest;

/// The rest frame of a light. To be honest: as with Rest, which light is known by where the numbers came
/// from; two lights at different velocities are two frames under one tag.
struct Source;

/// A displacement between two events, in frame F: (t; x).
template <class F>
struct Displacement {
  double t = 0.0;
  Vec3 x{0.0};

  friend Displacement operator+(const Displacement& a, const Displacement& b) {
    return {a.t + b.t, a.x + b.x};
  }
  friend Displacement operator-(const Displacement& a, const Displacement& b) {
    return {a.t - b.t, a.x - b.x};
  }
  friend Displacement operator*(double s, const Displacement& a) { return {s * a.t, s * a.x}; }
};

/// The interval squared, -t² + x²: the same number in every frame.
template <class F>
double interval(const Displacement<F>& d) {
  return glm::dot(d.x, d.x) - d.t * d.t;
}

/// An event, in coordinates of frame F. Two events do not add; their difference is a Displacement.
template <class F>
struct Event {
  double t = 0.0;
  Vec3 x{0.0};

  friend Displacement<F> operator-(const Event& a, const Event& b) { return {a.t - b.t, a.x - b.x}; }
  friend Event operator+(const Event& a, const Displacement<F>& d) { return {a.t + d.t, a.x + d.x}; }
};

/// A past-directed null vector (-|x|; x) in frame F: where light came from. For the camera ray of
/// docs/physics.md equation (4), |x| in an object's frame is 1/D.
template <class F>
struct NullDirection {
  Vec3 x{0.0};
  double length = 0.0;  ///< |x|, kept because boosts know it better than the root of the squares does

  /// The null vector as a displacement.
  [[nodiscard]] Displacement<F> displacement() const { return {-length, x}; }
  friend NullDirection operator*(double s, const NullDirection& n) { return {s * n.x, s * n.length}; }
};

/// The past-directed null vector with this space part.
template <class F>
NullDirection<F> null_direction(const Vec3& x) {
  return {x, glm::length(x)};
}

/// The frequency of one light ray in frame To, divided by its frequency in frame From (D of docs/physics.md
/// equation (2) for To = Camera). Factors chain like the frames they name.
template <class To, class From>
struct DopplerFactor {
  double value = 1.0;
};

template <class To, class Middle, class From>
DopplerFactor<To, From> operator*(DopplerFactor<To, Middle> a, DopplerFactor<Middle, From> b) {
  return {a.value * b.value};
}

}  // namespace backlight
