#include "backlight/trace/shading.h"

#include <numbers>

#include "backlight/base/lane_power.h"
#include "shading_steps.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// Phong's lobe, normalised so that `specular` is the share of the light that it reflects at normal incidence
// (Lafortune & Willems 1994): k (n+2)/2π cosⁿα.
double specular_brdf(const Material& material, const SeenPoint& point, const Arrival& a) {
  if (material.specular <= 0.0) return 0.0;
  const Vec3 mirrored = 2.0 * a.cosine * point.normal - a.to_light;
  const double alpha = glm::dot(mirrored, point.to_camera);
  if (alpha <= 0.0) return 0.0;
  return material.specular * (material.shininess + 2.0) / (2.0 * pi) * power(alpha, material.shininess);
}

// Calls `add(light index, irradiance, specular, arrival)` for each light that reaches the point: irradiance
// is that of a light of unit spectrum (docs/physics.md equations (12), (13)), specular the value of Phong's
// lobe.
template <class Add>
void for_each_lamp(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   const Material& material, Scratch& scratch, const Add& add) {
  const Scene& scene = *context.scene;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.kind == LightKind::ambient) {
      const double strength = strength_at(light, point.proper_time, scene.c, scratch.light_variables[i]);
      add(i, pi * strength, 0.0, Arrival{});
      continue;
    }
    const LightView& view = context.hub->lights[i];
    const auto a = arrival(*context.hub, scratch.rays, point, view);
    if (!a) continue;
    const double strength = strength_at(light, a->emission_time, scene.c, scratch.light_variables[i]);
    if (strength == 0.0) continue;
    if (light.shadows) {
      ++scratch.counts.shadow;
      if (is_shadowed(*context.hub, scratch.rays, point.hit, view, a->segment)) continue;
    }
    const double factor = light.kind == LightKind::distant
                              ? flux_factor(a->doppler, a->gamma, effects.brightness)
                              : radiance_factor(a->doppler, a->gamma, effects.brightness);
    add(i, factor * strength * a->cosine * a->inverse_square, specular_brdf(material, point, *a), *a);
  }
}

}  // namespace

Scratch::Scratch(const Hub& hub, const Scene& scene, std::size_t count, InstructionSet set)
    : rays(hub), kernels(&spectral_kernels(set)), wavelengths(count), reflectance(count), lamp(count) {
  for (const Light& light : scene.lights) light_variables.push_back(light.variables);
}

Radiance<Rest> shade(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                     Scratch& scratch) {
  const Scene& scene = *context.scene;
  const int index = material_of(scene, point.hit, point.surface);
  const Material& material = scene.materials[static_cast<std::size_t>(index)];
  LinearRgb texel{0.0};
  if (material.texture) texel = texture_reflectance(material, point.surface.u, point.surface.v);
  const int slot = material.checker ? checker_slot(*material.checker, point.surface.u, point.surface.v) : 0;

  Radiance<Rest> out{material.emission ? material.emission->rgb : LinearRgb{0.0}};
  for_each_lamp(context, point, effects, material, scratch,
                [&](std::size_t i, double irradiance, double specular, const Arrival&) {
                  const LinearRgb& lamp = scene.lights[i].colour.rgb;
                  const LinearRgb diffuse = material.texture ? context.rest_colours->under(i, texel)
                                                             : context.rest_colours->under(i, index, slot);
                  out.rgb += irradiance * (std::numbers::inv_pi * diffuse + specular * lamp);
                });
  return out;
}

LinearRgb shade_shifted(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                        Scratch& s) {
  const int index = material_of(*context.scene, point.hit, point.surface);
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  LinearRgb sum = emitted_colour(context, index, s);
  const Reflectance reflectance =
      fill_reflectance(seen_reflectance(context, index, point.surface.u, point.surface.v, s.texel), s);
  for_each_lamp(context, point, effects, material, s,
                [&](std::size_t light, double irradiance, double specular, const Arrival& a) {
                  const LampColours lamp = lamp_colours(context.spectra->light(light), a.doppler,
                                                        material.specular > 0.0, reflectance, s);
                  sum += reflected_colour(lamp, a.doppler, irradiance, specular);
                });
  return sum;
}

int lamps_reaching(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   Scratch& scratch) {
  const int index = material_of(*context.scene, point.hit, point.surface);
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  int count = material.emission ? 1 : 0;
  for_each_lamp(context, point, effects, material, scratch,
                [&count](std::size_t, double irradiance, double, const Arrival&) {
                  if (irradiance > 0.0) ++count;
                });
  return count;
}

}  // namespace backlight
