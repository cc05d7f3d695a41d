// A tile of rays: made, asked what they meet, painted.
// Longer than 400 lines: the three steps of one tile, in the order in which they are taken.
#include "backlight/trace/sheet_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backlight/camera/sampling.h"
#include "ray_list.h"
#include "sheet_shading.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double far_hit = -2.0;  // `who` of a ray whose hit is in far_hits

using TileSheet = SheetScratch::TileSheet;

CameraRay camera_ray_of(const Scene& scene, const SheetRays& rays, int lane, int eye) {
  CameraRay ray;
  ray.direction = {rays.direction[0][lane], rays.direction[1][lane], rays.direction[2][lane]};
  ray.light_delay = rays.light_delay;
  ray.offset = eye_offset(scene.camera, eye);
  ray.displaced = eye != 0;
  return ray;
}

// The rays of one sample of some pixels, before they meet anything.
class SheetMaker {
 public:
  SheetMaker(const Scene& scene, const SheetKernels& kernels, SheetScratch& work)
      : scene_(scene), kernels_(kernels), work_(work) {}

  // The sheets' order is that of the pixels, and does not change a bit.
  void make(std::span<const TilePixel> pixels, std::int64_t image_number, int sample) {
    const int samples = scene_.film.samples;
    make(pixels.size(), [&](std::size_t begin) {
      const TilePixel* const of = pixels.data() + begin;
      for (int i = 0; i < count_ && samples == 1; ++i) {  // their centres, in vectors of the compiler's
        x_[i] = of[i].x + 0.5;
        y_[i] = of[i].y + 0.5;
      }
      for (int i = 0; i < count_ && samples > 1; ++i) {
        const ImagePoint point =
            sample_point({scene_.film.seed, image_number, of[i].x, of[i].y}, sample, samples);
        x_[i] = point.x;
        y_[i] = point.y;
      }
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
    TileSheet& sheet = work_.sheet_memory[used_];
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
    TileSheet& sheet = work_.sheet_memory[used_];
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
  void aim(TileSheet& sheet, const Effects& effects, double* x, double* y) {
    SheetRays& rays = sheet.rays;
    sheet.effects = &effects;
    rays.light_delay = effects.light_delay;
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
      LaneLens lanes{0.5 * lens.width, 0.5 * lens.height, step_, {}, {}, {}};
      for (int k = 0; k < 3; ++k) {
        lanes.forward[k] = lens.forward[k];
        lanes.right[k] = lens.right[k];
        lanes.up[k] = lens.up[k];
      }
      kernels_.look(lanes, x, y, rays);
    }
    std::fill_n(rays.lambda, rays.padded, infinity);
    std::fill_n(rays.who, rays.padded, -1.0);
    sheet.bundle = kernels_.bundle(rays);
  }

  static void keep_shown(const Lens& lens, const double* x, const double* y, TileSheet& sheet) {
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
  double step_ = perspective_step(scene_.camera.lens);
  // The points of up to a sheet of pixels.
  int count_ = 0;
  alignas(64) double x_[sheet_size];
  alignas(64) double y_[sheet_size];
};

// A bundle around those of all sheets.
Bundle around(std::span<const TileSheet> sheets) {
  Vec3 sum{0.0};
  for (const TileSheet& sheet : sheets) {
    for (int k = 0; k < 3; ++k) sum[k] += sheet.bundle.axis[k];
  }
  Bundle whole;
  const double size = glm::length(sum);
  if (!(size > 0.0)) return whole;
  for (int k = 0; k < 3; ++k) whole.axis[k] = sum[k] / size;
  double cosine = 1.0;
  for (const TileSheet& sheet : sheets) {
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

// What the rays of a tile meet first.
class SheetSearch {
 public:
  SheetSearch(const Tracer& tracer, const SheetScene& scene, int eye, SheetScratch& work, Scratch& scratch)
      : tracer_(tracer), scene_(scene), eye_(eye), work_(work), scratch_(scratch) {}

  void find() {
    const Bundle tile = around(work_.sheets);
    int listed = -1;  // whether tile_cones is for rays with light delay
    for (TileSheet& sheet : work_.sheets) {
      const int delayed = sheet.rays.light_delay ? 1 : 0;
      if (delayed != listed) {
        scene_.kernels().overlapping(scene_.eye(eye_).cones[static_cast<std::size_t>(delayed)].table(), tile,
                                     work_.tile_cones.table());
        listed = delayed;
      }
      scene_.kernels().overlapping(work_.tile_cones.table(), sheet.bundle, work_.sheet_cones.table());
      const ConeTable& near = work_.sheet_cones.table();
      for (int i = 0; i < near.count; ++i) {
        ask(sheet, static_cast<int>(near.who[i]),
            {{near.axis[0][i], near.axis[1][i], near.axis[2][i]}, near.level[i]});
      }
    }
  }

 private:
  // The occupants come in the order of their frames and surfaces, so that of equal λ the first one wins;
  // trees come last, and look for themselves.
  void ask(TileSheet& sheet, int who, const LaneCone& cone) {
    const Occupant& occupant = scene_.occupants()[static_cast<std::size_t>(who)];
    const LaneFrame& frame = scene_.eye(eye_).frames[static_cast<std::size_t>(occupant.frame)];
    if (occupant.lanes->kind != LaneSurface::Kind::other) {
      scene_.kernels().nearest(frame, *occupant.lanes, cone, who, sheet.rays);
      return;
    }
    const std::uint64_t inside = scene_.kernels().inside(sheet.rays, cone);
    if (inside == 0) return;
    if (occupant.surface == Occupant::whole_frame) {
      ask_frame(sheet, occupant, inside);
    } else if (occupant.surface == Occupant::all_bounded) {
      ask_tree(sheet, occupant, frame, inside);
    } else {
      ask_surface(sheet, who, occupant, frame, inside);
    }
  }

  void ask_surface(TileSheet& sheet, int who, const Occupant& occupant, const LaneFrame& frame,
                   std::uint64_t inside) {
    const SurfaceSet& surfaces =
        *tracer_.hub().frames[static_cast<std::size_t>(occupant.frame)].scene->surfaces;
    alignas(64) double direction[4][sheet_size];
    scene_.kernels().in_frame(frame, sheet.rays, direction);
    RayList rays;
    for (; inside != 0; inside &= inside - 1) {
      const int lane = __builtin_ctzll(inside);
      const auto of = static_cast<std::size_t>(lane);
      rays.add(lane, Vec3{frame.origin[0], frame.origin[1], frame.origin[2]},
               Vec3{direction[0][of], direction[1][of], direction[2][of]}, {frame.time, direction[3][of]});
    }
    Hit hits[sheet_size];
    surfaces.first_crossings_of(occupant.surface, rays.rays(), hits);
    for (std::size_t i = 0; i < rays.count(); ++i) {
      const int lane = rays.lane(i);
      if (!(hits[i].lambda < sheet.rays.lambda[lane])) continue;
      take(sheet, static_cast<std::size_t>(lane), who, hits[i]);
    }
  }

  void ask_tree(TileSheet& sheet, const Occupant& occupant, const LaneFrame& frame, std::uint64_t inside) {
    const SurfaceSet& surfaces =
        *tracer_.hub().frames[static_cast<std::size_t>(occupant.frame)].scene->surfaces;
    alignas(64) double direction[4][sheet_size];
    scene_.kernels().in_frame(frame, sheet.rays, direction);
    const Vec3 origin{frame.origin[0], frame.origin[1], frame.origin[2]};
    for (; inside != 0; inside &= inside - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctzll(inside));
      const double limit = std::nextafter(sheet.rays.lambda[lane], infinity);  // what is equally far counts
      const Hit hit =
          surfaces.nearest_bounded(origin, Vec3{direction[0][lane], direction[1][lane], direction[2][lane]},
                                   limit, {frame.time, direction[3][lane]});
      if (!hit.found()) continue;
      const int who = occupant.first + hit.surface;
      if (hit.lambda == sheet.rays.lambda[lane] && is_earlier(sheet, lane, occupant.frame, who)) continue;
      take(sheet, lane, who, hit);
    }
  }

  static void take(TileSheet& sheet, std::size_t lane, int who, const Hit& hit) {
    sheet.rays.lambda[lane] = hit.lambda;
    sheet.rays.who[lane] = who;
    sheet.part[lane] = hit.part;
    sheet.unresolved[lane] = hit.unresolved;
    sheet.along[lane] = hit.along;
  }

  // Whether what a lane has met comes earlier in the scene than an occupant.
  bool is_earlier(const TileSheet& sheet, std::size_t lane, int frame, int who) const {
    if (sheet.rays.who[lane] != far_hit) return sheet.rays.who[lane] < who;
    return work_.far_hits[static_cast<std::size_t>(sheet.place[lane])].frame < frame;
  }

  void ask_frame(TileSheet& sheet, const Occupant& occupant, std::uint64_t inside) {
    for (; inside != 0; inside &= inside - 1) {
      const int lane = __builtin_ctzll(inside);
      scratch_.rays.start(camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_));
      const FirstHit hit =
          first_hit_in(occupant.frame, tracer_.hub(), scratch_.rays, sheet.rays.lambda[lane]);
      if (!hit.found()) continue;
      const auto place = static_cast<std::size_t>(sheet.place[lane]);
      if (work_.far_hits.size() <= place) work_.far_hits.resize(place + 1);
      work_.far_hits[place] = hit;
      sheet.rays.lambda[lane] = double(work_.far_hits[place].lambda);
      sheet.rays.who[lane] = far_hit;
    }
  }

  const Tracer& tracer_;
  const SheetScene& scene_;
  int eye_;
  SheetScratch& work_;
  Scratch& scratch_;
};

// The colours of a tile, once it is known what its rays meet.
class SheetPainter {
 public:
  SheetPainter(const Tracer& tracer, const SheetScene& scene, int eye, bool records, SheetScratch& work,
               Scratch& scratch, TileLight& light)
      : tracer_(tracer),
        scene_(scene),
        eye_(eye),
        records_(records),
        work_(work),
        scratch_(scratch),
        light_(light),
        shader_(tracer, scene, eye, work, scratch) {}

  void paint() {
    const Scene& scene = tracer_.scene();
    paint(scene.effects);
    for (const EffectsRegion& region : scene.regions) paint(region.effects);
  }

 private:
  void paint(const Effects& effects) {
    sort(effects);
    if (work_.groups.empty()) return;
    shader_.begin_tile(effects);
    work_.points.light_delay = effects.light_delay;
    if (shader_.wants_packets()) {
      for_each_sheet([&](const Occupant& occupant) { shader_.collect(occupant); });
      shader_.sift_packets();
    }
    for_each_sheet([&](const Occupant& occupant) { paint_points(occupant, effects); });
  }

  // Whole sheets as they are; what is left of others together, so that lanes are filled.
  template <class Work>
  void for_each_sheet(const Work& work) {
    for (const auto& group : work_.groups) {
      const Occupant& occupant = scene_.occupants()[static_cast<std::size_t>(group.who)];
      const auto do_points = [&] {
        pad_points();
        work(occupant);
        work_.points.count = 0;
      };
      for (int i = group.next - group.count; i < group.next; ++i) {
        const auto& part = work_.sorted[static_cast<std::size_t>(i)];
        if (part.mask != ~std::uint64_t{0}) continue;
        gather(occupant, part);
        do_points();
      }
      for (int i = group.next - group.count; i < group.next; ++i) {
        auto part = work_.sorted[static_cast<std::size_t>(i)];
        if (part.mask == ~std::uint64_t{0}) continue;
        while (part.mask != 0) {
          part.mask = gather(occupant, part);
          if (work_.points.count == sheet_size) do_points();
        }
      }
      if (work_.points.count > 0) do_points();
    }
  }

  // Sorts the lanes by what they hit, and paints those that hit nothing, or something far away in a fast
  // frame.
  void sort(const Effects& effects) {
    work_.groups.clear();
    work_.parts.clear();
    for (std::size_t s = 0; s < work_.sheets.size(); ++s) {
      const TileSheet& sheet = work_.sheets[s];
      if (sheet.effects != &effects) continue;
      std::uint64_t left = first_bits(sheet.rays.count);
      while (left != 0) {
        const double who = sheet.rays.who[__builtin_ctzll(left)];
        const std::uint64_t mask = left & scene_.kernels().same(sheet.rays, who);
        left &= ~mask;
        if (who < 0.0) {
          without_surface(sheet, mask, who == far_hit);
          continue;
        }
        int& group = work_.group_of[static_cast<std::size_t>(who)];
        if (group < 0) {
          group = static_cast<int>(work_.groups.size());
          work_.groups.push_back({static_cast<int>(who), 0, 0});
        }
        ++work_.groups[static_cast<std::size_t>(group)].count;
        work_.parts.push_back({group, static_cast<int>(s), mask});
      }
    }
    int total = 0;
    for (auto& group : work_.groups) {
      work_.group_of[static_cast<std::size_t>(group.who)] = -1;
      group.next = total;
      total += group.count;
    }
    work_.sorted.resize(work_.parts.size());
    for (const auto& part : work_.parts) {
      int& next = work_.groups[static_cast<std::size_t>(part.group)].next;
      work_.sorted[static_cast<std::size_t>(next++)] = part;
    }
  }

  void without_surface(const TileSheet& sheet, std::uint64_t mask, bool far) {
    const Sky& sky = tracer_.scene().sky;
    if (!far && !sky.given) {
      for (std::uint64_t left = mask; left != 0; left &= left - 1) {
        light_.covered[static_cast<std::size_t>(sheet.place[__builtin_ctzll(left)])] = 0;
      }
    }
    if (!far && !records_ && !sky.emits) {
      for (; mask != 0; mask &= mask - 1) {
        light_.set_colour(static_cast<std::size_t>(sheet.place[__builtin_ctzll(mask)]), LinearRgb{0.0});
      }
      return;
    }
    for (; mask != 0; mask &= mask - 1) {
      const int lane = __builtin_ctzll(mask);
      one_ray(sheet, lane, far ? work_.far_hits[static_cast<std::size_t>(sheet.place[lane])] : FirstHit{});
    }
  }

  // One ray by the law alone, but for the search.
  void one_ray(const TileSheet& sheet, int lane, const FirstHit& hit) {
    const auto place = static_cast<std::size_t>(sheet.place[lane]);
    const bool dark = !hit.found() && !tracer_.scene().sky.emits;
    const CameraRay ray = camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_);
    scratch_.rays.start(ray);
    light_.set_colour(place, dark ? LinearRgb{0.0} : tracer_.colour_of(ray, hit, *sheet.effects, scratch_));
    if (records_) light_.record[place] = tracer_.surface_of(ray, hit, scratch_);
  }

  // Adds lanes of a sheet to the points, as many as there is room for; returns the others.
  std::uint64_t gather(const Occupant& occupant, const SheetScratch::Part& part) {
    PointSheet& p = work_.points;
    const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(part.sheet)];
    const int first = p.count;
    std::uint64_t left = part.mask;
    if (left == ~std::uint64_t{0}) {
      take_whole(part.sheet, sheet.rays);
      left = 0;
    } else if (first == 0) {
      p.whole = -1;
      for (int k = 0; k < 3; ++k) p.direction[k] = p.gathered[k];
      p.lambda = p.gathered[3];
    }
    for (; left != 0 && p.count < sheet_size; left &= left - 1, ++p.count) {
      const int lane = __builtin_ctzll(left);
      p.lane[p.count] = part.sheet * sheet_size + lane;
      for (int k = 0; k < 3; ++k) p.gathered[k][p.count] = sheet.rays.direction[k][lane];
      p.gathered[3][p.count] = sheet.rays.lambda[lane];
    }
    if (occupant.lanes->kind != LaneSurface::Kind::other) return left;
    for (int i = first; i < p.count; ++i) {
      const int lane = p.lane[i] % sheet_size;
      work_.hits[i] = {p.lambda[i], occupant.surface, sheet.part[lane], sheet.unresolved[lane],
                       sheet.along[lane]};
    }
    return left;
  }

  void take_whole(int index, const SheetRays& rays) {
    PointSheet& p = work_.points;
    p.whole = index;
    for (int k = 0; k < 3; ++k) p.direction[k] = rays.direction[k];
    p.lambda = rays.lambda;
    for (int i = 0; i < sheet_size; ++i) p.lane[i] = index * sheet_size + i;
    p.count = sheet_size;
  }

  void pad_points() {
    PointSheet& p = work_.points;
    p.padded = padded_count(p.count);
    for (int i = p.count; i < p.padded; ++i) {
      for (auto& row : p.gathered) row[i] = row[p.count - 1];
    }
  }

  // The colours of the points gathered, all of one surface.
  void paint_points(const Occupant& occupant, const Effects& effects) {
    const PointSheet& p = work_.points;
    shader_.begin_points(occupant);
    if (scene_.lit_in_lanes(occupant.frame) && shader_.shade(occupant, effects)) {
      put_colours(occupant);
      return;
    }
    for (int i = 0; i < p.count; ++i) {
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
      one_ray(sheet, p.lane[i] % sheet_size, shader_.hit(i));
    }
  }

  void put_colours(const Occupant& occupant) {
    const PointSheet& p = work_.points;
    const bool other = occupant.lanes->kind == LaneSurface::Kind::other;
    if (p.whole >= 0 && !other && !records_) {
      const int first = work_.sheets[static_cast<std::size_t>(p.whole)].place[0];  // of 64 neighbours
      for (std::size_t k = 0; k < 3; ++k) std::copy_n(p.rgb[k], sheet_size, light_.rgb[k].data() + first);
      return;
    }
    for (int i = 0; i < p.count; ++i) {
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
      const auto place = static_cast<std::size_t>(sheet.place[p.lane[i] % sheet_size]);
      light_.set_colour(place, {p.rgb[0][i], p.rgb[1][i], p.rgb[2][i]});
      if (other && work_.hits[i].unresolved) ++scratch_.counts.unresolved;
      if (records_) light_.record[place] = record_of(i);
    }
  }

  SurfaceRecord record_of(int i) {
    const PointSheet& p = work_.points;
    const Scene& scene = tracer_.scene();
    scratch_.rays.start(shader_.camera_ray_of(i));
    const FirstHit hit = shader_.hit(i);
    SurfaceRecord record;
    record.object_id = object_of(scene, hit).id;
    record.distance = p.lambda[i];
    record.doppler = p.doppler[i];
    record.emission_time = scratch_.rays.in(0).at(Extended(p.lambda[i])).t / scene.c;
    record.proper_time = p.proper_time[i] / scene.c;
    record.position = {p.position[0][i], p.position[1][i], p.position[2][i]};
    record.normal = {p.normal[0][i], p.normal[1][i], p.normal[2][i]};
    record.unresolved = hit.hit.unresolved;
    return record;
  }

  const Tracer& tracer_;
  const SheetScene& scene_;
  int eye_;
  bool records_;
  SheetScratch& work_;
  Scratch& scratch_;
  TileLight& light_;
  SheetShader shader_;
};

}  // namespace

SheetTracer::SheetTracer(const Tracer& tracer, InstructionSet set)
    : tracer_(&tracer),
      scene_(std::make_unique<SheetScene>(tracer.scene(), tracer.hub(), sheet_kernels(set))) {}

SheetTracer::~SheetTracer() = default;

bool SheetTracer::can_trace(const Scene& scene) {
  return !scene.camera.stereo || scene.camera.lens.projection != Projection::equirectangular;
}

std::unique_ptr<SheetScratch, void (*)(SheetScratch*)> SheetTracer::make_scratch() const {
  return {new SheetScratch(*scene_, tracer_->scene().lights.size()), [](SheetScratch* work) { delete work; }};
}

void SheetTracer::trace(std::span<const TilePixel> pixels, std::int64_t image_number, int sample, int eye,
                        bool records, SheetScratch& work, Scratch& scratch, TileLight& light) const {
  SheetMaker(tracer_->scene(), scene_->kernels(), work).make(pixels, image_number, sample);
  trace_sheets(pixels.size(), eye, records, work, scratch, light);
}

void SheetTracer::trace(std::span<const ImagePoint> points, int eye, SheetScratch& work, Scratch& scratch,
                        TileLight& light) const {
  SheetMaker(tracer_->scene(), scene_->kernels(), work).make(points);
  trace_sheets(points.size(), eye, false, work, scratch, light);
}

void SheetTracer::trace_sheets(std::size_t count, int eye, bool records, SheetScratch& work, Scratch& scratch,
                               TileLight& light) const {
  light.record.assign(records ? count : 0, SurfaceRecord{});
  std::size_t rays = 0;
  for (const auto& sheet : work.sheets) rays += static_cast<std::size_t>(sheet.rays.count);
  scratch.counts.primary += rays;
  const bool all_shown = rays == count;
  light.covered.assign(count, all_shown ? 1 : 0);
  for (std::vector<double>& channel : light.rgb) {
    channel.resize(count);
    if (!all_shown) std::ranges::fill(channel, 0.0);
  }
  if (rays == 0) return;
  for (std::size_t i = 0; !all_shown && i < work.sheets.size(); ++i) {
    const TileSheet& sheet = work.sheets[i];
    for (int lane = 0; lane < sheet.rays.count; ++lane) {
      light.covered[static_cast<std::size_t>(sheet.place[lane])] = 1;
    }
  }
  SheetSearch(*tracer_, *scene_, eye, work, scratch).find();
  SheetPainter(*tracer_, *scene_, eye, records, work, scratch, light).paint();
}

const char* SheetTracer::instructions() const {
  return scene_->kernels().name;
}

}  // namespace backlight
