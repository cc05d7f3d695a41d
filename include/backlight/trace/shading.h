// What a seen point sends towards the camera, in its own rest frame: Lambert, Phong and own emission.
#pragma once

#include <cstdint>
#include <vector>

#include "backlight/colour/film_integral.h"
#include "backlight/colour/reflected_light.h"
#include "backlight/trace/illumination.h"
#include "backlight/trace/rest_colours.h"

namespace backlight {

/// What was done for one image, for the statistics. Summed over threads at the end.
struct RayCounts {
  std::uint64_t primary = 0;           ///< camera rays
  std::uint64_t single = 0;            ///< of those, which did not go in sheets: one at a time
  std::uint64_t shadow = 0;            ///< segments to lamps that were tested
  std::uint64_t data = 0;              ///< pixel-centre rays for the data channels alone
  std::uint64_t passed_on = 0;         ///< rays that go on from a mirror
  std::uint64_t passed_in_sheets = 0;  ///< of those, which went together
  std::uint64_t ended = 0;             ///< of those, the ones that FilmSettings::bounces ended
  std::uint64_t non_finite = 0;        ///< pixels with a NaN or an infinity
  /// Camera rays that see a root which could not be isolated to full precision (surface/implicit.h).
  std::uint64_t unresolved = 0;
  std::uint64_t roots = 0;  ///< of formulas, solved along rays of any kind

  RayCounts& operator+=(const RayCounts& more) {
    primary += more.primary;
    single += more.single;
    shadow += more.shadow;
    data += more.data;
    passed_on += more.passed_on;
    passed_in_sheets += more.passed_in_sheets;
    ended += more.ended;
    non_finite += more.non_finite;
    unresolved += more.unresolved;
    roots += more.roots;
    return *this;
  }
};

struct EscapeSearch;
struct LegWanted;

/// Working memory of one thread.
struct Scratch {
  Scratch(const Hub& hub, std::size_t wavelengths, InstructionSet set);

  RayInFrames rays;
  RayCounts counts;
  const SpectralKernels* kernels;   ///< for these, of one value a wavelength of a set of the camera's:
  double shift = 1.0;               ///< D from the surface (or sky) to the camera
  int shifted = 0;                  ///< of the set of how many wavelengths `wavelengths` are; 0: of none
  std::vector<double> wavelengths;  ///< in the surface's (or sky's) frame
  std::vector<double> reflectance;
  std::vector<double> lamp;  ///< room for what a lamp takes
  Spectrum texel;            ///< the reflectance of a point of a texture
  std::vector<Filter>
      filters;  ///< that shifted light goes through on its way to the camera: coloured mirrors
  ReflectedLight reflected;
  EscapeSearch* escapes = nullptr;  ///< escape.h; or null: light is asked for
  LegWanted* leg_wanted = nullptr;  ///< leg.h; or null: rays are followed to their ends
};

struct GlassSurface;

/// What the shading of one image reads.
struct ShadingContext {
  const Scene* scene = nullptr;
  const Hub* hub = nullptr;
  const RestColours* rest_colours = nullptr;
  const WavelengthSet* wavelengths = nullptr;
  const SceneSpectra* spectra = nullptr;
  const std::vector<GlassSurface>* glass = nullptr;  ///< that lamps shine through
};

/// Radiance towards the camera in the surface's frame, as a film colour: no colours are shifted, but the
/// brightness of lamps in motion is (factors of `effects`).
Radiance<Rest> shade(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                     Scratch& scratch);

/// The same with its colours shifted by scratch.shift on the way: the film colour of the spectral radiance at
/// the film's wavelengths in the surface's frame (docs/physics.md equation (13a)).
LinearRgb shade_shifted(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                        Scratch& scratch);

/// How many lights reach a seen point; that of its own is counted as one.
int lamps_reaching(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   Scratch& scratch);

/// Each light's own time, in scene seconds, when it sent what reaches a seen point, into `times`, by light;
/// those that do not reach it are left as they are.
void lamp_times(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                Scratch& scratch, std::vector<double>& times);

}  // namespace backlight
