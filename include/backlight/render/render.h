// One image of a scene, over tiles and threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "backlight/film/exr.h"
#include "backlight/film/image.h"
#include "backlight/trace/tracer.h"

namespace backlight {

class ProgressReporter;

struct RenderSettings {
  int threads = 1;
  std::optional<PixelBox> crop;   ///< pixels of the full image; the EXR's data window
  int wavelengths = 0;            ///< of Needs: 0 = no colour is shifted
  std::int64_t image_number = 1;  ///< of the animation: the sample positions depend on it
};

/// What making the image took.
struct RenderStatistics {
  RayCounts rays;
  double seconds = 0.0;  ///< wall time, tracing only
  int threads = 1;
};

struct RenderedImage {
  Image image;
  RenderStatistics statistics;
};

/// Number of tiles the image is cut into: the units that `progress` is advanced by.
std::size_t tile_count(const Scene& scene, const RenderSettings& settings);

/// Traces the image. Every pixel depends on the scene, the seed, the image number and its own place alone:
/// the same bits for any number of threads, order of tiles and crop. Empty when `stop` turned true before the
/// end.
std::optional<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                          const std::atomic<bool>& stop, ProgressReporter* progress);

}  // namespace backlight
