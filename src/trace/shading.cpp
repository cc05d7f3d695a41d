#include "backlight/trace/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "backlight/colour/upsampling.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

// Which of a checker's two colours, by the parity of the square in texture coordinates.
int checker_slot(const Checker& checker, const SurfacePoint& surface) {
  const double square = std::floor(surface.u / checker.size) + std::floor(surface.v / checker.size);
  return std::fmod(square, 2.0) == 0.0 ? 0 : 1;
}

LinearRgb texture_reflectance(const Material& material, const SurfacePoint& surface) {
  const LinearRgb texel = material.texture->sample(surface.u, surface.v, TextureEdge::repeat);
  return glm::clamp(texel, 0.0, 1.0);
}

// Strength of a lamp at its own time, in scene seconds; a formula below zero means that the lamp is off.
double strength_at(const Light& light, double own_time, double c, std::vector<double>& variables) {
  if (!light.flickers) return light.strength;
  variables[0] = own_time / c;
  const double strength = light.strength_of_time.evaluate(variables);
  return strength < 0.0 ? 0.0 : strength;  // NaN stays, and is counted
}

// Phong's lobe, normalised so that `specular` is the share of the light that it reflects at normal incidence
// (Lafortune & Willems 1994): k (n+2)/2π cosⁿα.
double specular_brdf(const Material& material, const SeenPoint& point, const Arrival& a) {
  if (material.specular <= 0.0) return 0.0;
  const Vec3 mirrored = 2.0 * a.cosine * point.normal - a.to_light;
  const double alpha = glm::dot(mirrored, point.to_camera);
  if (alpha <= 0.0) return 0.0;
  return material.specular * (material.shininess + 2.0) / (2.0 * pi) * std::pow(alpha, material.shininess);
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
    const auto a = arrival(scratch.rays, point, view);
    if (!a) continue;
    const double strength = strength_at(light, a->emission_time, scene.c, scratch.light_variables[i]);
    if (strength == 0.0) continue;
    ++scratch.counts.shadow;
    if (is_shadowed(*context.hub, scratch.rays, point.hit, view, a->segment)) continue;
    const double factor = light.kind == LightKind::distant
                              ? flux_factor(a->doppler, a->gamma, effects.brightness)
                              : radiance_factor(a->doppler, a->gamma, effects.brightness);
    add(i, factor * strength * a->cosine * a->inverse_square, specular_brdf(material, point, *a), *a);
  }
}

void fill_reflectance(const Material& material, const SurfacePoint& surface, Scratch& s) {
  const int n = static_cast<int>(s.wavelengths.size());
  if (material.texture) {
    const SigmoidReflectance shape = upsample(texture_reflectance(material, surface));
    if (material.uv || material.ir) {
      const Spectrum levels = Spectrum::sigmoid_reflectance(shape, material.uv, material.ir);
      levels.evaluate(s.wavelengths.data(), n, s.reflectance.data());
    } else {
      for (std::size_t i = 0; i < s.wavelengths.size(); ++i) s.reflectance[i] = shape.at(s.wavelengths[i]);
    }
    return;
  }
  const Colour& colour =
      material.checker
          ? material.checker->colours[static_cast<std::size_t>(checker_slot(*material.checker, surface))]
          : material.reflectance;
  colour.spectrum.evaluate(s.wavelengths.data(), n, s.reflectance.data());
}

}  // namespace

Scratch::Scratch(const Hub& hub, const Scene& scene, std::size_t count)
    : rays(hub), wavelengths(count), at_light(count), reflectance(count), lamp(count), radiance(count) {
  for (const Light& light : scene.lights) light_variables.push_back(light.variables);
}

Radiance<Rest> shade(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                     Scratch& scratch) {
  const Scene& scene = *context.scene;
  const int index = material_of(scene, point.hit, point.surface);
  const Material& material = scene.materials[static_cast<std::size_t>(index)];
  LinearRgb texel{0.0};
  if (material.texture) texel = texture_reflectance(material, point.surface);
  const int slot = material.checker ? checker_slot(*material.checker, point.surface) : 0;

  Radiance<Rest> out{material.emits ? material.emission.rgb : LinearRgb{0.0}};
  for_each_lamp(context, point, effects, material, scratch,
                [&](std::size_t i, double irradiance, double specular, const Arrival&) {
                  const LinearRgb& lamp = scene.lights[i].colour.rgb;
                  const LinearRgb diffuse = material.texture ? context.rest_colours->under(i, texel)
                                                             : context.rest_colours->under(i, index, slot);
                  out.rgb += irradiance * (diffuse / pi + specular * lamp);
                });
  return out;
}

void shade_spectrum(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                    Scratch& s) {
  const int index = material_of(*context.scene, point.hit, point.surface);
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  const int n = static_cast<int>(s.wavelengths.size());
  std::fill(s.radiance.begin(), s.radiance.end(), 0.0);
  if (material.emits) material.emission.spectrum.evaluate(s.wavelengths.data(), n, s.radiance.data());
  fill_reflectance(material, point.surface, s);
  for_each_lamp(context, point, effects, material, s,
                [&](std::size_t light, double irradiance, double specular, const Arrival& a) {
                  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
                    s.at_light[i] = wavelength_at_origin(a.doppler, s.wavelengths[i]);
                  }
                  context.scene->lights[light].colour.spectrum.evaluate(s.at_light.data(), n, s.lamp.data());
                  const double density = irradiance * wavelength_density_factor(a.doppler);
                  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
                    s.radiance[i] += density * s.lamp[i] * (s.reflectance[i] / pi + specular);
                  }
                });
}

int lamps_reaching(const ShadingContext& context, const SeenPoint& point, const Effects& effects,
                   Scratch& scratch) {
  const int index = object_of(*context.scene, point.hit).material;
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  int count = material.emits ? 1 : 0;
  for_each_lamp(context, point, effects, material, scratch,
                [&count](std::size_t, double irradiance, double, const Arrival&) {
                  if (irradiance > 0.0) ++count;
                });
  return count;
}

}  // namespace backlight
