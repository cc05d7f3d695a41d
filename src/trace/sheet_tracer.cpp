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
    used_ = 0;
    const std::size_t most = (pixels.size() / sheet_size + 1) * (scene_.regions.size() + 1);
    if (work_.sheet_memory.size() < most) work_.sheet_memory.resize(most);
    for (std::size_t begin = 0; begin < pixels.size(); begin += sheet_size) {
      const std::size_t end = std::min(begin + sheet_size, pixels.size());
      points_.clear();
      if (scene_.film.samples == 1) {
        for (std::size_t i = begin; i < end; ++i) points_.push_back({pixels[i].x + 0.5, pixels[i].y + 0.5});
      }
      for (std::size_t i = begin; i < end && scene_.film.samples > 1; ++i) {
        const SampleKey key{scene_.film.seed, image_number, pixels[i].x, pixels[i].y};
        points_.push_back(sample_point(key, sample, scene_.film.samples));
      }
      add_sheets(static_cast<int>(begin));
    }
    work_.sheets = {work_.sheet_memory.data(), used_};
  }

 private:
  // One sheet for each of the effects in force among the points.
  void add_sheets(int first_place) {
    if (scene_.regions.empty()) {
      add_sheet(scene_.effects, first_place);
      return;
    }
    add_sheet(scene_.effects, first_place);
    for (const EffectsRegion& region : scene_.regions) add_sheet(region.effects, first_place);
  }

  void add_sheet(const Effects& effects, int first_place) {
    TileSheet& sheet = work_.sheet_memory[used_];
    SheetRays& rays = sheet.rays;
    sheet.effects = &effects;
    rays.light_delay = effects.light_delay;
    rays.count = 0;
    const bool flat = scene_.camera.lens.projection == Projection::perspective;
    alignas(64) double x[sheet_size];
    alignas(64) double y[sheet_size];
    const Lens& lens = scene_.camera.lens;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const ImagePoint& point = points_[i];
      if (!scene_.regions.empty() && &effects_at(scene_, point) != &effects) continue;
      const int lane = rays.count;
      if (flat) {
        x[lane] = point.x;
        y[lane] = point.y;
      } else {
        const auto direction = direction_at(lens, point);
        if (!direction) continue;
        for (int k = 0; k < 3; ++k) rays.direction[k][lane] = (*direction)[k];
      }
      sheet.place[lane] = first_place + static_cast<int>(i);
      ++rays.count;
    }
    if (rays.count == 0) return;
    ++used_;
    rays.padded = (rays.count + 3) / 4 * 4;
    for (int lane = rays.count; lane < rays.padded; ++lane) {
      x[lane] = x[rays.count - 1];
      y[lane] = y[rays.count - 1];
      for (auto& row : rays.direction) row[lane] = row[rays.count - 1];
    }
    if (flat) {
      LaneLens lanes{0.5 * lens.width, 0.5 * lens.height, perspective_step(lens), {}, {}, {}};
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

  const Scene& scene_;
  const SheetKernels& kernels_;
  SheetScratch& work_;
  std::size_t used_ = 0;
  std::vector<ImagePoint> points_;
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
        ask(sheet, near.who[i], {{near.axis[0][i], near.axis[1][i], near.axis[2][i]}, near.level[i]});
      }
    }
  }

 private:
  // The occupants come in the order of their frames and surfaces, so that of equal λ the first one wins.
  void ask(TileSheet& sheet, int who, const LaneCone& cone) {
    const Occupant& occupant = scene_.occupants()[static_cast<std::size_t>(who)];
    const LaneFrame& frame = scene_.eye(eye_).frames[static_cast<std::size_t>(occupant.frame)];
    if (occupant.lanes.kind != LaneSurface::Kind::other) {
      scene_.kernels().nearest(frame, occupant.lanes, cone, who, sheet.rays);
      return;
    }
    const std::uint64_t inside = scene_.kernels().inside(sheet.rays, cone);
    if (inside == 0) return;
    occupant.surface < 0 ? ask_frame(sheet, occupant, inside)
                         : ask_surface(sheet, who, occupant, frame, inside);
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
      sheet.rays.lambda[lane] = hits[i].lambda;
      sheet.rays.who[lane] = who;
      sheet.part[lane] = hits[i].part;
      sheet.unresolved[lane] = hits[i].unresolved;
      sheet.along[lane] = hits[i].along;
    }
  }

  void ask_frame(TileSheet& sheet, const Occupant& occupant, std::uint64_t inside) {
    const SurfaceSet& surfaces =
        *tracer_.hub().frames[static_cast<std::size_t>(occupant.frame)].scene->surfaces;
    for (; inside != 0; inside &= inside - 1) {
      const int lane = __builtin_ctzll(inside);
      scratch_.rays.start(camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_));
      const RestRayEvents& ray = scratch_.rays.in(occupant.frame);
      const Hit hit =
          surfaces.nearest(ray.origin, ray.direction, sheet.rays.lambda[lane] - ray.start, ray.clock());
      if (!hit.found()) continue;
      const auto place = static_cast<std::size_t>(sheet.place[lane]);
      if (work_.far_hits.size() <= place) work_.far_hits.resize(place + 1);
      work_.far_hits[place] = {hit, occupant.frame, Extended(ray.start) + Extended(hit.lambda)};
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
    for (const auto& group : work_.groups) {
      const Occupant& occupant = scene_.occupants()[static_cast<std::size_t>(group.who)];
      for (int first = group.next - group.count; first < group.next; first += sheet_size) {
        points(occupant, effects, first, std::min(sheet_size, group.next - first));
      }
    }
  }

  // Sorts the lanes by what they hit, and paints those that hit nothing, or something far away in a fast
  // frame.
  void sort(const Effects& effects) {
    work_.groups.clear();
    for (std::size_t s = 0; s < work_.sheets.size(); ++s) {
      const TileSheet& sheet = work_.sheets[s];
      if (sheet.effects != &effects) continue;
      for (int lane = 0; lane < sheet.rays.count; ++lane) {
        light_.covered[static_cast<std::size_t>(sheet.place[lane])] = 1;
        const double who = sheet.rays.who[lane];
        if (who < 0.0) {
          one_ray(sheet, lane,
                  who == far_hit ? work_.far_hits[static_cast<std::size_t>(sheet.place[lane])] : FirstHit{});
          continue;
        }
        int& group = work_.group_of[static_cast<std::size_t>(who)];
        if (group < 0) {
          group = static_cast<int>(work_.groups.size());
          work_.groups.push_back({static_cast<int>(who), 0, 0});
        }
        ++work_.groups[static_cast<std::size_t>(group)].count;
      }
    }
    int total = 0;
    for (auto& group : work_.groups) {
      group.next = total;
      total += group.count;
    }
    work_.order.resize(static_cast<std::size_t>(total));
    for (std::size_t s = 0; s < work_.sheets.size(); ++s) {
      const TileSheet& sheet = work_.sheets[s];
      if (sheet.effects != &effects) continue;
      for (int lane = 0; lane < sheet.rays.count; ++lane) {
        if (sheet.rays.who[lane] < 0.0) continue;
        const int group = work_.group_of[static_cast<std::size_t>(sheet.rays.who[lane])];
        int& next = work_.groups[static_cast<std::size_t>(group)].next;
        work_.order[static_cast<std::size_t>(next++)] = static_cast<int>(s) * sheet_size + lane;
      }
    }
    for (const auto& group : work_.groups) work_.group_of[static_cast<std::size_t>(group.who)] = -1;
  }

  // One ray by the law alone, but for the search.
  void one_ray(const TileSheet& sheet, int lane, const FirstHit& hit) {
    const auto place = static_cast<std::size_t>(sheet.place[lane]);
    const bool dark = !hit.found() && !tracer_.scene().sky.emits;
    if (dark && !records_) {
      light_.colour[place] = LinearRgb{0.0};
      return;
    }
    const CameraRay ray = camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_);
    scratch_.rays.start(ray);
    light_.colour[place] = dark ? LinearRgb{0.0} : tracer_.colour_of(ray, hit, *sheet.effects, scratch_);
    if (records_) light_.record[place] = tracer_.surface_of(ray, hit, scratch_);
  }

  void points(const Occupant& occupant, const Effects& effects, int first, int count) {
    PointSheet& p = work_.points;
    p.count = count;
    p.padded = (count + 3) / 4 * 4;
    p.light_delay = effects.light_delay;
    for (int i = 0; i < p.padded; ++i) {
      const int from = work_.order[static_cast<std::size_t>(first + std::min(i, count - 1))];
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(from / sheet_size)];
      const int lane = from % sheet_size;
      for (int k = 0; k < 3; ++k) p.direction[k][i] = sheet.rays.direction[k][lane];
      p.lambda[i] = sheet.rays.lambda[lane];
      p.lane[i] = from;
      const bool other = occupant.lanes.kind == LaneSurface::Kind::other;
      hits_[i] = {sheet.rays.lambda[lane], occupant.surface, other ? sheet.part[lane] : 0,
                  other && sheet.unresolved[lane]};
      if (other) hits_[i].along = sheet.along[lane];
    }
    const bool lit = scene_.lit_in_lanes(occupant.frame);
    if (!lit || !shader_.shade(occupant, effects, {hits_, static_cast<std::size_t>(count)})) {
      for (int i = 0; i < count; ++i) {
        const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
        one_ray(sheet, p.lane[i] % sheet_size, first_hit_of(occupant, i));
      }
      return;
    }
    for (int i = 0; i < count; ++i) {
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
      const auto place = static_cast<std::size_t>(sheet.place[p.lane[i] % sheet_size]);
      light_.colour[place] = {p.rgb[0][i], p.rgb[1][i], p.rgb[2][i]};
      if (hits_[i].unresolved) ++scratch_.counts.unresolved;
      if (records_) light_.record[place] = record_of(occupant, i);
    }
  }

  [[nodiscard]] FirstHit first_hit_of(const Occupant& occupant, int i) const {
    return {hits_[i], occupant.frame, Extended(work_.points.lambda[i])};
  }

  SurfaceRecord record_of(const Occupant& occupant, int i) {
    const PointSheet& p = work_.points;
    const Scene& scene = tracer_.scene();
    scratch_.rays.start(shader_.camera_ray_of(i));
    SurfaceRecord record;
    record.object_id = object_of(scene, first_hit_of(occupant, i)).id;
    record.distance = p.lambda[i];
    record.doppler = p.doppler[i];
    record.emission_time = scratch_.rays.in(0).at(Extended(p.lambda[i])).t / scene.c;
    record.proper_time = p.proper_time[i] / scene.c;
    record.position = {p.position[0][i], p.position[1][i], p.position[2][i]};
    record.normal = {p.normal[0][i], p.normal[1][i], p.normal[2][i]};
    record.unresolved = hits_[i].unresolved;
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
  Hit hits_[sheet_size];
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
  light.colour.assign(pixels.size(), LinearRgb{0.0});
  light.covered.assign(pixels.size(), 0);
  light.record.assign(records ? pixels.size() : 0, SurfaceRecord{});
  SheetMaker(tracer_->scene(), scene_->kernels(), work).make(pixels, image_number, sample);
  if (work.sheets.empty()) return;
  for (const auto& sheet : work.sheets) {
    scratch.counts.primary += static_cast<std::uint64_t>(sheet.rays.count);
  }
  SheetSearch(*tracer_, *scene_, eye, work, scratch).find();
  SheetPainter(*tracer_, *scene_, eye, records, work, scratch, light).paint();
}

const char* SheetTracer::instructions() const {
  return scene_->kernels().name;
}

}  // namespace backlight
