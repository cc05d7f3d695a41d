// The rays of a tile.
#include "tile_rays.h"

#include <algorithm>
#include <cmath>

#include "backlight/camera/sampling.h"

namespace backlight {
namespace {

// The rays of one sample of some pixels, before they meet anything.
class SheetMaker {
 public:
  SheetMaker(const Scene& scene, const SheetKernels& kernels, SheetScratch& work)
      : scene_(scene), kernels_(kernels), work_(work) {}

  // The sheets' order is that of the pixels, and does not change a bit.
  void make(std::span<const TilePixel> pixels, std::int64_t image_number, int sample) {
    const int samples = scene_.film.samples;
    const SampleRow row = sample_row(scene_.film.seed, image_number, sample);
    make(pixels.size(), [&](std::size_t begin) {
      const TilePixel* const of = pixels.data() + begin;
      for (int i = 0; i < count_ && samples == 1; ++i) {  // their centres, in vectors of the compiler's
        x_[i] = of[i].x + 0.5;
        y_[i] = of[i].y + 0.5;
      }
      if (samples == 1) return;
      int column[sheet_size]{}, line[sheet_size]{};
      for (int i = 0; i < count_; ++i) {
        column[i] = of[i].x;
        line[i] = of[i].y;
      }
      kernels_.sample(row, column, line, x_, y_);
    });
  }

  void make(std::span<const ImagePoint> points) {
    make(points.size(), [&](std::size_t begin) {
      for (int i = 0; i < count_; ++i) {
        x_[i] = points[begin + static_cast<std::size_t>(i)].x;
        y_[i] = points[begin + static_cast<std::size_t>(i)].y;
      }
    });
  }

 private:
  // `fill(begin)` writes the next count_ points.
  template <class Fill>
  void make(std::size_t points, const Fill& fill) {
    used_ = 0;
    const std::size_t most = (points / sheet_size + 1) * (scene_.regions.size() + 1);
    if (work_.sheet_memory.size() < most) work_.sheet_memory.resize(most);
    for (std::size_t begin = 0; begin < points; begin += sheet_size) {
      count_ = static_cast<int>(std::min<std::size_t>(sheet_size, points - begin));
      fill(begin);
      add_sheets(static_cast<int>(begin));
    }
    work_.sheets = {work_.sheet_memory.data(), used_};
  }

  // One sheet for each of the effects in force among the points.
  void add_sheets(int first_place) {
    SheetScratch::TileSheet& sheet = work_.sheet_memory[used_];
    if (scene_.regions.empty()) {
      sheet.rays.count = count_;
      for (int i = 0; i < count_; ++i) sheet.place[i] = first_place + i;
      aim(sheet, scene_.effects, x_, y_);
      return;
    }
    add_region(scene_.effects, first_place);
    for (const EffectsRegion& region : scene_.regions) add_region(region.effects, first_place);
  }

  void add_region(const Effects& effects, int first_place) {
    SheetScratch::TileSheet& sheet = work_.sheet_memory[used_];
    alignas(64) double x[sheet_size];
    alignas(64) double y[sheet_size];
    int& count = sheet.rays.count;
    count = 0;
    for (int i = 0; i < count_; ++i) {
      if (&effects_at(scene_, {x_[i], y_[i]}) != &effects) continue;
      x[count] = x_[i];
      y[count] = y_[i];
      sheet.place[count++] = first_place + i;
    }
    aim(sheet, effects, x, y);
  }

  // The directions through the points of a sheet, of which it keeps those that the projection shows.
  void aim(SheetScratch::TileSheet& sheet, const Effects& effects, double* x, double* y) {
    SheetRays& rays = sheet.rays;
    sheet.effects = &effects;
    rays.light_delay = effects.light_delay;
    rays.displaced = false;
    const Lens& lens = scene_.camera.lens;
    const bool flat = lens.projection == Projection::perspective;
    if (!flat) keep_shown(lens, x, y, sheet);
    if (rays.count == 0) return;
    ++used_;
    rays.padded = padded_count(rays.count);
    for (int lane = rays.count; lane < rays.padded; ++lane) {
      x[lane] = x[rays.count - 1];
      y[lane] = y[rays.count - 1];
      for (auto& row : rays.direction) row[lane] = row[rays.count - 1];
    }
    if (flat) {
      LaneLens lanes{film_.foot.x, film_.foot.y, film_.step_x, film_.step_y, {}, {}, {}};
      for (int k = 0; k < 3; ++k) {
        lanes.forward[k] = lens.forward[k];
        lanes.right[k] = lens.right[k];
        lanes.up[k] = lens.up[k];
      }
      kernels_.look(lanes, x, y, rays);
    }
    sheet.hits.clear(rays.padded);
    sheet.bundle = kernels_.bundle(rays);
  }

  static void keep_shown(const Lens& lens, const double* x, const double* y, SheetScratch::TileSheet& sheet) {
    SheetRays& rays = sheet.rays;
    int kept = 0;
    for (int i = 0; i < rays.count; ++i) {
      const auto direction = direction_at(lens, {x[i], y[i]});
      if (!direction) continue;
      for (int k = 0; k < 3; ++k) rays.direction[k][kept] = (*direction)[k];
      sheet.place[kept++] = sheet.place[i];
    }
    rays.count = kept;
  }

  const Scene& scene_;
  const SheetKernels& kernels_;
  SheetScratch& work_;
  std::size_t used_ = 0;
  ScreenFilm film_ = film_of(scene_.camera.lens);
  // The points of up to a sheet of pixels.
  int count_ = 0;
  alignas(64) double x_[sheet_size];
  alignas(64) double y_[sheet_size];
};

}  // namespace

void make_rays(const Scene& scene, const SheetKernels& kernels, std::span<const TilePixel> pixels,
               std::int64_t image_number, int sample, SheetScratch& work) {
  SheetMaker(scene, kernels, work).make(pixels, image_number, sample);
}

void make_rays(const Scene& scene, const SheetKernels& kernels, std::span<const ImagePoint> points,
               SheetScratch& work) {
  SheetMaker(scene, kernels, work).make(points);
}

void make_rays(std::size_t first, std::size_t count, SheetScratch& work) {
  const std::size_t sheets = (count + sheet_size - 1) / sheet_size;
  if (work.sheet_memory.size() < sheets) work.sheet_memory.resize(sheets);
  work.sheets = {work.sheet_memory.data(), sheets};
  for (SheetScratch::TileSheet& sheet : work.sheets) {
    SheetRays& rays = sheet.rays;
    rays.count = static_cast<int>(std::min<std::size_t>(sheet_size, count));
    rays.padded = padded_count(rays.count);
    rays.light_delay = rays.displaced = true;
    sheet.effects = work.legs[first].effects;
    for (int lane = 0; lane < rays.padded; ++lane) {
      const std::size_t place = first + static_cast<std::size_t>(std::min(lane, rays.count - 1));
      const CameraRay& ray = work.legs[place].leg.ray;
      sheet.place[lane] = static_cast<int>(place);
      rays.starts.length[lane] = ray.length;
      rays.starts.time[lane] = ray.offset.t;
      for (int k = 0; k < 3; ++k) {
        rays.direction[k][lane] = ray.direction[k];
        rays.starts.place[k][lane] = ray.offset.x[k];
      }
    }
    sheet.hits.clear(rays.padded);
    first += static_cast<std::size_t>(rays.count);
    count -= static_cast<std::size_t>(rays.count);
  }
}

Bundle around(std::span<const SheetScratch::TileSheet> sheets) {
  Vec3 sum{0.0};
  for (const SheetScratch::TileSheet& sheet : sheets) {
    for (int k = 0; k < 3; ++k) sum[k] += sheet.bundle.axis[k];
  }
  Bundle whole;
  const double size = glm::length(sum);
  if (!(size > 0.0)) return whole;
  for (int k = 0; k < 3; ++k) whole.axis[k] = sum[k] / size;
  double cosine = 1.0;
  for (const SheetScratch::TileSheet& sheet : sheets) {
    const Bundle& b = sheet.bundle;
    const double c =
        std::min(1.0, b.axis[0] * whole.axis[0] + b.axis[1] * whole.axis[1] + b.axis[2] * whole.axis[2]);
    const double s = std::sqrt(std::max(0.0, 1.0 - c * c)) + 1e-12;
    // The two angles together, unless they are more than half a turn.
    const bool wide = c * b.sine + s * b.cosine <= 0.0 || b.cosine <= -1.0;
    cosine = wide ? -1.0 : std::min(cosine, c * b.cosine - s * b.sine);
  }
  whole.cosine = std::max(-1.0, cosine - 1e-12);
  whole.sine = std::sqrt(std::max(0.0, 1.0 - whole.cosine * whole.cosine)) + 1e-12;
  return whole;
}

}  // namespace backlight
