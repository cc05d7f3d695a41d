// A ray's way from mirror to mirror, piece by piece.
#pragma once

#include "backlight/trace/tracer.h"

namespace backlight {

/// A straight piece of a ray's way, and what the pieces between it and the camera make of its light.
struct Leg {
  const Relay* relay = nullptr;  ///< of the frame that passed it on; null: it is the camera's
  CameraRay ray;
  int passed = 0;  ///< how many times it was passed on
  LinearRgb weight{
      1.0};            ///< of red, green and blue; where colours shift, the factor that all wavelengths share
  double gamma = 1.0;  ///< the product of those of the pieces before
  LorentzTransform<Rest, Rest> matter;  ///< from the relay's frame to that of the matter that passed it on
};

}  // namespace backlight
