// Glass: what a ray goes through, and what its surfaces do to it (docs/physics.md section 12).
#pragma once

#include <optional>
#include <vector>

#include "backlight/trace/shading.h"

namespace backlight {

/// A glass that something is in.
struct Medium {
  int frame = 0;  ///< its surface
  int surface = 0;
  const Glass* glass = nullptr;

  [[nodiscard]] bool is(int of_frame, int of_surface) const {
    return frame == of_frame && surface == of_surface;
  }
};

/// All glass around something, the innermost last.
using Media = std::vector<Medium>;

/// Of refraction; 1 where there is no glass.
inline double index_of(const Media& media) {
  return media.empty() ? 1.0 : media.back().glass->index;
}

/// What is beyond a glass's surface, entered or left.
Media beyond(const Media& media, const Medium& of, bool entering);

/// The share of unpolarised light that a surface between two indices reflects (Fresnel), equation (35), and
/// how the rest goes on, equation (34); 1 and nothing where all is reflected.
struct Parting {
  double reflected = 0.0;
  std::optional<Vec3> refracted;  ///< unit
};
/// `looking`: unit, the way of the ray; `normal`: unit, against it.
Parting part(const Vec3& looking, const Vec3& normal, double index, double index_beyond);

/// A surface of glass.
struct GlassSurface {
  int frame = 0;
  int surface = 0;
  const Glass* glass = nullptr;
  bool shades = true;  ///< whether it takes its share of lamps' light
};

/// All of the scene.
std::vector<GlassSurface> glass_surfaces(const Scene& scene);

/// The glass that the camera is in: at rest to it, or the scene would not have been compiled.
Media media_at_camera(const Scene& scene, const std::vector<GlassSurface>& surfaces, const Hub& hub);

/// A frame that rests relative to another, whose bodies may touch those of that one.
struct FrameBeside {
  int frame = 0;
  Displacement<Rest> shift;  ///< of an event's coordinates, from the other frame's to this one's
  double doubt = 0.0;        ///< of that shift's places, by rounding
};

/// By frame index, of those with glass, themselves first.
using FramesBeside = std::vector<std::vector<FrameBeside>>;
FramesBeside frames_beside(const Scene& scene, const std::vector<GlassSurface>& surfaces);

/// What begins where a surface of glass ends.
struct Contact {
  Media media;        ///< beyond it, and beyond glass that stands on it
  int opaque = -1;    ///< a surface that is not of glass and stands on it; or -1
  int frame = -1;     ///< its frame
  double room = 0.0;  ///< how far from the point, to either side, surfaces of other frames stand on it
};

/// `before`: what the ray comes through; `media`: what is beyond the surface of the point itself. What stands
/// on glass is in optical contact: there is no gap that would reflect or refract.
Contact contact_at(const Scene& scene, const FramesBeside& beside, const SeenPoint& point,
                   const Media& before, const Media& media);

/// What glass leaves of a lamp's light on its straight way to a seen point: shares of red, green and blue.
/// Where colours shift those of coloured glass are filters instead, which are added to scratch.filters.
LinearRgb transmitted(const std::vector<GlassSurface>& surfaces, const Hub& hub, Scratch& scratch,
                      const SeenPoint& point, const LightView& light, const Arrival& arrival, bool shifted);

}  // namespace backlight
