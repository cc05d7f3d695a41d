#include "backlight/render/render.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "backlight/base/thread_pool.h"
#include "backlight/render/progress.h"
#include "backlight/surface/implicit_surface.h"
#include "view_renderer.h"

namespace backlight {
namespace {

constexpr int largest_tile = 32;
// Tiles get smaller with the number of samples: a tile is put aside as a whole.
int tile_size_of(const Scene& scene) {
  if (scene.film.adaptive) return 16;
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

std::vector<ViewRenderer> views_of(const Tracer& tracer, const SheetTracer* sheets,
                                   const RenderSettings& settings, PartialImage& partial) {
  std::vector<ViewRenderer> views;
  if (!tracer.scene().camera.stereo) {
    views.emplace_back(tracer, sheets, settings, 0, partial, 0);
  } else {
    views.emplace_back(tracer, sheets, settings, -1, partial, 0);
    views.emplace_back(tracer, sheets, settings, +1, partial, 1);
  }
  return views;
}

RenderStatistics summed(const std::vector<ThreadMemory>& memories) {
  RenderStatistics statistics;
  for (const ThreadMemory& memory : memories) {
    statistics.rays += memory.scratch.counts;
    statistics.samples += memory.samples;
  }
  return statistics;
}

}  // namespace

void SampleCounts::add(int samples, bool is_at_limit) {
  const auto count = static_cast<std::uint64_t>(samples);
  least = pixels == 0 ? count : std::min(least, count);
  most = std::max(most, count);
  ++pixels;
  total += count;
  at_limit += is_at_limit ? 1 : 0;
}

SampleCounts& SampleCounts::operator+=(const SampleCounts& other) {
  if (other.pixels == 0) return *this;
  least = pixels == 0 ? other.least : std::min(least, other.least);
  most = std::max(most, other.most);
  pixels += other.pixels;
  total += other.total;
  at_limit += other.at_limit;
  return *this;
}

std::size_t tile_count(const Scene& scene, const RenderSettings& settings) {
  return TileGrid(scene, settings).count();
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
  const TileGrid grid(scene, settings);
  const Tracer tracer(scene, settings.wavelengths);
  std::optional<SheetTracer> sheets;
  if (settings.path == RayPath::sheets && SheetTracer::can_trace(scene)) {
    sheets.emplace(tracer, settings.instructions);
  }
  const SheetTracer* in_use = sheets ? &*sheets : nullptr;
  std::vector<ViewRenderer> views = views_of(tracer, in_use, settings, partial);
  std::vector<ThreadMemory> memories;
  for (int i = 0; i < std::max(1, settings.threads); ++i) memories.emplace_back(tracer, in_use);

  run_on_threads(grid.count(), settings.threads, stop, [&](std::size_t index, int thread) {
    ThreadMemory& memory = memories[static_cast<std::size_t>(thread)];
    const std::uint64_t roots_before = roots_solved_by_this_thread();
    for (ViewRenderer& view : views) view.tile(grid.tile(index), stop, memory);
    memory.scratch.counts.roots += roots_solved_by_this_thread() - roots_before;
    if (progress != nullptr) progress->advance();
  });

  RenderStatistics statistics = summed(memories);
  statistics.strategy = sheets ? sheets->strategy() : tracer.strategy();
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
