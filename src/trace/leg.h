// A ray's way through mirrors and glass, piece by piece.
#pragma once

#include <cstdint>

#include "backlight/trace/tracer.h"
#include "glass.h"

namespace backlight {

/// A straight piece of a ray's way, and what the pieces between it and the camera make of its light.
struct Leg {
  const Relay* relay = nullptr;  ///< of the frame that passed it on; null: it is the camera's
  CameraRay ray;
  int passed = 0;         ///< how many times it was passed on
  LinearRgb weight{1.0};  ///< of red, green and blue; where colours shift, the factor that all share
  double gamma = 1.0;     ///< the product of those of the pieces before
  LorentzTransform<Rest, Rest> matter = {};  ///< from the relay's frame to the matter's that passed it on
  Media media = {};                          ///< what it goes through
  int contact = -1;         ///< the opaque surface, of `frame`, that stands on the glass it left; or -1
  int frame = -1;           ///< of that
  std::uint64_t route = 0;  ///< by which surface it was passed on, and how: for escape.h
};

/// A leg that meets something that passes it on.
struct PassedOn {
  const Leg& leg;
  const SeenPoint& point;
  DopplerFactor<Camera, Rest> doppler;  ///< from the point's matter to the camera
  double gamma;                         ///< the product of those of all pieces so far
};

/// Sets a pointer for as long as this lives.
template <class T>
class Lent {
 public:
  Lent(T*& to, T& what) : to_(to) { to_ = &what; }
  ~Lent() { to_ = nullptr; }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

 private:
  T*& to_;
};

/// Asks that the ray which goes on from a mirror is not followed, but handed out: to go in a sheet with
/// others.
struct LegWanted {
  const std::vector<bool>* relays;  ///< by frame: those whose rays go in sheets
  int passed;                       ///< of the leg that meets the mirror
  std::optional<Leg> leg = {};      ///< the one that goes on; none: it goes nowhere, or was followed
  int frame = -1;                   ///< of its relay
};

}  // namespace backlight
