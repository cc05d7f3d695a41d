#include "backlight/render/render.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "backlight/base/thread_pool.h"
#include "backlight/render/image_file.h"
#include "backlight/render/progress.h"
#include "backlight/surface/implicit_surface.h"
#include "view_renderer.h"

namespace backlight {
namespace {

constexpr int largest_tile = 32;
// Tiles get smaller with the number of samples: a tile is put aside as a whole.
int tile_size_of(const Scene& scene) {
  if (scene.film.adaptive) return 24;
  return scene.film.samples <= 16 ? largest_tile : scene.film.samples <= 64 ? 16 : block_size;
}

PixelBox data_window(const Scene& scene, const RenderSettings& settings) {
  return settings.crop.value_or(PixelBox{0, 0, scene.film.width, scene.film.height});
}

struct TileGrid {
  PixelBox window;
  int size;
  std::size_t columns;
  std::size_t rows;

  TileGrid(const Scene& scene, const RenderSettings& settings)
      : window(data_window(scene, settings)),
        size(tile_size_of(scene)),
        columns(static_cast<std::size_t>((window.width() + size - 1) / size)),
        rows(static_cast<std::size_t>((window.height() + size - 1) / size)) {}

  [[nodiscard]] std::size_t count() const { return columns * rows; }
  [[nodiscard]] PixelBox tile(std::size_t index) const {
    const int x = window.x0 + static_cast<int>(index % columns) * size;
    const int y = window.y0 + static_cast<int>(index / columns) * size;
    return {x, y, std::min(x + size, window.x1), std::min(y + size, window.y1)};
  }
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<ViewRenderer> views_of(const Tracer& tracer, const SheetTracer* sheets,
                                   const RenderSettings& settings) {
  std::vector<ViewRenderer> views;
  if (!tracer.scene().camera.stereo) {
    views.emplace_back(tracer, sheets, settings, 0, 0);
  } else {
    views.emplace_back(tracer, sheets, settings, -1, 0);
    views.emplace_back(tracer, sheets, settings, +1, 1);
  }
  return views;
}

RenderStatistics summed(const std::vector<ThreadMemory>& memories) {
  RenderStatistics statistics;
  for (const ThreadMemory& memory : memories) {
    statistics.rays += memory.scratch.counts;
    statistics.samples += memory.samples;
    statistics.thread_seconds += memory.seconds;
  }
  return statistics;
}

}  // namespace

SampleCounts& SampleCounts::operator+=(const SampleCounts& other) {
  if (other.pixels == 0) return *this;
  least = pixels == 0 ? other.least : std::min(least, other.least);
  most = std::max(most, other.most);
  pixels += other.pixels;
  total += other.total;
  at_limit += other.at_limit;
  return *this;
}

PixelFailure::PixelFailure(int at_x, int at_y, const std::string& why)
    : std::runtime_error("pixel " + std::to_string(at_x) + "," + std::to_string(at_y) + ": " + why),
      x(at_x),
      y(at_y) {}

std::size_t tile_count(const Scene& scene, const RenderSettings& settings) {
  return TileGrid(scene, settings).count();
}

int band_rows(const Scene& scene) {
  return std::lcm(tile_size_of(scene), exr_chunk_rows);
}

bool keeps_rows(const Scene& scene) {
  return scene.film.samples > 1 || scene.film.adaptive;
}

std::unique_ptr<PartialImage> begin_image(const Scene& scene, const RenderSettings& settings) {
  return std::make_unique<PartialImage>(layout_of(scene, data_window(scene, settings)), band_rows(scene),
                                        keeps_rows(scene));
}

struct ImageTracing::Parts {
  Parts(const Scene& scene, const RenderSettings& the_settings, PartialImage& the_partial,
        const std::atomic<bool>& the_stop, ProgressReporter* the_progress, ImageFile* the_file)
      : settings(the_settings),
        partial(the_partial),
        file(the_file),
        stop(the_stop),
        progress(the_progress),
        grid(scene, settings),
        tracer(scene, settings.wavelengths, settings.pieces,
               settings.path == RayPath::sheets ? Search::tree : Search::every_surface) {
    const bool in_sheets = settings.path == RayPath::sheets && settings.pieces.retarded_shadows;
    if (in_sheets && SheetTracer::can_trace(scene) && !tracer.camera_is_in_glass()) {
      sheets.emplace(tracer, settings.instructions);
    }
    const SheetTracer* in_use = sheets ? &*sheets : nullptr;
    views = views_of(tracer, in_use, settings);
    for (int i = 0; i < std::max(1, settings.threads); ++i)
      memories.emplace_back(tracer, in_use, settings.instructions);
    if (partial.band_count() > 0) partial.begin(0);  // so that its pages are touched before the first tile
    if (!scene.film.adaptive) return;
    plan = views.front().plan(memories.front());
    for (ThreadMemory& memory : memories) memory.sampler.emplace(plan);
  }

  const RenderSettings settings;
  PartialImage& partial;
  ImageFile* file;  // null: none
  const std::atomic<bool>& stop;
  ProgressReporter* progress;
  TileGrid grid;
  Tracer tracer;
  std::optional<SheetTracer> sheets;
  std::vector<ViewRenderer> views;
  std::vector<ThreadMemory> memories;
  SamplingPlan plan;  // where a tolerance is asked for; one for both eyes
};

ImageTracing::ImageTracing(const Scene& scene, const RenderSettings& settings, PartialImage& partial,
                           const std::atomic<bool>& stop, ProgressReporter* progress, ImageFile* file)
    : parts_(std::make_unique<Parts>(scene, settings, partial, stop, progress, file)) {}

ImageTracing::~ImageTracing() = default;

std::size_t ImageTracing::tile_count() const {
  return parts_->grid.count();
}

void ImageTracing::tile(std::size_t index, int thread) {
  const auto start = std::chrono::steady_clock::now();
  ThreadMemory& memory = parts_->memories[static_cast<std::size_t>(thread)];
  const PixelBox box = parts_->grid.tile(index);
  const bool is_wanted = parts_->file == nullptr || parts_->file->has_use_for_pixels();
  RowBand* band = is_wanted ? parts_->partial.begin(parts_->partial.band_of(box.y0)) : nullptr;
  if (band != nullptr) {
    const std::uint64_t roots_before = roots_solved_by_this_thread();
    const std::uint64_t pixels_before = memory.samples.pixels;
    for (const ViewRenderer& view : parts_->views) view.tile(box, *band, parts_->stop, memory);
    memory.scratch.counts.roots += roots_solved_by_this_thread() - roots_before;
    memory.seconds += seconds_since(start);
    band->missing -= memory.samples.pixels - pixels_before;
  }
  if (parts_->file != nullptr) parts_->file->take_finished();
  if (parts_->progress != nullptr) parts_->progress->advance();
}

RenderStatistics ImageTracing::statistics() const {
  RenderStatistics statistics = summed(parts_->memories);
  statistics.threads = parts_->settings.threads;
  return statistics;
}

RenderStatistics render_missing(const Scene& scene, const RenderSettings& settings, PartialImage& partial,
                                const std::atomic<bool>& stop, ProgressReporter* progress) {
  const auto start = std::chrono::steady_clock::now();
  ImageTracing tracing(scene, settings, partial, stop, progress);
  run_on_threads(tracing.tile_count(), settings.threads, stop,
                 [&](std::size_t index, int thread) { tracing.tile(index, thread); });
  RenderStatistics statistics = tracing.statistics();
  statistics.seconds = seconds_since(start);
  return statistics;
}

std::optional<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                          const std::atomic<bool>& stop, ProgressReporter* progress) {
  const std::unique_ptr<PartialImage> partial = begin_image(scene, settings);
  const RenderStatistics statistics = render_missing(scene, settings, *partial, stop, progress);
  if (!partial->is_complete()) return std::nullopt;
  return RenderedImage{partial->whole(), statistics};
}

}  // namespace backlight
