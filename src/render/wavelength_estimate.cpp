#include "backlight/render/wavelength_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "backlight/film/display.h"
#include "backlight/trace/tracer.h"

namespace backlight {
namespace {

constexpr int columns = 24;
constexpr int rows = 16;

// Counts of which each is at least as good as those before it, for all colours together (docs/colour.md). The
// last is what the others are measured against; beyond 256 nothing changes that could be seen.
constexpr std::array candidates{8, 12, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, 112, 128, 160};
constexpr int reference = 256;

std::vector<Vec3> trace_grid(const Scene& scene, int wavelengths) {
  const Tracer tracer(scene, wavelengths);
  Scratch scratch = tracer.make_scratch();
  const int eye = scene.camera.stereo ? -1 : 0;
  std::vector<Vec3> colours;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const ImagePoint point{(column + 0.5) * scene.film.width / columns,
                             (row + 0.5) * scene.film.height / rows};
      const Effects& effects = effects_at(scene, point);
      const auto ray = camera_ray(scene.camera, point, effects, eye);
      colours.push_back(ray ? tracer.colour(*ray, effects, scratch) : Vec3{0.0});
    }
  }
  return colours;
}

// On the scale of shown_value(), and as a share of the brightest channel of its own colour: a dim pixel may
// be shown brighter than this scale has it.
double greatest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double greatest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double own = std::max({std::abs(b[i].x), std::abs(b[i].y), std::abs(b[i].z)});
    for (int channel = 0; channel < 3; ++channel) {
      const double shown = std::abs(shown_value(a[i][channel]) - shown_value(b[i][channel]));
      greatest = std::max(greatest, shown);
      if (own > 0.0) greatest = std::max(greatest, std::abs(a[i][channel] - b[i][channel]) / own);
    }
  }
  return greatest;
}

}  // namespace

Needs needs_within_tolerance(const Scene& scene) {
  Needs needs = needs_of(scene);
  if (!needs.spectral || scene.film.wavelengths > 0 || !(scene.film.tolerance > 0.0)) return needs;
  const double allowed = 0.5 * scene.film.tolerance;
  const std::vector<Vec3> exact = trace_grid(scene, reference);
  needs.wavelengths = reference;
  for (const int count : candidates) {
    if (greatest_difference(trace_grid(scene, count), exact) > allowed) continue;
    needs.wavelengths = count;
    break;
  }
  needs.wavelength_reason = WavelengthReason::tolerance;
  needs.why_so_many = "the fewest of which no colour of " + std::to_string(columns * rows) +
                      " rays over the image is off by more than half the tolerance, of white or of itself";
  return needs;
}

}  // namespace backlight
