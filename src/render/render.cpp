#include "backlight/render/render.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

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
  ViewRenderer(const Tracer& tracer, const RenderSettings& settings, int eye, PartialImage& partial,
               std::size_t view)
      : tracer_(tracer),
        settings_(settings),
        eye_(eye),
        writer_(tracer.scene(), partial.image, view),
        image_(partial.image),
        done_(partial.done[view]) {}

  // Traces what is missing of a tile; gives up between two pixels when `stop` turns true, since a tile of
  // many samples may take minutes.
  void tile(const PixelBox& box, const std::atomic<bool>& stop, Scratch& scratch) {
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        std::uint8_t& is_done = done_[image_.offset(x, y)];
        if (is_done != 0) continue;
        if (stop.load(std::memory_order_relaxed)) return;
        pixel_or_failure(x, y, scratch);
        is_done = 1;
      }
    }
  }

 private:
  void pixel_or_failure(int x, int y, Scratch& scratch) {
    try {
      pixel(x, y, scratch);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw PixelFailure(x, y, error.what());
    }
  }

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

  bool data(int x, int y, Scratch& scratch) {
    const Scene& scene = tracer_.scene();
    const ImagePoint centre{x + 0.5, y + 0.5};
    const Effects& effects = effects_at(scene, centre);
    const auto ray = camera_ray(scene.camera, centre, effects, eye_);
    SurfaceRecord record = ray ? tracer_.surface(*ray, scratch) : SurfaceRecord{};
    if (ray && has_light_channels(scene)) tracer_.add_light(*ray, effects, record, scratch);
    return writer_.data(x, y, record);
  }

  const Tracer& tracer_;
  const RenderSettings& settings_;
  int eye_;
  PixelWriter writer_;
  const Image& image_;
  std::vector<std::uint8_t>& done_;
};

std::vector<ViewRenderer> views_of(const Tracer& tracer, const RenderSettings& settings,
                                   PartialImage& partial) {
  std::vector<ViewRenderer> views;
  if (!tracer.scene().camera.stereo) {
    views.emplace_back(tracer, settings, 0, partial, 0);
  } else {
    views.emplace_back(tracer, settings, -1, partial, 0);
    views.emplace_back(tracer, settings, +1, partial, 1);
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

bool PartialImage::is_complete() const {
  const auto all = [](const std::vector<std::uint8_t>& plane) {
    return std::ranges::all_of(plane, [](std::uint8_t is_done) { return is_done != 0; });
  };
  return std::ranges::all_of(done, all);
}

PixelFailure::PixelFailure(int at_x, int at_y, const std::string& why)
    : std::runtime_error("pixel " + std::to_string(at_x) + "," + std::to_string(at_y) + ": " + why),
      x(at_x),
      y(at_y) {}

PartialImage begin_image(const Scene& scene, const RenderSettings& settings) {
  PartialImage partial{Image(layout_of(scene, data_window(scene, settings))), {}};
  const std::size_t views = std::max<std::size_t>(partial.image.layout().views.size(), 1);
  partial.done.assign(views, std::vector<std::uint8_t>(partial.image.plane(0).size(), 0));
  return partial;
}

RenderStatistics render_missing(const Scene& scene, const RenderSettings& settings, PartialImage& partial,
                                const std::atomic<bool>& stop, ProgressReporter* progress) {
  const auto start = std::chrono::steady_clock::now();
  const TileGrid grid(data_window(scene, settings));
  const Tracer tracer(scene, settings.wavelengths);
  std::vector<ViewRenderer> views = views_of(tracer, settings, partial);
  std::vector<Scratch> scratches(static_cast<std::size_t>(std::max(1, settings.threads)),
                                 tracer.make_scratch());

  run_on_threads(grid.count(), settings.threads, stop, [&](std::size_t index, int thread) {
    for (ViewRenderer& view : views) {
      view.tile(grid.tile(index), stop, scratches[static_cast<std::size_t>(thread)]);
    }
    if (progress != nullptr) progress->advance();
  });

  RenderStatistics statistics = summed(scratches);
  statistics.threads = settings.threads;
  statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

std::optional<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                          const std::atomic<bool>& stop, ProgressReporter* progress) {
  PartialImage partial = begin_image(scene, settings);
  const RenderStatistics statistics = render_missing(scene, settings, partial, stop, progress);
  if (!partial.is_complete()) return std::nullopt;
  return RenderedImage{std::move(partial.image), statistics};
}

}  // namespace backlight
