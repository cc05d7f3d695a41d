#include "backlight/render/render.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "backlight/base/thread_pool.h"
#include "backlight/camera/sampling.h"
#include "backlight/render/adaptive_sampling.h"
#include "backlight/render/progress.h"
#include "backlight/surface/implicit_surface.h"
#include "channels.h"

namespace backlight {
namespace {

constexpr int largest_tile = 32;
constexpr int block_size = 8;  // a sheet of rays is a block's

struct BlockPlace {
  int right;
  int down;
};

constexpr auto block_order = [] {
  std::array<BlockPlace, block_size * block_size> order{};
  for (unsigned i = 0; i < order.size(); ++i) {
    order[i] = {static_cast<int>((i & 1U) | ((i >> 1U) & 2U) | ((i >> 2U) & 4U)),
                static_cast<int>(((i >> 1U) & 1U) | ((i >> 2U) & 2U) | ((i >> 3U) & 4U))};
  }
  return order;
}();

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

// What one thread works with.
struct ThreadMemory {
  explicit ThreadMemory(const Tracer& tracer, const SheetTracer* sheets)
      : scratch(tracer.make_scratch()), sheet(nullptr, nullptr) {
    if (sheets != nullptr) sheet = sheets->make_scratch();
    const FilmSettings& film = tracer.scene().film;
    if (film.adaptive) sampler.emplace(film.tolerance, PixelBox{0, 0, film.width, film.height});
  }

  Scratch scratch;
  std::unique_ptr<SheetScratch, void (*)(SheetScratch*)> sheet;
  TileLight light;
  std::vector<TilePixel> pixels;
  std::vector<LinearRgb> sums;
  std::vector<int> covered;
  std::optional<AdaptiveSampler> sampler;  // where the number of samples is chosen
  SampleCounts samples;
};

// Whether the rest of a tile's samples will take less than a moment, by what those before have taken: when a
// run is stopped, or looked at, the tile is then not traced in vain.
bool is_worth_finishing(std::chrono::steady_clock::time_point begin, int done, int samples) {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  constexpr double moment = 0.5;  // seconds
  return done > 0 && taken.count() * (samples - done) < moment * done;
}

// The pixels of one view: what a tile task needs.
class ViewRenderer {
 public:
  ViewRenderer(const Tracer& tracer, const SheetTracer* sheets, const RenderSettings& settings, int eye,
               PartialImage& partial, std::size_t view)
      : tracer_(tracer),
        sheets_(sheets),
        settings_(settings),
        eye_(eye),
        has_stars_(tracer.has_stars()),
        has_data_(has_data_channels(tracer.scene())),
        writer_(tracer.scene(), partial.image, view),
        image_(partial.image),
        done_(partial.done[view]) {}

  // Traces what is missing of a tile; gives up between two pixels, or two samples of the tile, when `stop`
  // turns true and the tile is not about to be done: one of many samples may take minutes.
  void tile(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& memory) {
    if (sheets_ != nullptr) {
      try {
        memory.sampler ? tile_to_tolerance(box, stop, memory) : tile_in_sheets(box, stop, memory);
        return;
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception&) {
        // One by one, below, it turns out which pixel it was.
      }
    }
    if (memory.sampler) {
      tile_to_tolerance(box, stop, memory);
      return;
    }
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        if (done_[image_.offset(x, y)] != 0) continue;
        if (stop.load(std::memory_order_relaxed)) return;
        at_pixel(x, y, [&] { pixel(x, y, memory); });
      }
    }
  }

 private:
  // What goes wrong in `work` is told with the pixel that it was for.
  template <class Work>
  static void at_pixel(int x, int y, const Work& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw PixelFailure(x, y, error.what());
    }
  }

  // As many samples of each missing pixel as it needs.
  void tile_to_tolerance(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) {
    list_missing(box, m.pixels);
    if (m.pixels.empty()) return;
    const auto trace = [&](std::span<const TilePixel> pixels, int index, std::vector<PixelSample>& samples) {
      if (stop.load(std::memory_order_relaxed)) return false;
      trace_samples(pixels, index, m, samples);
      return true;
    };
    if (!m.sampler->tile(box, m.pixels, trace)) return;
    write_all(m, nullptr, [&](std::size_t k) { return m.sampler->estimates()[k]; });
  }

  void trace_samples(std::span<const TilePixel> pixels, int index, ThreadMemory& m,
                     std::vector<PixelSample>& samples) const {
    const Scene& scene = tracer_.scene();
    samples.assign(pixels.size(), {});
    if (sheets_ != nullptr) {
      sheets_->trace(pixels, settings_.image_number, index, eye_, false, *m.sheet, m.scratch, m.light);
    }
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const auto [x, y] = pixels[k];
      const ImagePoint point =
          sample_point({scene.film.seed, settings_.image_number, x, y}, index, scene.film.samples);
      samples[k].x = point.x - x;
      samples[k].y = point.y - y;
      if (sheets_ == nullptr) {
        at_pixel(x, y, [&] { trace_point(point, m.scratch, samples[k]); });
      } else if (m.light.covered[k] != 0) {
        samples[k].covered = true;
        samples[k].colour = m.light.colour[k];
      }
    }
  }

  void trace_point(const ImagePoint& point, Scratch& scratch, PixelSample& sample) const {
    const Effects& effects = effects_at(tracer_.scene(), point);
    const auto ray = camera_ray(tracer_.scene().camera, point, effects, eye_);
    if (!ray) return;
    sample.covered = true;
    sample.colour = tracer_.colour(*ray, effects, scratch);
  }

  // Writes the pixels of m.pixels, and that they are done. `estimate(k)`: the colour of one; `records`: what
  // each of them sees, where that is known.
  template <class Estimate>
  void write_all(ThreadMemory& m, const std::vector<SurfaceRecord>* records, const Estimate& estimate) {
    const bool plain = !has_stars_ && !has_data_;
    SampleCounts samples;  // beyond the reach of the pixels' pointers: the compiler keeps it in registers
    std::uint64_t non_finite = 0;
    const PixelWriter writer = writer_;
    std::uint8_t* const done = done_.data();
    const PixelBox window = image_.layout().data;
    const TilePixel* const pixels = m.pixels.data();
    const std::size_t count = m.pixels.size();
    for (std::size_t k = 0; k < count; ++k) {
      const auto [x, y] = pixels[k];
      PixelEstimate pixel = estimate(k);
      if (has_stars_ && pixel.coverage > 0.0) pixel.colour += tracer_.stars(x, y, eye_, m.scratch);
      const auto at = static_cast<std::size_t>((y - window.y0) * window.width() + (x - window.x0));
      bool finite = writer.colour(at, pixel.colour, pixel.coverage);
      if (!plain) finite &= data(x, y, records != nullptr ? &(*records)[k] : nullptr, pixel.samples, m);
      samples.add(pixel.samples, pixel.at_limit);
      non_finite += finite ? 0 : 1;
      done[at] = 1;
    }
    m.samples += samples;
    m.scratch.counts.non_finite += non_finite;
  }

  // In squares of a sheet each, and those within them in squares within squares: neighbours in this order are
  // neighbours in the image.
  void list_missing(const PixelBox& box, std::vector<TilePixel>& pixels) const {
    pixels.resize(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
    TilePixel* next = pixels.data();
    const int width = image_.layout().data.width();
    for (int top = box.y0; top < box.y1; top += block_size) {
      for (int left = box.x0; left < box.x1; left += block_size) {
        const bool whole = left + block_size <= box.x1 && top + block_size <= box.y1;
        const std::uint8_t* const done = done_.data() + image_.offset(left, top);
        for (const auto [right, down] : block_order) {
          const int x = left + right;
          const int y = top + down;
          const bool inside = whole || (x < box.x1 && y < box.y1);
          if (inside && done[down * width + right] == 0) *next++ = {x, y};
        }
      }
    }
    pixels.resize(static_cast<std::size_t>(next - pixels.data()));
  }

  // The same as pixel(), for all at once.
  void tile_in_sheets(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) {
    list_missing(box, m.pixels);
    const Scene& scene = tracer_.scene();
    const int samples = scene.film.samples;
    const bool records = samples == 1 && has_data_channels(scene) && !has_light_channels(scene);
    if (samples > 1) {
      m.sums.assign(m.pixels.size(), LinearRgb{0.0});
      m.covered.assign(m.pixels.size(), 0);
    }
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < samples; ++i) {
      if (stop.load(std::memory_order_relaxed) && !is_worth_finishing(begin, i, samples)) return;
      sheets_->trace(m.pixels, settings_.image_number, i, eye_, records, *m.sheet, m.scratch, m.light);
      for (std::size_t k = 0; k < m.pixels.size() && samples > 1; ++k) {
        if (m.light.covered[k] == 0) continue;
        m.sums[k] += m.light.colour[k];
        ++m.covered[k];
      }
    }
    const std::vector<SurfaceRecord>* known = records ? &m.light.record : nullptr;
    if (samples == 1) {
      write_all(m, known, [&](std::size_t k) {
        return PixelEstimate{LinearRgb{0.0} + m.light.colour[k], double(m.light.covered[k]), 1};
      });
    } else {
      write_all(m, known, [&](std::size_t k) {
        return PixelEstimate{m.sums[k] / double(samples), double(m.covered[k]) / samples, samples};
      });
    }
  }

  void pixel(int x, int y, ThreadMemory& m) {
    const Scene& scene = tracer_.scene();
    const int samples = scene.film.samples;
    LinearRgb sum{0.0};
    int covered = 0;
    for (int i = 0; i < samples; ++i) {
      PixelSample sample;
      trace_point(sample_point({scene.film.seed, settings_.image_number, x, y}, i, samples), m.scratch,
                  sample);
      if (!sample.covered) continue;
      sum += sample.colour;
      ++covered;
    }
    m.pixels = {{x, y}};
    write_all(m, nullptr, [&](std::size_t) {
      return PixelEstimate{sum / double(samples), double(covered) / samples, samples};
    });
  }

  // The data channels, of which `known` is what the pixel sees where it is not null. Whether all are finite.
  bool data(int x, int y, const SurfaceRecord* known, int samples, ThreadMemory& m) const {
    if (!has_data_) return true;
    if (known != nullptr) return writer_.data(x, y, {*known, samples});
    const Scene& scene = tracer_.scene();
    Scratch& scratch = m.scratch;
    const ImagePoint centre{x + 0.5, y + 0.5};
    const Effects& effects = effects_at(scene, centre);
    const auto ray = camera_ray(scene.camera, centre, effects, eye_);
    SurfaceRecord record = ray ? tracer_.surface(*ray, scratch) : SurfaceRecord{};
    if (ray && has_light_channels(scene)) tracer_.add_light(*ray, effects, record, scratch);
    return writer_.data(x, y, {record, samples});
  }

  const Tracer& tracer_;
  const SheetTracer* sheets_;  // null: one ray at a time
  const RenderSettings& settings_;
  int eye_;
  bool has_stars_;
  bool has_data_;
  PixelWriter writer_;
  const Image& image_;
  std::vector<std::uint8_t>& done_;
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
