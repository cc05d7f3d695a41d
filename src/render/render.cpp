#include "backlight/render/render.h"

#include <algorithm>
#include <chrono>

#include "backlight/base/thread_pool.h"
#include "backlight/camera/sampling.h"
#include "backlight/render/progress.h"
#include "channels.h"

namespace backlight {
namespace {

constexpr int tile_size = 16;

PixelBox data_window(const Scene& scene, const RenderSettings& settings) {
  return settings.crop.value_or(PixelBox{0, 0, scene.film.width, scene.film.height});
}

struct TileGrid {
  PixelBox window;
  std::size_t columns;
  std::size_t rows;

  explicit TileGrid(const PixelBox& box)
      : window(box),
        columns(static_cast<std::size_t>((box.width() + tile_size - 1) / tile_size)),
        rows(static_cast<std::size_t>((box.height() + tile_size - 1) / tile_size)) {}

  [[nodiscard]] std::size_t count() const { return columns * rows; }
  [[nodiscard]] PixelBox tile(std::size_t index) const {
    const int x = window.x0 + static_cast<int>(index % columns) * tile_size;
    const int y = window.y0 + static_cast<int>(index / columns) * tile_size;
    return {x, y, std::min(x + tile_size, window.x1), std::min(y + tile_size, window.y1)};
  }
};

// The pixels of one view: what a tile task needs.
class ViewRenderer {
 public:
  ViewRenderer(const Tracer& tracer, const RenderSettings& settings, int eye, PixelWriter writer)
      : tracer_(tracer), settings_(settings), eye_(eye), writer_(writer) {}

  void pixel(int x, int y, Scratch& scratch) {
    const Scene& scene = tracer_.scene();
    LinearRgb sum{0.0};
    int covered = 0;
    const int samples = scene.film.samples;
    const SampleKey key{scene.film.seed, settings_.image_number, x, y};
    for (int i = 0; i < samples; ++i) {
      const ImagePoint point = sample_point(key, i, samples);
      const Effects& effects = effects_at(scene, point);
      const auto ray = camera_ray(scene.camera, point, effects, eye_);
      if (!ray) continue;
      sum += tracer_.colour(*ray, effects, scratch);
      ++covered;
    }
    LinearRgb colour = sum / double(samples);
    if (covered > 0) colour += tracer_.stars(x, y, eye_, scratch);
    bool finite = writer_.colour(x, y, colour, double(covered) / samples);
    if (has_data_channels(scene)) finite &= data(x, y, scratch);
    if (!finite) ++scratch.counts.non_finite;
  }

 private:
  bool data(int x, int y, Scratch& scratch) {
    const Scene& scene = tracer_.scene();
    const ImagePoint centre{x + 0.5, y + 0.5};
    const auto ray = camera_ray(scene.camera, centre, effects_at(scene, centre), eye_);
    return writer_.data(x, y, ray ? tracer_.surface(*ray, scratch) : SurfaceRecord{});
  }

  const Tracer& tracer_;
  const RenderSettings& settings_;
  int eye_;
  PixelWriter writer_;
};

std::vector<ViewRenderer> views_of(const Tracer& tracer, const RenderSettings& settings, Image& image) {
  const Scene& scene = tracer.scene();
  std::vector<ViewRenderer> views;
  if (!scene.camera.stereo) {
    views.emplace_back(tracer, settings, 0, PixelWriter(scene, image, 0));
  } else {
    views.emplace_back(tracer, settings, -1, PixelWriter(scene, image, 0));
    views.emplace_back(tracer, settings, +1, PixelWriter(scene, image, 1));
  }
  return views;
}

RenderStatistics summed(const std::vector<Scratch>& scratches) {
  RenderStatistics statistics;
  for (const Scratch& scratch : scratches) {
    statistics.rays.primary += scratch.counts.primary;
    statistics.rays.shadow += scratch.counts.shadow;
    statistics.rays.data += scratch.counts.data;
    statistics.rays.non_finite += scratch.counts.non_finite;
  }
  return statistics;
}

}  // namespace

std::size_t tile_count(const Scene& scene, const RenderSettings& settings) {
  return TileGrid(data_window(scene, settings)).count();
}

std::optional<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                          const std::atomic<bool>& stop, ProgressReporter* progress) {
  const auto start = std::chrono::steady_clock::now();
  const TileGrid grid(data_window(scene, settings));
  const Tracer tracer(scene, settings.wavelengths);
  Image image(layout_of(scene, grid.window));
  std::vector<ViewRenderer> views = views_of(tracer, settings, image);
  std::vector<Scratch> scratches(static_cast<std::size_t>(std::max(1, settings.threads)),
                                 tracer.make_scratch());

  const bool complete =
      run_on_threads(grid.count(), settings.threads, stop, [&](std::size_t index, int thread) {
        Scratch& scratch = scratches[static_cast<std::size_t>(thread)];
        const PixelBox tile = grid.tile(index);
        for (ViewRenderer& view : views) {
          for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
              if (stop.load(std::memory_order_relaxed)) return;  // a tile of many samples may take minutes
              view.pixel(x, y, scratch);
            }
          }
        }
        if (progress != nullptr) progress->advance();
      });
  if (!complete) return std::nullopt;

  RenderedImage result{std::move(image), summed(scratches)};
  result.statistics.threads = settings.threads;
  result.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace backlight
