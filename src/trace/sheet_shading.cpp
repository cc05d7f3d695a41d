// The light of one sheet of points, step by step.
#include "sheet_shading.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "shading_steps.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// How often packets of shadow rays are divided.
constexpr std::size_t packet_levels = 7;

void put(const Vec3& a, double (&to)[3][sheet_size], int lane) {
  for (int k = 0; k < 3; ++k) to[k][lane] = a[k];
}

}  // namespace

LaneBrightness lane_brightness(const BrightnessSwitches& on) {
  const int rate = on.arrival_rate == ArrivalRate::exact      ? 0
                   : on.arrival_rate == ArrivalRate::dilation ? 1
                                                              : 2;
  return {on.photon_energy, rate, on.solid_angle};
}

SheetScratch::SheetScratch(const SheetScene& scene, std::size_t lights, InstructionSet set)
    : tile_lamps(lights), packets(lights), group_of(scene.group_count(), -1) {
  sheet_memory.resize(65);  // of a whole tile: its pages are touched here, not between its rays
  rays.instructions = points.rays.instructions = points.shadow.instructions = set;
  tile_cones.resize(scene.entries().size());
  sheet_cones.resize(scene.entries().size());
  for (LampStore& lamps : tile_lamps) lamps.resize(scene.entries().size());
  packet_lamps.resize(packet_levels);
  for (LampStore& lamps : packet_lamps) lamps.resize(scene.entries().size());
  chunk_lamps.resize(scene.entries().size());
  near_lamps.resize(scene.entries().size());
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
    std::fill_n(p.own + first, count, surfaces.is_convex(surface) ? number : -1.0);
    std::fill_n(p.own_inside + first, count, surfaces.is_flat(surface) ? number : -1.0);
    std::fill_n(p.material + first, count, object.material);
    for (int i = first; i < end && !members.empty(); ++i) {
      p.material[i] = members[static_cast<std::size_t>(p.points.member[i])];
    }
  }
  sheets_.kernels().face(p);
  return std::all_of(p.material, p.material + p.count, [&](int its) { return its == p.material[0]; });
}

void SheetShader::fill_strength(const Light& light) {
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
    p.strength[i] = strength_at(light, time[i], tracer_.scene().c);
    if (p.strength[i] == 0.0 && light.kind != LightKind::ambient) p.lit[i] = 0.0;
  }
}

void SheetShader::fill_diffuse(std::size_t light, int index, LaneReflection& reflection) {
  PointSheet& p = work_.points;
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  const RestColours& colours = tracer_.rest_colours();
  const bool by_point = reflects_by_point(material);
  if (!by_point && !material.checker) {
    const LinearRgb& rgb = colours.under(light, index, 0);
    reflection.same_diffuse = true;
    for (int k = 0; k < 3; ++k) reflection.diffuse[k] = rgb[k];
    return;
  }
  for (int i = 0; i < p.count; ++i) {
    const LinearRgb rgb =
        by_point
            ? colours.under(light, point_reflectance(material, p.points.u[i], p.points.v[i], own_time(i)))
            : colours.under(light, index, checker_slot(*material.checker, p.points.u[i], p.points.v[i]));
    put(rgb, p.diffuse, i);
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
  if (light.flickers || light.strength == 0.0) {
    fill_strength(light);
    lit = p.lit_bits();
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
  sheets_.kernels().reflect(reflection, p);
  if (material.in_time && material.in_time->lobe) fill_lobes(material);
  return true;
}

// Of a lobe that is another at each point's own time.
void SheetShader::fill_lobes(const Material& material) {
  PointSheet& p = work_.points;
  const auto at = [](const auto& rows, int i) { return Vec3{rows[0][i], rows[1][i], rows[2][i]}; };
  for (int i = 0; i < p.count; ++i) {
    if (!(p.lit[i] > 0.0)) continue;
    p.specular[i] = specular_brdf(lobe_at(material, own_time(i)), at(p.points.normal, i), at(p.to_camera, i),
                                  at(p.to_light, i), p.cosine[i]);
  }
}

void SheetShader::light_rgb(const Material& material, int material_index, const Effects& effects) {
  PointSheet& p = work_.points;
  const LinearRgb own = material.emission ? material.emission->rgb : LinearRgb{0.0};
  const double own_rgb[3] = {own.r, own.g, own.b};
  const bool own_by_point = material.in_time && material.in_time->emission;
  for (int i = 0; i < p.padded && own_by_point; ++i) {
    put(i < p.count ? own_radiance(material, own_time(i)) : LinearRgb{0.0}, p.rgb, i);
  }
  bool first = !own_by_point;
  const std::vector<Light>& lights = tracer_.scene().lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    LaneReflection reflection;
    for (int k = 0; k < 3; ++k) reflection.lamp[k] = lights[i].colour.rgb[k];
    if (!light_arrives(i, effects, material, reflection)) continue;
    fill_diffuse(i, material_index, reflection);
    if (first) reflection.own = own_rgb;
    first = false;
    sheets_.kernels().add_light(reflection, p);
  }
  for (int k = 0; k < 3 && first; ++k) std::fill_n(p.rgb[k], p.padded, own[k]);
  const double gamma = tracer_.hub().frames[frame()].from_camera.gamma();
  sheets_.kernels().carry(lane_brightness(effects.towards_camera()), gamma, p);
}

void SheetShader::shade(const Effects& effects) {
  const int index = work_.points.material[0];
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  if (tracer_.is_spectral() && effects.doppler) {
    light_spectra(material, index, effects);
  } else {
    light_rgb(material, index, effects);
  }
}

}  // namespace backlight
