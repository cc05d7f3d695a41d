// The light of one sheet of points, step by step.
#include "sheet_shading.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "backlight/trace/sky.h"
#include "shading_steps.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// How often packets of shadow rays are divided.
constexpr std::size_t packet_levels = 7;

void put(const Vec3& a, double (&to)[3][sheet_size], int lane) {
  for (int k = 0; k < 3; ++k) to[k][lane] = a[k];
}

// The celerity of From as seen from To, in To's axes, but for its sign.
template <class To, class From>
void put_way(const LorentzTransform<To, From>& transform, double (&way)[3]) {
  const Vec3 w = transform.is_rotated() ? transform.rotation() * transform.celerity() : transform.celerity();
  for (int k = 0; k < 3; ++k) way[k] = w[k];
}

LaneCarriage carriage(const FrameView& frame, const BrightnessSwitches& on, bool shifted) {
  LaneCarriage result{lane_brightness(on), frame.from_camera.gamma(), {}, shifted};
  put_way(frame.from_camera, result.way);
  return result;
}

// way_to_lamp() of several events.
void meet_lamp(const Light& light, int count, const double (*place)[8], const double* time,
               LampMeeting& meeting) {
  for (int i = 0; i < count; ++i) {
    const LampMoment moment = way_to_moving(light, {place[0][i], place[1][i], place[2][i]}, time[i]);
    for (int k = 0; k < 3; ++k) meeting.way[k][i] = moment.direction.x[k];
    meeting.length[i] = moment.direction.length;
    meeting.own_length[i] = moment.own_length();
    meeting.time[i] = moment.strength_time(light);
    meeting.share[i] = light.cone ? light.cone->share(moment.leaving(), meeting.time[i]) : 1.0;
  }
}

}  // namespace

LaneBrightness lane_brightness(const BrightnessSwitches& on) {
  const int rate = on.arrival_rate == ArrivalRate::exact      ? 0
                   : on.arrival_rate == ArrivalRate::dilation ? 1
                                                              : 2;
  return {on.photon_energy, rate, on.solid_angle};
}

SheetScratch::SheetScratch(const SheetScene& scene, std::size_t lights, InstructionSet set)
    : tile_lamps(lights), packets(lights), lane_lamps(lights), group_of(scene.group_count(), -1) {
  sheet_memory.resize(65);  // of a whole tile: its pages are touched here, not between its rays
  rays.instructions = points.rays.instructions = points.shadow.instructions = set;
  tile_cones.resize(scene.entries().size());
  sheet_cones.resize(scene.entries().size());
  for (LampStore& lamps : tile_lamps) lamps.resize(scene.entries().size());
  packet_lamps.resize(packet_levels);
  for (LampStore& lamps : packet_lamps) lamps.resize(scene.entries().size());
  chunk_lamps.resize(scene.entries().size());
  near_lamps.resize(scene.entries().size());
  passings.resize(scene.entries().size());
}

// Without light delay there are none to the camera; but from a mirror on there is light.
const BrightnessSwitches& SheetShader::towards_camera(const Effects& effects) const {
  return work_.legs.empty() ? effects.towards_camera() : effects.brightness;
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

const LaneLamp& SheetShader::lane_lamp(std::size_t light, int frame) const {
  const Light& lamp = tracer_.scene().lights[light];
  LaneLamp& lanes = work_.lane_lamps[light];
  if (lanes.surface_frame == frame) return lanes;
  lanes.surface_frame = frame;
  lanes.frame = sheets_.eye(eye_).frames[static_cast<std::size_t>(lamp.frame)];
  lanes.to_surface = sheets_.lamp(light).to_frame[static_cast<std::size_t>(frame)];
  lanes.time_offset =
      lanes.frame.time - sheets_.hub().frames[static_cast<std::size_t>(lamp.frame)].camera_event.t;
  lanes.own_frame = lamp.frame == frame;
  lanes.distant = lamp.kind == LightKind::distant;
  lanes.meet = lamp.motion ? meet_lamp : nullptr;
  lanes.light = &lamp;
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
    work_.lane_lamps[light].surface_frame = -1;
    work_.packets[light].clear();
    work_.tile_lamps[light].table().count = SheetScratch::not_listed;
  }
}

void SheetShader::begin_points() {
  ++sheet_;
  entry_ = &sheets_.entry(sheets_.numbered(work_.points.runs[0].surface).entry);
}

FirstHit SheetShader::hit(int lane) const {
  const PointSheet& p = work_.points;
  const PointSheet::Run* run = p.runs;
  while (run->last <= lane) ++run;
  const double lambda = p.hits->lambda[lane];
  return {{lambda, run->surface - entry_->first_number, p.hits->part_of(lane), p.hits->is_unresolved(lane),
           p.hits->along[lane]},
          entry_->frame,
          0.0,
          Extended(lambda)};
}

bool SheetShader::resolve() {
  PointSheet& p = work_.points;
  const Scene& scene = tracer_.scene();
  const SurfaceSet& surfaces = sheets_.surfaces(*entry_);
  p.smooth = false;
  bool is_one = true;  // material, or else members of solids may have several
  sheets_.kernels().in_frame(sheets_.eye(eye_).frames[frame()], p);
  for (int r = 0; r < p.run_count; ++r) {
    const auto [number, first, end] = p.runs[r];
    const int last = end < p.count ? end : p.padded;  // spare lanes are as the last one
    const int surface = number - entry_->first_number, count = last - first;
    const Object& object = object_of(scene, entry_->frame, surface);
    const Material& own = scene.materials[static_cast<std::size_t>(object.material)];
    const std::vector<int>& members = object.member_materials;
    const bool textured = !members.empty() || own.texture || own.checker;
    surfaces.points(p.rays, surface, first, last, *p.hits, textured, p.points);
    p.smooth = p.smooth || surfaces.is_smooth(surface);
    std::fill_n(p.own + first, count, surfaces.is_convex(surface) ? number : -1.0);
    std::fill_n(p.own_inside + first, count, surfaces.is_flat(surface) ? number : -1.0);
    std::fill_n(p.material + first, count, object.material);
    is_one = is_one && members.empty();
    for (int i = first; i < end && !members.empty(); ++i) {
      p.material[i] = members[static_cast<std::size_t>(p.points.member[i])];
    }
  }
  if (p.smooth) fill_shading_normals(surfaces);
  p.moves = sheets_.moves(sheets_.numbered(p.runs[0].surface).group);
  too_fast_ = p.moves && !find_celerities();
  sheets_.kernels().face(p);
  return is_one ||
         std::all_of(p.material, p.material + p.count, [&](int its) { return its == p.material[0]; });
}

// Of surfaces that have no other than their own.
void SheetShader::fill_shading_normals(const SurfaceSet& surfaces) {
  PointSheet& p = work_.points;
  for (int r = 0; r < p.run_count; ++r) {
    if (surfaces.is_smooth(p.runs[r].surface - entry_->first_number)) continue;
    const int last = p.runs[r].last < p.count ? p.runs[r].last : p.padded;
    for (int k = 0; k < 3; ++k)
      std::copy(p.points.normal[k] + p.runs[r].first, p.points.normal[k] + last,
                p.points.shading_normal[k] + p.runs[r].first);
  }
}

// As boost_by() has them; false if lanes cannot go along with any.
bool SheetShader::find_celerities() {
  PointSheet& p = work_.points;
  bool slow = true;
  for (int i = 0; i < p.padded; ++i) {
    const Vec3 velocity{p.points.velocity[0][i], p.points.velocity[1][i], p.points.velocity[2][i]};
    const double speed = glm::length(velocity);
    p.gamma[i] = 1.0 / std::sqrt((1.0 - speed) * (1.0 + speed));
    put(p.gamma[i] * velocity, p.celerity, i);
    p.own[i] = p.own_inside[i] = -1.0;
    slow = slow && !(p.gamma[i] > robust_gamma);
  }
  return slow;
}

void SheetShader::fill_strength(const Light& light) {
  PointSheet& p = work_.points;
  if (!light.flickers && !light.cone) {
    std::fill_n(p.strength, p.padded, light.strength);
    if (light.strength == 0.0 && light.kind != LightKind::ambient) std::fill_n(p.lit, p.padded, 0.0);
    return;
  }
  const double* time = light.kind == LightKind::ambient ? p.proper_time : p.emission_time;
  for (int i = 0; i < p.padded; ++i) {
    p.strength[i] = 0.0;
    if (!(p.lit[i] > 0.0)) continue;
    p.strength[i] = strength_at(light, time[i], tracer_.scene().c);
    if (light.cone) {
      const Vec3 leaving = -Vec3{p.way[0][i], p.way[1][i], p.way[2][i]};
      p.strength[i] *= light.motion ? p.spot_share[i] : light.cone->share(leaving, time[i]);
    }
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
    const int slot = static_cast<int>(p.odd_squares >> i & 1U);
    put(material.texture ? colours.under(light, texture_reflectance(material, p.points.u[i], p.points.v[i]))
                         : colours.under(light, index, slot),
        p.diffuse, i);
  }
  for (int i = p.count; i < p.padded; ++i) put(LinearRgb{0.0}, p.diffuse, i);
}

// The irradiance of a light that comes from everywhere.
void SheetShader::ambient_arrives(std::size_t index) {
  PointSheet& p = work_.points;
  std::fill_n(p.lit, p.count, 1.0);
  std::fill(p.lit + p.count, p.lit + p.padded, 0.0);
  fill_strength(tracer_.scene().lights[index]);
  for (int i = 0; i < p.padded; ++i) {
    p.irradiance[i] = pi * p.strength[i];
    p.specular[i] = 0.0;
    p.lamp_doppler[i] = 1.0;
  }
}

// One lamp's light on the points, up to its irradiance, and how they reflect it; false: none of them is lit.
bool SheetShader::light_arrives(std::size_t index, const Effects& effects, const Material& material,
                                LaneReflection& reflection) {
  PointSheet& p = work_.points;
  const Light& light = tracer_.scene().lights[index];
  if (light.kind == LightKind::ambient) {
    ambient_arrives(index);
    return true;
  }
  std::uint64_t lit = sheets_.kernels().arrive(lane_lamp(index, entry_->frame), p);
  if (light.flickers || light.strength == 0.0 || light.cone) {
    fill_strength(light);
    lit = lit_points();
  }
  if (lit == 0) return false;
  if (light.shadows) {
    scratch_.counts.shadow += static_cast<std::uint64_t>(__builtin_popcountll(lit));
    shadow(index);
  }
  reflection.same_strength = !light.flickers && !light.cone;
  reflection.strength = light.strength;
  reflection.brightness = lane_brightness(effects.brightness);
  reflection.distant = light.kind == LightKind::distant;
  reflection.gamma = sheets_.hub().lights[index].to_frame[frame()].gamma();
  put_way(sheets_.hub().lights[index].to_frame[frame()], reflection.way);
  reflection.specular =
      material.specular <= 0.0 ? 0.0 : material.specular * (material.shininess + 2.0) / (2.0 * pi);
  reflection.shininess = material.shininess;
  sheets_.kernels().reflect(reflection, p);
  return true;
}

void SheetShader::shade_sky(const SheetRays& rays, std::uint64_t lanes, const Effects& effects) {
  PointSheet& p = work_.points;
  const Sky& sky = tracer_.scene().sky;
  const auto frame = static_cast<std::size_t>(sky.frame);
  const bool shifted = tracer_.is_spectral() && effects.doppler;
  for (int k = 0; k < 3; ++k) p.direction[k] = rays.direction[k];
  p.starts = rays.own_starts();
  p.padded = rays.padded;
  p.light_delay = rays.light_delay;
  sheets_.kernels().in_frame(sheets_.eye(eye_).frames[frame], p);
  sheets_.kernels().face_sky(p);
  LinearRgb colour = sky.radiance.rgb;
  double seen_at = 0.0;  // D of a colour that is that of all the sky
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctzll(lanes);
    if (sky.texture) colour = sky_texel(sky, p.points.u[lane], p.points.v[lane]);
    if (shifted && (sky.texture || p.doppler[lane] != seen_at)) {
      seen_at = p.doppler[lane];
      shift_by({seen_at}, scratch_);
      colour = sky_shifted(tracer_.shading(), {colour}, scratch_);
    }
    put(colour, p.rgb, lane);
  }
  p.moves = false;
  sheets_.kernels().carry(carriage(sheets_.hub().frames[frame], towards_camera(effects), shifted), p);
}

void SheetShader::shade(const Effects& effects) {
  PointSheet& p = work_.points;
  const int index = p.material[0];
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  const std::vector<Light>& lights = tracer_.scene().lights;
  const bool shifted = tracer_.is_spectral() && effects.doppler;
  bool first = !shifted || !material.emission;
  const LinearRgb own = first && material.emission ? material.emission->rgb : LinearRgb{0.0};
  const double own_rgb[3] = {own.r, own.g, own.b};
  if (!first) fill_emission(index);
  p.odd_squares = material.checker ? sheets_.kernels().odd_squares(material.checker->size, p) : 0;
  work_.known_texels = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    LaneReflection reflection;
    if (!light_arrives(i, effects, material, reflection)) continue;
    if (shifted) {
      fill_shifted(i, index, reflection);
    } else {
      for (int k = 0; k < 3; ++k) reflection.lamp[k] = lights[i].colour.rgb[k];
      fill_diffuse(i, index, reflection);
    }
    if (first) reflection.own = own_rgb;
    first = false;
    sheets_.kernels().add_light(reflection, p);
  }
  for (int k = 0; k < 3 && first; ++k) std::fill_n(p.rgb[k], p.padded, own[k]);
  sheets_.kernels().carry(carriage(sheets_.hub().frames[frame()], towards_camera(effects), shifted), p);
}

}  // namespace backlight
