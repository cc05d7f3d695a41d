// The shadows on a sheet of points: which frames' surfaces may be in the way of a lamp, and whether they are.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sheet_shading.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// With fewer occluders than this, each sheet of points looks at all of them; with more a tile lists first
// what may shade anything of it.
constexpr int tile_list_from = 48;
// From so many on, the shadow rays of a tile are sorted into packets, each with a list of its own. (Their
// points are found twice for it: some 4 ms of an image of 720x526.)
constexpr int packets_from = 1500;

Vec3 vec(const double (&from)[3][sheet_size], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

}  // namespace

// Whether occluders go along paths of which the moments tell more.
bool SheetShader::narrows(std::size_t light) const {
  return sheets_.lamp(light).any_travels && work_.points.light_delay;
}

// What may shade anything of the tile, where there are so many occluders that it helps to list them.
const LampTable& SheetShader::occluders_of_tile(std::size_t light) {
  const LampTable& all = sheets_.lamp(light).bounded.table();
  if (all.count < tile_list_from && !narrows(light)) return all;
  LampTable& list = work_.tile_lamps[light].table();
  if (list.count == SheetScratch::not_listed) list_for_tile(light, list);
  return list;
}

void SheetShader::list_for_tile(std::size_t light, LampTable& list) const {
  const LaneLamp& lamp = lane_lamp(light, tracer_.scene().lights[light].frame);
  LightSpan span;
  for (const auto& sheet : work_.sheets) {
    if (sheet.effects == effects_) sheets_.kernels().gather(lamp, sheet.rays, sheet.hits, nullptr, span);
  }
  const Vec3 sum{span.sum[0], span.sum[1], span.sum[2]};
  const double size = glm::length(sum);
  Bundle bundle;
  if (size > 0.0) {
    for (int k = 0; k < 3; ++k) bundle.axis[k] = sum[k] / size;
  }
  for (const auto& sheet : work_.sheets) {
    if (sheet.effects == effects_) sheets_.kernels().gather(lamp, sheet.rays, sheet.hits, bundle.axis, span);
  }
  list.count = 0;
  if (span.end < span.begin) return;
  // Twice the room of a chunk's own bundle, which must lie inside this one.
  bundle.cosine = std::max(-1.0, std::min(span.least_cosine, 1.0) - 1e-12);
  bundle.sine = std::sqrt(std::max(0.0, 1.0 - bundle.cosine * bundle.cosine)) + 1e-12;
  bundle.reach = span.reach * (1.0 + 1e-12);
  bundle.time = 0.5 * (span.begin + span.end);
  bundle.half_time = 0.5 * (span.end - span.begin) * (1.0 + 1e-9) +
                     1e-12 * std::max(std::abs(span.begin), std::abs(span.end));
  if (!(size > 0.0)) {
    bundle.cosine = -1.0;
    bundle.sine = 1e-12;
  }
  const LampView& view = sheets_.lamp(light);
  sheets_.kernels().overlapping_lamps(view.bounded.table(), bundle, list);
  if (!narrows(light)) return;
  narrow_travellers(light, bundle, list);
  sheets_.add_travellers(tracer_.scene(), light, view.travellers, bundle, list, work_.passings);
}

// Where the light of a bundle meets the listed occluders that go along paths: spheres smaller than all of
// their ways.
void SheetShader::narrow_travellers(std::size_t light, const Bundle& bundle, LampTable& list) const {
  int kept = 0;
  work_.travellers.clear();
  for (int i = 0; i < list.count; ++i) {
    const int entry = static_cast<int>(list.who[i]);
    const bool narrower = sheets_.entry(entry).travels && bundle.half_time < list.radius[i];
    narrower ? work_.travellers.push_back(entry) : list.copy(i, kept++);
    work_.passings[static_cast<std::size_t>(entry)] = {};
  }
  list.count = kept;
  sheets_.add_travellers(tracer_.scene(), light, work_.travellers, bundle, list, work_.passings);
}

bool SheetShader::in_packets(std::size_t light) const {
  const Light& lamp = tracer_.scene().lights[light];
  const LampView& view = sheets_.lamp(light);
  return lamp.kind == LightKind::point && lamp.shadows && view.in_lanes &&
         view.bounded.table().count >= packets_from;
}

bool SheetShader::wants_packets() const {
  for (std::size_t light = 0; light < tracer_.scene().lights.size(); ++light) {
    if (in_packets(light)) return true;
  }
  return false;
}

void SheetShader::collect() {
  if (!in_lanes() || !resolve()) return;
  const std::vector<Light>& lights = tracer_.scene().lights;
  const int own = static_cast<int>(entry_ - sheets_.entries().data());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!in_packets(i)) continue;
    sheets_.kernels().arrive(lane_lamp(i, entry_->frame), work_.points);
    fill_strength(lights[i]);
    work_.packets[i].add(work_.points, sheet_, is_alone(own) ? own : -1);
  }
}

void SheetShader::sift_packets() {
  sheet_ = -1;
  for (std::size_t i = 0; i < work_.packets.size(); ++i) {
    if (!in_packets(i)) continue;
    work_.packets[i].sift(sheets_.kernels(), sheets_.lamp(i).bounded.table(), work_.packet_lamps);
  }
}

// Whether an entry is one surface.
bool SheetShader::is_alone(int entry) const {
  return sheets_.surfaces(sheets_.entry(entry)).size() == 1;
}

// By the frame's own search, of those of the candidates (one bit for each point) that are still lit.
void SheetShader::try_entry(std::size_t light, int index, std::uint64_t candidates,
                            const PassingBall& passing) {
  const Entry& entry = sheets_.entry(index);
  PointSheet& p = work_.points;
  const auto at = static_cast<std::size_t>(entry.frame);
  if (entry.extended || sheets_.hub().lights[light].to_frame[at].is_robust()) {
    try_extended(light, entry.frame, candidates);
    return;
  }
  const double end = tracer_.scene().lights[light].kind == LightKind::distant ? infinity : 1.0;
  const RaySheet* rays = &p.shadow;
  std::uint64_t open = 0;
  if (&entry == entry_) {
    open = candidates & lit_points();
  } else {
    open = sheets_.kernels().cast(sheets_.eye(eye_).frames[at], sheets_.lamp(light).to_frame[at], candidates,
                                  p, work_.rays);
    rays = &work_.rays;
  }
  if (open == 0) return;
  std::uint64_t dark = sheets_.surfaces(entry).blocked(*rays, open, end, entry.first_number, &p.own, passing);
  for (; dark != 0; dark &= dark - 1) p.lit[__builtin_ctzll(dark)] = 0.0;
}

void SheetShader::try_extended(std::size_t light, int frame, std::uint64_t candidates) {
  PointSheet& p = work_.points;
  const double end = tracer_.scene().lights[light].kind == LightKind::distant ? infinity : 1.0;
  for (int i = 0; i < p.count; ++i) {
    if (((candidates >> i) & 1U) == 0 || !(p.lit[i] > 0.0)) continue;
    scratch_.rays.start(camera_ray_of(i));
    const ShadowSegment segment{{vec(p.way, i), p.way_length[i]},
                                vec(p.shadow.origin, i),
                                vec(p.shadow.direction, i),
                                {p.shadow.start_time[i], p.shadow.time_rate[i]},
                                end};
    if (is_shadowed_in(frame, sheets_.hub(), scratch_.rays, hit(i), sheets_.hub().lights[light], segment)) {
      p.lit[i] = 0.0;
    }
  }
}

void SheetShader::shadow(std::size_t light) {
  const LampView& view = sheets_.lamp(light);
  for (const int i : view.unbounded) {
    try_entry(light, i, ~std::uint64_t{0});
  }
  if (in_packets(light) || !narrows(light)) {
    for (const int i : view.travellers) try_entry(light, i, ~std::uint64_t{0});
  }
  if (view.bounded.table().count == 0 && view.travellers.empty()) return;
  if (tracer_.scene().lights[light].kind == LightKind::distant) {
    shadow_of_distant(light);
    return;
  }
  if (work_.packets[light].has(sheet_)) {
    shadow_by_packets(light);
    return;
  }
  // What may shade anything of the tile, of it what may shade anything of this sheet, of that what may shade
  // a few neighbours: each list is made from the one before.
  const SheetKernels& kernels = sheets_.kernels();
  PointSheet& p = work_.points;
  Bundle bundle;
  if (!kernels.light_bundle(p.light_rays(), 0, p.padded, bundle)) return;
  LampTable& chunk = work_.chunk_lamps.table();
  kernels.overlapping_lamps(occluders_of_tile(light), bundle, chunk);
  if (chunk.count <= few_occluders && !narrows(light)) {
    sift(light, chunk, bundle.time, 0, p.padded);
    return;
  }
  LampTable& near = work_.near_lamps.table();
  if (narrows(light)) {
    narrow_travellers(light, bundle, chunk);
    kernels.overlapping_lamps(chunk, bundle, near);
    sift(light, near, bundle.time, 0, p.padded);
    return;
  }
  for (int first = 0; first < p.padded; first += few) {
    const int last = std::min(first + few, p.padded);
    if (!kernels.light_bundle(p.light_rays(), first, last, bundle)) continue;
    kernels.overlapping_lamps(chunk, bundle, near);
    sift(light, near, bundle.time, first, last);
  }
}

void SheetShader::shadow_by_packets(std::size_t light) {
  const ShadowPackets& packets = work_.packets[light];
  const std::uint64_t shaded = packets.shaded(sheet_);
  PointSheet& p = work_.points;
  for (int i = 0; i < p.count; ++i) {
    if (((shaded >> i) & 1U) != 0) p.lit[i] = 0.0;
  }
  for (const ShadowPackets::Unclear& left : packets.unclear(sheet_)) try_entry(light, left.who, left.rays);
  const int own = static_cast<int>(entry_ - sheets_.entries().data());
  if (entry_->casts_shadows && is_alone(own)) try_entry(light, own, sheets_.kernels().turned(p));
}

// The shadows of the listed occluders on the points from `first` to `last`.
void SheetShader::sift(std::size_t light, const LampTable& near, double time, int first, int last) {
  for (int i = 0; i < near.count; ++i) {
    const int entry = static_cast<int>(near.who[i]);
    const bool own = is_alone(entry) && &sheets_.entry(entry) == entry_;
    const std::uint64_t unclear =
        own ? sheets_.kernels().turned(work_.points)
            : sheets_.kernels().sift(near, i, time, first, last, work_.points.light_rays());
    if (unclear == 0) continue;
    const auto at = static_cast<std::size_t>(entry);
    try_entry(light, entry, unclear, narrows(light) ? work_.passings[at] : PassingBall{});
  }
}

// Parallel light: in an occluder's frame all segments have one direction, and its shadow is a cylinder.
void SheetShader::shadow_of_distant(std::size_t light) {
  const PointSheet& p = work_.points;
  const LampTable& table = sheets_.lamp(light).bounded.table();
  const Light& lamp = tracer_.scene().lights[light];
  const Vec3 from = sheets_.hub().frames[static_cast<std::size_t>(lamp.frame)].camera_event.x;
  const Vec3 middle = vec(p.place, 0);
  const double time = p.relative_emission_time[0];
  double reach = 0.0;  // of the points' events from the first's
  for (int i = 1; i < p.count; ++i) {
    reach =
        std::max(reach, glm::length(vec(p.place, i) - middle) + std::abs(p.relative_emission_time[i] - time));
  }
  for (int i = 0; i < table.count; ++i) {
    const Vec3 w{table.celerity[0][i], table.celerity[1][i], table.celerity[2][i]};
    const Vec3 place{table.place[0][i], table.place[1][i], table.place[2][i]};
    const double turn = table.inverse_gamma_plus_one[i];
    const Vec3 way = middle - from;
    const Vec3 x = place + way + (glm::dot(w, way) * turn - time) * w;
    const Vec3 k = -lamp.direction + (1.0 - glm::dot(w, lamp.direction) * turn) * w;
    const double radius = (table.radius[i] + 2.0 * table.gamma[i] * reach) * (1.0 + 1e-9) +
                          1e-12 * (glm::length(x) + table.gamma[i] * (glm::length(way) + std::abs(time)));
    const double along = glm::dot(x, k) / glm::length(k);
    const double aside = glm::dot(x, x) - along * along;
    if (along > radius || aside > radius * radius + 1e-12 * glm::dot(x, x)) continue;
    try_entry(light, static_cast<int>(table.who[i]), ~std::uint64_t{0});
  }
}

}  // namespace backlight
