#include "view_renderer.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <utility>

namespace backlight {
namespace {

// Whether the rest of a tile's samples will take less than a moment, by what those before have taken: when a
// run is stopped, or looked at, the tile is then not traced in vain.
bool is_worth_finishing(std::chrono::steady_clock::time_point begin, int done, int samples) {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  constexpr double moment = 0.5;  // seconds
  return done > 0 && taken.count() * (samples - done) < moment * done;
}

}  // namespace

template <class Estimate>
void ViewRenderer::write_all(ThreadMemory& m, const std::vector<SurfaceRecord>* records,
                             const Estimate& estimate) const {
  const bool plain = !has_stars_ && !has_data_;
  SampleCounts samples;  // beyond the reach of the pixels' pointers: the compiler keeps it in registers
  std::uint64_t non_finite = 0;
  const PixelWriter& writer = *m.writer;
  std::uint8_t* const done = m.done;
  const PixelBox window = m.window;
  const TilePixel* const pixels = m.missing.pixels.data();
  const std::size_t count = m.missing.pixels.size();
  for (std::size_t k = 0; k < count; ++k) {
    const auto [x, y] = pixels[k];
    PixelEstimate pixel = estimate(k);
    // Where there are stars there is a sky: what is not covered is beyond the projection's edge.
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

void ViewRenderer::write_colours(ThreadMemory& m) const {
  const std::vector<TilePixel>& pixels = m.missing.pixels;
  const TileLight& light = m.light;
  const PixelBox window = m.window;
  const auto width = static_cast<std::size_t>(window.width());
  auto whole = m.missing.whole.begin();
  std::uint64_t non_finite = 0;
  for (std::size_t k = 0; k < pixels.size();) {
    const auto [x, y] = pixels[k];
    const std::size_t at =
        static_cast<std::size_t>(y - window.y0) * width + static_cast<std::size_t>(x - window.x0);
    if (whole != m.missing.whole.end() && *whole == k) {
      non_finite += m.writer->block(at, width, light, k);
      for (std::size_t row = 0; row < block_size; ++row)
        std::memset(m.done + at + row * width, 1, block_size);
      ++whole;
      k += block_pixels;
    } else {
      non_finite += m.writer->colour(at, LinearRgb{0.0} + light.colour(k), double(light.covered[k])) ? 0 : 1;
      m.done[at] = 1;
      ++k;
    }
  }
  const std::uint64_t count = pixels.size();
  if (count > 0) m.samples += SampleCounts{count, count, 1, 1, 0};
  m.scratch.counts.non_finite += non_finite;
}

void ViewRenderer::tile(const PixelBox& box, RowBand& band, const std::atomic<bool>& stop,
                        ThreadMemory& memory) const {
  memory.window = band.image.layout().data;
  memory.done = band.done[view_].data();
  memory.writer.emplace(tracer_.scene(), band.image, view_);
  memory.missing.list(box, memory.window, memory.done);
  if (!memory.missing.pixels.empty()) trace_missing(box, stop, memory);
}

void ViewRenderer::trace_missing(const PixelBox& box, const std::atomic<bool>& stop,
                                 ThreadMemory& memory) const {
  if (memory.sampler) {
    tile_to_tolerance(box, stop, memory);
    return;
  }
  if (sheets_ != nullptr) {
    at_pixel(box.x0, box.y0, [&] { tile_in_sheets(box, stop, memory); });
    return;
  }
  std::vector<TilePixel> pixels = memory.missing.pixels;
  std::ranges::sort(pixels, {}, [](const TilePixel& pixel) { return std::pair(pixel.y, pixel.x); });
  for (const TilePixel& missing : pixels) {
    if (stop.load(std::memory_order_relaxed)) return;
    at_pixel(missing.x, missing.y, [&] { pixel(missing.x, missing.y, memory); });
  }
}

void ViewRenderer::tile_to_tolerance(const PixelBox& box, const std::atomic<bool>& stop,
                                     ThreadMemory& m) const {
  const auto trace = [&](std::span<const ImagePoint> points, std::vector<PixelSample>& samples) {
    if (stop.load(std::memory_order_relaxed)) return false;
    trace_points(points, m, samples);
    return true;
  };
  if (!m.sampler->tile(box, m.missing.pixels, small_things_, trace)) return;
  write_all(m, centres(m), [&](std::size_t k) { return m.sampler->estimates()[k]; });
}

SamplingPlan ViewRenderer::plan(ThreadMemory& memory) const {
  const FilmSettings& film = tracer_.scene().film;
  const auto trace = [&](std::span<const ImagePoint> points, std::vector<PixelSample>& samples) {
    trace_points(points, memory, samples);
    return true;
  };
  return make_plan(film.tolerance, {0, 0, film.width, film.height}, {film.seed, settings_.image_number},
                   small_things_, trace);
}

void ViewRenderer::trace_points(std::span<const ImagePoint> points, ThreadMemory& m,
                                std::vector<PixelSample>& samples) const {
  samples.assign(points.size(), {});
  if (sheets_ != nullptr && !points.empty()) {
    at_pixel(static_cast<int>(points[0].x), static_cast<int>(points[0].y),
             [&] { sheets_->trace(points, eye_, *m.sheet, m.scratch, m.light); });
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (m.light.covered[k] != 0) samples[k] = {m.light.colour(k), true};
    }
    return;
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ImagePoint& point = points[k];
    at_pixel(static_cast<int>(point.x), static_cast<int>(point.y),
             [&] { trace_point(point, m.scratch, samples[k]); });
  }
}

void ViewRenderer::trace_point(const ImagePoint& point, Scratch& scratch, PixelSample& sample) const {
  const Effects& effects = effects_at(tracer_.scene(), point);
  const auto ray = camera_ray(tracer_.scene().camera, point, effects, eye_);
  if (!ray) return;
  const RayLight light = tracer_.light(*ray, effects, scratch);
  sample = {light.colour, light.opaque};
}

void ViewRenderer::tile_in_sheets(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) const {
  const auto width = static_cast<std::size_t>(m.window.width());
  const std::size_t first =
      width * static_cast<std::size_t>(box.y0 - m.window.y0) + static_cast<std::size_t>(box.x0 - m.window.x0);
  for (int row = 0; row < box.height(); ++row) {
    m.writer->expect(first + width * static_cast<std::size_t>(row), static_cast<std::size_t>(box.width()));
  }
  const Scene& scene = tracer_.scene();
  const int samples = scene.film.samples;
  const bool records = samples == 1 && has_data_channels(scene) && !has_light_channels(scene);
  if (samples > 1) {
    m.sums.assign(m.missing.pixels.size(), LinearRgb{0.0});
    m.covered.assign(m.missing.pixels.size(), 0);
  }
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < samples; ++i) {
    if (stop.load(std::memory_order_relaxed) && !is_worth_finishing(begin, i, samples)) return;
    sheets_->trace(m.missing.pixels, settings_.image_number, i, eye_, records, *m.sheet, m.scratch, m.light);
    for (std::size_t k = 0; k < m.missing.pixels.size() && samples > 1; ++k) {
      if (m.light.covered[k] == 0) continue;
      m.sums[k] += m.light.colour(k);
      ++m.covered[k];
    }
  }
  const std::vector<SurfaceRecord>* known = records ? &m.light.record : nullptr;
  if (samples == 1 && !has_stars_ && !has_data_) {
    write_colours(m);
  } else if (samples == 1) {
    write_all(m, known, [&](std::size_t k) {
      return PixelEstimate{LinearRgb{0.0} + m.light.colour(k), double(m.light.covered[k]), 1};
    });
  } else {
    write_all(m, centres(m), [&](std::size_t k) {
      return PixelEstimate{m.sums[k] / double(samples), double(m.covered[k]) / samples, samples};
    });
  }
}

// What the centres of the missing pixels see, where that is all that the data channels are made of; or null.
const std::vector<SurfaceRecord>* ViewRenderer::centres(ThreadMemory& m) const {
  if (sheets_ == nullptr || !has_data_ || has_light_channels(tracer_.scene())) return nullptr;
  m.centres.clear();
  for (const TilePixel& pixel : m.missing.pixels) m.centres.push_back({pixel.x + 0.5, pixel.y + 0.5});
  sheets_->surfaces(m.centres, eye_, *m.sheet, m.scratch, m.light);
  return &m.light.record;
}

void ViewRenderer::pixel(int x, int y, ThreadMemory& m) const {
  const Scene& scene = tracer_.scene();
  const int samples = scene.film.samples;
  LinearRgb sum{0.0};
  int covered = 0;
  for (int i = 0; i < samples; ++i) {
    PixelSample sample;
    trace_point(sample_point({scene.film.seed, settings_.image_number, x, y}, i, samples), m.scratch, sample);
    if (!sample.covered) continue;
    sum += sample.colour;
    ++covered;
  }
  m.missing = {{{x, y}}, {}};
  write_all(m, nullptr, [&](std::size_t) {
    return PixelEstimate{sum / double(samples), double(covered) / samples, samples};
  });
}

bool ViewRenderer::data(int x, int y, const SurfaceRecord* known, int samples, ThreadMemory& m) const {
  if (!has_data_) return true;
  if (known != nullptr) return m.writer->data(x, y, {*known, samples});
  const Scene& scene = tracer_.scene();
  Scratch& scratch = m.scratch;
  const ImagePoint centre{x + 0.5, y + 0.5};
  const Effects& effects = effects_at(scene, centre);
  const auto ray = camera_ray(scene.camera, centre, effects, eye_);
  SurfaceRecord record = ray ? tracer_.surface(*ray, scratch) : SurfaceRecord{};
  m.lamp_times.assign(scene.lights.size(), -std::numeric_limits<double>::infinity());
  if (ray && has_light_channels(scene)) tracer_.add_light(*ray, effects, record, m.lamp_times, scratch);
  return m.writer->data(x, y, {record, samples, m.lamp_times});
}

}  // namespace backlight
