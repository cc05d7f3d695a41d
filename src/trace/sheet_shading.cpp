// Longer than 400 lines: the steps of one sheet's light, in the order in which they are taken.
#include "sheet_shading.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "culling.h"
#include "ray_list.h"
#include "shading_steps.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

// With more occluders than this near a sheet of points...
constexpr int few_occluders = 4;
// ...as many points have a list of their own.
constexpr int few = 16;
// How often packets of shadow rays are divided.
constexpr std::size_t packet_levels = 7;

Vec3 vec(const double (&from)[3][sheet_size], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

void put(const Vec3& a, double (&to)[3][sheet_size], int lane) {
  for (int k = 0; k < 3; ++k) to[k][lane] = a[k];
}

std::uint64_t lit_bits(const PointSheet& p) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < std::size(p.lit); ++i) {
    if (static_cast<int>(i) < p.count && p.lit[i] > 0.0) bits |= std::uint64_t{1} << i;
  }
  return bits;
}

}  // namespace

LaneBrightness lane_brightness(const BrightnessSwitches& on) {
  const int rate = on.arrival_rate == ArrivalRate::exact      ? 0
                   : on.arrival_rate == ArrivalRate::dilation ? 1
                                                              : 2;
  return {on.photon_energy, rate, on.solid_angle};
}

SheetScratch::SheetScratch(const SheetScene& scene, std::size_t lights)
    : tile_lamps(lights), packets(lights), group_of(scene.occupants().size(), -1) {
  tile_cones.resize(scene.occupants().size());
  sheet_cones.resize(scene.occupants().size());
  for (LampStore& lamps : tile_lamps) lamps.resize(scene.occluders().size());
  packet_lamps.resize(packet_levels);
  for (LampStore& lamps : packet_lamps) lamps.resize(scene.occluders().size());
  chunk_lamps.resize(scene.occluders().size());
  near_lamps.resize(scene.occluders().size());
}

CameraRay SheetShader::camera_ray_of(int lane) const {
  CameraRay ray;
  const PointSheet& p = work_.points;
  ray.direction = {p.direction[0][lane], p.direction[1][lane], p.direction[2][lane]};
  ray.light_delay = work_.points.light_delay;
  ray.offset = eye_offset(tracer_.scene().camera, eye_);
  ray.displaced = eye_ != 0;
  return ray;
}

LaneLamp SheetShader::lane_lamp(std::size_t light, int frame) const {
  const Light& lamp = tracer_.scene().lights[light];
  LaneLamp lanes;
  lanes.frame = sheets_.eye(eye_).frames[static_cast<std::size_t>(lamp.frame)];
  lanes.to_surface = sheets_.lamp(light).to_frame[static_cast<std::size_t>(frame)];
  lanes.time_offset =
      lanes.frame.time - tracer_.hub().frames[static_cast<std::size_t>(lamp.frame)].camera_event.t;
  lanes.own_frame = lamp.frame == frame;
  lanes.distant = lamp.kind == LightKind::distant;
  for (int i = 0; i < 3; ++i) {
    lanes.position[i] = lamp.position[i];
    lanes.direction[i] = lamp.direction[i];
  }
  return lanes;
}

void SheetShader::begin_tile(const Effects& effects) {
  sheet_ = -1;
  effects_ = &effects;
  for (std::size_t light = 0; light < work_.packets.size(); ++light) {
    work_.packets[light].clear();
    work_.tile_lamps[light].table().count = SheetScratch::not_listed;
  }
}

// What may shade anything of the tile, where there are so many occluders that it helps to list them.
const LampTable& SheetShader::occluders_of_tile(std::size_t light) {
  const LampTable& all = sheets_.lamp(light).bounded.table();
  if (static_cast<std::size_t>(all.count) < tile_list_from) return all;
  LampTable& list = work_.tile_lamps[light].table();
  if (list.count == SheetScratch::not_listed) list_for_tile(light, list);
  return list;
}

void SheetShader::list_for_tile(std::size_t light, LampTable& list) const {
  const LaneLamp lamp = lane_lamp(light, tracer_.scene().lights[light].frame);
  LightSpan span;
  for (const auto& sheet : work_.sheets) {
    if (sheet.effects == effects_) sheets_.kernels().gather(lamp, sheet.rays, nullptr, span);
  }
  const Vec3 sum{span.sum[0], span.sum[1], span.sum[2]};
  const double size = glm::length(sum);
  Bundle bundle;
  if (size > 0.0) {
    for (int k = 0; k < 3; ++k) bundle.axis[k] = sum[k] / size;
  }
  for (const auto& sheet : work_.sheets) {
    if (sheet.effects == effects_) sheets_.kernels().gather(lamp, sheet.rays, bundle.axis, span);
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
  sheets_.kernels().overlapping_lamps(sheets_.lamp(light).bounded.table(), bundle, list);
}

bool SheetShader::in_packets(std::size_t light) const {
  const Light& lamp = tracer_.scene().lights[light];
  const LampView& view = sheets_.lamp(light);
  return lamp.kind == LightKind::point && lamp.shadows && view.in_lanes &&
         static_cast<std::size_t>(view.bounded.table().count) >= packets_from;
}

bool SheetShader::wants_packets() const {
  for (std::size_t light = 0; light < tracer_.scene().lights.size(); ++light) {
    if (in_packets(light)) return true;
  }
  return false;
}

// Of surfaces that take one ray at a time, the points are not found twice: they are left to the lists of
// their sheets.
void SheetShader::collect(const Occupant& occupant) {
  begin_points(occupant);
  if (hits_known_ || !sheets_.lit_in_lanes(occupant.frame) || resolve(occupant) < 0) return;
  const std::vector<Light>& lights = tracer_.scene().lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!in_packets(i)) continue;
    sheets_.kernels().arrive(lane_lamp(i, occupant.frame), work_.points);
    fill_strength(lights[i], i);
    work_.packets[i].add(work_.points, sheet_, occupant.occluder);
  }
}

void SheetShader::sift_packets() {
  sheet_ = -1;
  for (std::size_t i = 0; i < work_.packets.size(); ++i) {
    if (!in_packets(i)) continue;
    work_.packets[i].sift(sheets_.kernels(), sheets_.lamp(i).bounded.table(), work_.packet_lamps);
  }
}

void SheetShader::begin_points(const Occupant& occupant) {
  ++sheet_;
  occupant_ = &occupant;
  hits_known_ = occupant.lanes->kind == LaneSurface::Kind::other;
  work_.points.frame = occupant.frame;
}

FirstHit SheetShader::hit(int lane) {
  const PointSheet& p = work_.points;
  if (!hits_known_) {
    for (int i = 0; i < p.count; ++i) work_.hits[i] = {p.lambda[i], occupant_->surface, 0, false};
    hits_known_ = true;
  }
  return {work_.hits[lane], occupant_->frame, 0.0, Extended(p.lambda[lane])};
}

// Returns the index of their material, or -1 for several.
int SheetShader::resolve_one_by_one(const Occupant& occupant) {
  PointSheet& p = work_.points;
  const Scene& scene = tracer_.scene();
  const SurfaceSet& surfaces =
      *tracer_.hub().frames[static_cast<std::size_t>(occupant.frame)].scene->surfaces;
  alignas(64) double error_bound[sheet_size] = {};
  RayList rays;
  Hit of_ray[sheet_size];
  SurfacePoint points[sheet_size];
  for (int i = 0; i < p.count; ++i) {
    of_ray[i] = hit(i).hit;
    scratch_.rays.start(camera_ray_of(i));
    const RestRayEvents& ray = scratch_.rays.in(occupant.frame);
    rays.add(i, ray.origin, ray.direction, ray.clock());
  }
  const Object& object = object_of(scene, hit(0));
  const Material& own = scene.materials[static_cast<std::size_t>(object.material)];
  const bool textured = !object.member_materials.empty() || own.texture || own.checker;
  const auto count = static_cast<std::size_t>(p.count);
  surfaces.resolve_all(std::span(of_ray, count), rays.rays(), textured, points);
  int material = -1;
  bool same = true;
  for (int i = 0; i < p.padded; ++i) {
    const auto from = static_cast<std::size_t>(std::min(i, p.count - 1));
    const SurfacePoint& point = points[from];
    put(point.position, p.position, i);
    put(point.normal, p.normal, i);
    p.u[i] = point.u;
    p.v[i] = point.v;
    error_bound[i] = point.error_bound;
    const int its = material_of(scene, hit(static_cast<int>(from)), point);
    same = same && (i == 0 || its == material);
    material = its;
  }
  sheets_.kernels().face(sheets_.eye(eye_).frames[static_cast<std::size_t>(occupant.frame)], error_bound, p);
  return same ? material : -1;
}

int SheetShader::resolve(const Occupant& occupant) {
  const Scene& scene = tracer_.scene();
  const LaneSurface::Kind kind = occupant.lanes->kind;
  if (kind == LaneSurface::Kind::other) return resolve_one_by_one(occupant);
  const int index = object_of(scene, occupant.frame, occupant.surface).material;
  const Material& material = scene.materials[static_cast<std::size_t>(index)];
  const bool needs_uv = material.texture || material.checker;
  if (kind == LaneSurface::Kind::sphere && needs_uv) return resolve_one_by_one(occupant);
  const LaneFrame& frame = sheets_.eye(eye_).frames[static_cast<std::size_t>(occupant.frame)];
  if (sheets_.kernels().resolve(frame, *occupant.lanes, work_.points) == 0) return index;
  return resolve_one_by_one(occupant);
}

void SheetShader::fill_strength(const Light& light, std::size_t index) {
  PointSheet& p = work_.points;
  if (!light.flickers) {
    std::fill_n(p.strength, p.padded, light.strength);
    if (light.strength == 0.0 && light.kind != LightKind::ambient) std::fill_n(p.lit, p.padded, 0.0);
    return;
  }
  const double* time = light.kind == LightKind::ambient ? p.proper_time : p.emission_time;
  for (int i = 0; i < p.padded; ++i) {
    p.strength[i] = 0.0;
    if (!(p.lit[i] > 0.0)) continue;
    p.strength[i] = strength_at(light, time[i], tracer_.scene().c, scratch_.light_variables[index]);
    if (p.strength[i] == 0.0 && light.kind != LightKind::ambient) p.lit[i] = 0.0;
  }
}

void SheetShader::fill_diffuse(std::size_t light, int index, LaneReflection& reflection) {
  PointSheet& p = work_.points;
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  const RestColours& colours = tracer_.rest_colours();
  if (!material.texture && !material.checker) {
    const LinearRgb& rgb = colours.under(light, index, 0);
    reflection.same_diffuse = true;
    for (int k = 0; k < 3; ++k) reflection.diffuse[k] = rgb[k];
    return;
  }
  for (int i = 0; i < p.count; ++i) {
    const LinearRgb rgb = material.texture
                              ? colours.under(light, texture_reflectance(material, p.u[i], p.v[i]))
                              : colours.under(light, index, checker_slot(*material.checker, p.u[i], p.v[i]));
    put(rgb, p.diffuse, i);
  }
  for (int i = p.count; i < p.padded; ++i) put(LinearRgb{0.0}, p.diffuse, i);
}

void SheetShader::try_one_by_one(std::size_t light, const Occupant& occluder) {
  PointSheet& p = work_.points;
  const Hub& hub = tracer_.hub();
  const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(occluder.frame)].scene->surfaces;
  const double end = tracer_.scene().lights[light].kind == LightKind::distant ? infinity : 1.0;
  const bool far = sheets_.one_by_one(occluder.frame) ||
                   hub.lights[light].to_frame[static_cast<std::size_t>(occluder.frame)].is_robust();
  RayList together;
  for (int i = 0; i < p.count; ++i) {
    if (!(p.trial[i] > 0.0)) continue;
    bool dark = false;
    const RayClock clock{p.trial_time[i], p.trial_rate[i]};
    if (far) {
      scratch_.rays.start(camera_ray_of(i));
      const ShadowSegment segment{{vec(p.way, i), p.way_length[i]},
                                  vec(p.start, i),
                                  vec(p.way_in_surface, i),
                                  {p.proper_time[i], -p.surface_length[i]},
                                  end};
      dark = is_shadowed_in(occluder.frame, hub, scratch_.rays, hit(i), hub.lights[light], segment);
    } else if (occluder.surface < 0) {
      dark = surfaces.blocked_bounded(vec(p.trial_start, i), vec(p.trial_direction, i), 0.0, end, clock);
    } else {
      together.add(i, vec(p.trial_start, i), vec(p.trial_direction, i), clock);
    }
    if (dark) p.lit[i] = 0.0;
  }
  if (together.count() == 0) return;
  bool blocked[sheet_size];
  surfaces.blocked_by(occluder.surface, together.rays(), end, blocked);
  for (std::size_t i = 0; i < together.count(); ++i) {
    if (blocked[i]) p.lit[together.lane(i)] = 0.0;
  }
}

// By the law, of those of the candidates (one bit for each point) that are still lit.
void SheetShader::try_occluder(std::size_t light, const Occupant& occluder, std::uint64_t candidates) {
  if (candidates == 0) return;
  const auto at = static_cast<std::size_t>(occluder.frame);
  LaneOccluder lanes{&sheets_.eye(eye_).frames[at],
                     &sheets_.lamp(light).to_frame[at],
                     occluder.lanes,
                     static_cast<double>(occluder.frame),
                     candidates,
                     1.0};
  if (tracer_.scene().lights[light].kind == LightKind::distant) lanes.end = infinity;
  LaneSurface none;
  const bool robust = tracer_.hub().lights[light].to_frame[at].is_robust();
  if (robust) lanes.surface = &none;  // of kind `other`: one by one
  if (sheets_.kernels().occlude(lanes, work_.points) && lanes.surface->kind == LaneSurface::Kind::other) {
    try_one_by_one(light, occluder);
  }
}

// Which points their own surface may shade. A start that is off a plane, or outside a ball, by the bound of
// its error does not meet it again (surface/surface_set.h), since the lamp is on the side that is seen.
std::uint64_t SheetShader::shaded_by_itself() const {
  const LaneSurface& own = *occupant_->lanes;
  if (own.kind == LaneSurface::Kind::plane) return 0;
  if (own.kind == LaneSurface::Kind::sphere && own.aligned) {
    return sheets_.kernels().inward(own.centre, work_.points);
  }
  return ~std::uint64_t{0};
}

bool SheetShader::is_own(const Occupant& occluder) const {
  return occluder.frame == occupant_->frame && occluder.surface == occupant_->surface;
}

void SheetShader::shadow(std::size_t light) {
  const LampView& view = sheets_.lamp(light);
  for (const int i : view.unbounded) {
    const Occupant& occluder = sheets_.occluders()[static_cast<std::size_t>(i)];
    try_occluder(light, occluder, is_own(occluder) ? shaded_by_itself() : ~std::uint64_t{0});
  }
  if (view.bounded.table().count == 0) return;
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
  if (chunk.count <= few_occluders) {
    sift(light, chunk, bundle.time, 0, p.padded);
    return;
  }
  LampTable& near = work_.near_lamps.table();
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
  const std::vector<Occupant>& occluders = sheets_.occluders();
  for (const ShadowPackets::Unclear& left : packets.unclear(sheet_)) {
    try_occluder(light, occluders[static_cast<std::size_t>(left.who)], left.rays);
  }
  if (occupant_->occluder < 0 || occupant_->lanes->kind == LaneSurface::Kind::plane) return;
  try_occluder(light, occluders[static_cast<std::size_t>(occupant_->occluder)], shaded_by_itself());
}

// The shadows of the listed occluders on the points from `first` to `last`.
void SheetShader::sift(std::size_t light, const LampTable& near, double time, int first, int last) {
  for (int i = 0; i < near.count; ++i) {
    const Occupant& occluder = sheets_.occluders()[static_cast<std::size_t>(near.who[i])];
    const std::uint64_t unclear =
        is_own(occluder) ? shaded_by_itself()
                         : sheets_.kernels().sift(near, i, time, first, last, work_.points.light_rays());
    try_occluder(light, occluder, unclear);
  }
}

// Parallel light: in an occluder's frame all segments have one direction, and its shadow is a cylinder.
void SheetShader::shadow_of_distant(std::size_t light) {
  const PointSheet& p = work_.points;
  const LampTable& table = sheets_.lamp(light).bounded.table();
  const Light& lamp = tracer_.scene().lights[light];
  const Vec3 from = tracer_.hub().frames[static_cast<std::size_t>(lamp.frame)].camera_event.x;
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
    const Occupant& occluder = sheets_.occluders()[static_cast<std::size_t>(table.who[i])];
    try_occluder(light, occluder, is_own(occluder) ? shaded_by_itself() : ~std::uint64_t{0});
  }
}

// One lamp's light on the points, as far as shadows, and how they reflect it; false: none of them is lit.
bool SheetShader::light_reaches(std::size_t index, const Effects& effects, const Material& material,
                                LaneReflection& reflection) {
  PointSheet& p = work_.points;
  const Light& light = tracer_.scene().lights[index];
  std::uint64_t lit = sheets_.kernels().arrive(lane_lamp(index, occupant_->frame), p);
  if (light.flickers || light.strength == 0.0) {
    fill_strength(light, index);
    lit = lit_bits(p);
  }
  if (lit == 0) return false;
  if (light.shadows) {
    scratch_.counts.shadow += static_cast<std::uint64_t>(__builtin_popcountll(lit));
    shadow(index);
  }
  reflection.same_strength = !light.flickers;
  reflection.strength = light.strength;
  reflection.brightness = lane_brightness(effects.brightness);
  reflection.distant = light.kind == LightKind::distant;
  reflection.gamma = tracer_.hub().lights[index].to_frame[frame()].gamma();
  reflection.specular =
      material.specular <= 0.0 ? 0.0 : material.specular * (material.shininess + 2.0) / (2.0 * pi);
  reflection.shininess = material.shininess;
  return true;
}

// The same of a light that comes from everywhere, with its irradiance.
void SheetShader::ambient_arrives(std::size_t index) {
  PointSheet& p = work_.points;
  std::fill_n(p.lit, p.count, 1.0);
  std::fill(p.lit + p.count, p.lit + p.padded, 0.0);
  fill_strength(tracer_.scene().lights[index], index);
  for (int i = 0; i < p.padded; ++i) {
    p.irradiance[i] = pi * p.strength[i];
    p.specular[i] = 0.0;
    p.lamp_doppler[i] = 1.0;
  }
}

// One lamp's light on the points, up to its irradiance; false: none of them is lit.
bool SheetShader::light_arrives(std::size_t index, const Effects& effects, const Material& material,
                                LaneReflection& reflection) {
  if (tracer_.scene().lights[index].kind == LightKind::ambient) {
    ambient_arrives(index);
    return true;
  }
  if (!light_reaches(index, effects, material, reflection)) return false;
  sheets_.kernels().reflect(reflection, work_.points);
  return true;
}

void SheetShader::light_rgb(const Material& material, int material_index, const Effects& effects) {
  PointSheet& p = work_.points;
  const LinearRgb own = material.emission ? material.emission->rgb : LinearRgb{0.0};
  const double own_rgb[3] = {own.r, own.g, own.b};
  bool first = true;
  const std::vector<Light>& lights = tracer_.scene().lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const bool ambient = lights[i].kind == LightKind::ambient;
    LaneReflection reflection;
    for (int k = 0; k < 3; ++k) reflection.lamp[k] = lights[i].colour.rgb[k];
    if (ambient) {
      ambient_arrives(i);
    } else if (!light_reaches(i, effects, material, reflection)) {
      continue;
    }
    fill_diffuse(i, material_index, reflection);
    if (first) reflection.own = own_rgb;
    first = false;
    ambient ? sheets_.kernels().add_light(reflection, p) : sheets_.kernels().shine(reflection, p);
  }
  for (int k = 0; k < 3 && first; ++k) std::fill_n(p.rgb[k], p.padded, own[k]);
  const double gamma = tracer_.hub().frames[frame()].from_camera.gamma();
  sheets_.kernels().carry(lane_brightness(effects.towards_camera()), gamma, p);
}

bool SheetShader::shade(const Occupant& occupant, const Effects& effects) {
  const int index = resolve(occupant);
  if (index < 0) return false;
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  if (tracer_.is_spectral() && effects.doppler) {
    light_spectra(material, index, effects);
  } else {
    light_rgb(material, index, effects);
  }
  return true;
}

}  // namespace backlight
