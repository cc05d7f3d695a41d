#include "backlight/trace/shading.h"

#include <numbers>

#include "glass.h"
#include "shading_steps.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// Calls `add(light index, irradiance, specular, arrival, share)` for each light that reaches the point:
// irradiance is that of a light of unit spectrum (docs/physics.md equations (12), (13)), specular the value
// of Phong's lobe, share what glass leaves of it, besides filters.
template <class Add>
void for_each_lamp(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   const Material& material, bool shifted, Scratch& scratch, const Add& add) {
  const Scene& scene = *context.scene;
  const Lobe lobe = lobe_at(material, point.proper_time / scene.c);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.kind == LightKind::ambient) {
      const double strength = strength_at(light, point.proper_time, scene.c);
      Arrival everywhere;
      everywhere.emission_time = point.proper_time;
      add(i, pi * strength, 0.0, everywhere, LinearRgb{1.0});
      continue;
    }
    const LightView& view = context.hub->lights[i];
    const auto a = arrival(*context.hub, scratch.rays, point, view);
    if (!a) continue;
    const double strength = strength_at(light, a->emission_time, scene.c) * a->share;
    if (strength == 0.0) continue;
    if (light.shadows) {
      ++scratch.counts.shadow;
      if (is_shadowed(*context.hub, scratch.rays, point.hit, view, a->segment)) continue;
    }
    LinearRgb share{1.0};
    const std::size_t filters = scratch.filters.size();
    if (light.shadows && context.glass != nullptr && !context.glass->empty()) {
      share = transmitted(*context.glass, *context.hub, scratch, point, view, *a, shifted);
      if (share == LinearRgb{0.0}) continue;
    }
    const double factor = light.kind == LightKind::distant
                              ? flux_factor(a->doppler, a->gamma, effects.brightness)
                              : radiance_factor(a->doppler, a->gamma, effects.brightness);
    add(i, factor * strength * a->cosine * a->inverse_square,
        specular_brdf(lobe, point.normal, point.to_camera, a->to_light, a->cosine), *a, share);
    scratch.filters.resize(filters);
  }
}

}  // namespace

Scratch::Scratch(const Hub& hub, std::size_t count, InstructionSet set)
    : rays(hub), kernels(&spectral_kernels(set)), wavelengths(count), reflectance(count), lamp(count) {}

Radiance<Rest> shade(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                     Scratch& scratch) {
  const Scene& scene = *context.scene;
  const int index = material_of(scene, point.hit, point.surface);
  const Material& material = scene.materials[static_cast<std::size_t>(index)];
  const double t = point.proper_time / scene.c;
  const bool by_point = reflects_by_point(material);
  LinearRgb texel{0.0};
  if (by_point) texel = point_reflectance(material, point.surface.u, point.surface.v, t);
  const int slot = material.checker ? checker_slot(*material.checker, point.surface.u, point.surface.v) : 0;

  Radiance<Rest> out{own_radiance(material, t)};
  for_each_lamp(
      context, point, effects, material, false, scratch,
      [&](std::size_t i, double irradiance, double specular, const Arrival&, const LinearRgb& share) {
        const LinearRgb& lamp = scene.lights[i].colour.rgb;
        const LinearRgb diffuse =
            by_point ? context.rest_colours->under(i, texel) : context.rest_colours->under(i, index, slot);
        out.rgb += share * (irradiance * (std::numbers::inv_pi * diffuse + specular * lamp));
      });
  return out;
}

LinearRgb shade_shifted(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                        Scratch& s) {
  const int index = material_of(*context.scene, point.hit, point.surface);
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  const double t = point.proper_time / context.scene->c;
  LinearRgb sum = emitted_colour(context, index, t, s);
  const Reflectance reflectance =
      fill_reflectance(seen_reflectance(context, index, point.surface.u, point.surface.v, t, s.texel), s);
  for_each_lamp(
      context, point, effects, material, true, s,
      [&](std::size_t light, double irradiance, double specular, const Arrival& a, const LinearRgb& share) {
        const LampColours lamp =
            lamp_colours(context.spectra->light(light), a.doppler, has_lobe(material), reflectance, s);
        sum += share * reflected_colour(lamp, a.doppler, irradiance, specular);
      });
  return sum;
}

void lamp_times(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                Scratch& scratch, std::vector<double>& times) {
  const Scene& scene = *context.scene;
  const int index = material_of(scene, point.hit, point.surface);
  const Material& material = scene.materials[static_cast<std::size_t>(index)];
  for_each_lamp(context, point, effects, material, false, scratch,
                [&](std::size_t light, double irradiance, double, const Arrival& a, const LinearRgb&) {
                  if (irradiance > 0.0) times[light] = a.emission_time / scene.c;
                });
}

int lamps_reaching(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   Scratch& scratch) {
  const int index = material_of(*context.scene, point.hit, point.surface);
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  int count = own_radiance(material, point.proper_time / context.scene->c) != LinearRgb{0.0} ? 1 : 0;
  for_each_lamp(context, point, effects, material, false, scratch,
                [&count](std::size_t, double irradiance, double, const Arrival&, const LinearRgb&) {
                  if (irradiance > 0.0) ++count;
                });
  return count;
}

}  // namespace backlight
