// What the rays of a tile meet first.
#include "tile_rays.h"

namespace backlight {
namespace {

using TileSheet = SheetScratch::TileSheet;

class SheetSearch {
 public:
  SheetSearch(const Tracer& tracer, const SheetScene& scene, int eye, SheetScratch& work, Scratch& scratch)
      : tracer_(tracer), scene_(scene), eye_(eye), work_(work), scratch_(scratch) {}

  void find() {
    if (!work_.legs.empty()) {
      find_from_relay();
      return;
    }
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
  // Rays that start apart: no cone bounds them, but each frame's surfaces have a ball.
  void find_from_relay() {
    for (TileSheet& sheet : work_.sheets) {
      for (std::size_t i = 0; i < scene_.entries().size(); ++i) {
        const Entry& entry = scene_.entries()[i];
        const LaneFrame& frame = scene_.eye(eye_).frames[static_cast<std::size_t>(entry.frame)];
        const std::uint64_t inside =
            scene_.kernels().enter_near(frame, scene_.ball(i), sheet.rays, work_.rays);
        if (inside != 0) scene_.surfaces(entry).nearest(work_.rays, inside, entry.first_number, sheet.hits);
      }
    }
  }

  // The entries come in the order of their frames, so that of equal λ the first one wins.
  void ask(TileSheet& sheet, int index, const LaneCone& cone) {
    const Entry& entry = scene_.entry(index);
    const LaneFrame& frame = scene_.eye(eye_).frames[static_cast<std::size_t>(entry.frame)];
    const std::uint64_t inside = scene_.kernels().enter(frame, cone, sheet.rays, work_.rays);
    if (inside == 0) return;
    if (entry.extended) {
      ask_extended(sheet, entry, inside);
    } else {
      scene_.surfaces(entry).nearest(work_.rays, inside, entry.first_number, sheet.hits,
                                     scene_.eye(eye_).passings[static_cast<std::size_t>(index)]);
    }
  }

  // Rays in a frame of large γ are brought next to its surfaces in extended precision, one by one, and asked
  // together; those without bounds are each met from close by, as the law has it.
  void ask_extended(TileSheet& sheet, const Entry& entry, std::uint64_t inside) {
    const FrameView& view = tracer_.hub().frames[static_cast<std::size_t>(entry.frame)];
    const bool by_law = view.far && !view.far->unbounded.empty();
    FirstHit hits[sheet_size];
    RestRayEvents rays[sheet_size];
    for (std::uint64_t left = inside; left != 0; left &= left - 1) {
      const int lane = __builtin_ctzll(left);
      scratch_.rays.start(camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_));
      if (by_law) {
        hits[lane] = first_hit_in(entry.frame, tracer_.hub(), scratch_.rays, sheet.hits.lambda[lane]);
      } else {
        rays[lane] = scratch_.rays.in(entry.frame);
      }
    }
    if (!by_law) ask_together(sheet, entry, inside, rays, hits);
    for (; inside != 0; inside &= inside - 1) {
      const int lane = __builtin_ctzll(inside);
      if (!hits[lane].found()) continue;
      const auto place = static_cast<std::size_t>(sheet.place[lane]);
      if (work_.far_hits.size() <= place) work_.far_hits.resize(place + 1);
      work_.far_hits[place] = hits[lane];
      sheet.hits.lambda[lane] = double(hits[lane].lambda);
      sheet.hits.who[lane] = far_hit;
    }
  }

  void ask_together(const TileSheet& sheet, const Entry& entry, std::uint64_t inside,
                    const RestRayEvents (&rays)[sheet_size], FirstHit (&hits)[sheet_size]) {
    RaySheet& together = work_.rays;
    SheetHits near;
    together.one_origin = false;
    for (int lane = 0; lane < together.padded; ++lane) {
      const bool asked = ((inside >> lane) & 1U) != 0;
      const RestRayEvents& ray = rays[asked ? lane : __builtin_ctzll(inside)];
      for (int k = 0; k < 3; ++k) {
        together.origin[k][lane] = ray.origin[k];
        together.direction[k][lane] = ray.direction[k];
      }
      together.length[lane] = glm::length(ray.direction);
      together.start_time[lane] = ray.time;
      together.time_rate[lane] = ray.time_rate;
      near.lambda[lane] = sheet.hits.lambda[lane] - ray.start;
      near.who[lane] = -1.0;
    }
    scene_.surfaces(entry).nearest(together, inside, 0.0, near);
    for (; inside != 0; inside &= inside - 1) {
      const int lane = __builtin_ctzll(inside);
      if (near.who[lane] < 0.0) continue;
      const Hit hit{near.lambda[lane], static_cast<int>(near.who[lane]), near.part_of(lane),
                    near.is_unresolved(lane), near.along[lane]};
      hits[lane] = {hit, entry.frame, rays[lane].start, Extended(rays[lane].start) + Extended(hit.lambda)};
    }
  }

  const Tracer& tracer_;
  const SheetScene& scene_;
  int eye_;
  SheetScratch& work_;
  Scratch& scratch_;
};

}  // namespace

CameraRay camera_ray_of(const Scene& scene, const SheetRays& rays, int lane, int eye) {
  CameraRay ray;
  ray.direction = {rays.direction[0][lane], rays.direction[1][lane], rays.direction[2][lane]};
  ray.light_delay = rays.light_delay;
  ray.offset = eye_offset(scene.camera, eye);
  ray.displaced = eye != 0;
  return ray;
}

void find_hits(const Tracer& tracer, const SheetScene& scene, int eye, SheetScratch& work, Scratch& scratch) {
  SheetSearch(tracer, scene, eye, work, scratch).find();
}

}  // namespace backlight
