#include "shading_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "backlight/base/lane_power.h"
#include "backlight/colour/film_integral.h"
#include "backlight/colour/upsampling.h"
#include "backlight/film/lane_texture.h"

namespace backlight {

int checker_slot(const Checker& checker, double u, double v) {
  return is_odd_square(Lanes<1>(checker.size), Lanes<1>(u), Lanes<1>(v)).v ? 1 : 0;
}

LinearRgb texture_reflectance(const Material& material, double u, double v) {
  return glm::clamp(material.texture->sample(u, v, TextureEdge::repeat), 0.0, 1.0);
}

LinearRgb point_reflectance(const Material& material, double u, double v, double t) {
  if (material.texture) return texture_reflectance(material, u, v);
  const int slot = material.checker ? checker_slot(*material.checker, u, v) : 0;
  return reflectance_at(*material.in_time->reflectance, slot, t);
}

double specular_brdf(const Lobe& lobe, const Vec3& normal, const Vec3& to_camera, const Vec3& to_light,
                     double cosine) {
  if (lobe.specular <= 0.0) return 0.0;
  const Vec3 mirrored = 2.0 * cosine * normal - to_light;
  const double alpha = glm::dot(mirrored, to_camera);
  if (alpha <= 0.0) return 0.0;
  return lobe.specular * (lobe.shininess + 2.0) / (2.0 * std::numbers::pi) * power(alpha, lobe.shininess);
}

double strength_at(const Light& light, double own_time, double c) {
  if (!light.flickers) return light.strength;
  const double strength = light.strength_of_time.evaluate(std::array{own_time / c}) / light.strength;
  return strength < 0.0 ? 0.0 : strength;  // NaN stays, and is counted
}

const double* shifted_wavelengths(const WavelengthSet& set, Scratch& s) {
  if (s.shifted != set.size()) {
    const DopplerFactor<Camera, Rest> doppler{s.shift};
    for (std::size_t i = 0; i < set.nm().size(); ++i) {
      s.wavelengths[i] = wavelength_at_origin(doppler, set.nm()[i]);
    }
    s.shifted = set.size();
  }
  return s.wavelengths.data();
}

namespace {

// A coloured light, `luminance` that of its D65 at `shift`.
LinearRgb whole_colour(const SeenSpectrum& light, double shift, double luminance, Scratch& s) {
  const ReflectedLight::Pair pair{light.number, light.spectrum, nullptr, light.set};
  return luminance * s.reflected.per_luminance(pair, 1.0, shift, false, *s.kernels);
}

}  // namespace

LinearRgb shifted_colour(const SeenSpectrum& emission, Scratch& s) {
  const Spectrum& spectrum = *emission.spectrum;
  if (!s.filters.empty()) return integrate_film(spectrum, s.shift, s.filters);
  if (spectrum.has_features()) return integrate_film(spectrum, s.shift);
  if (emission.number != 0 && spectrum.shape()) {
    const auto place = emission.set->lights().at(spectrum, s.shift);
    if (place && ReflectedLight::has(*place)) {
      return whole_colour(emission, s.shift, luminance(place->film()), s);
    }
  }
  return emission.set->film_under(spectrum, s.shift, nullptr, s.lamp.data(), *s.kernels);
}

namespace {

// Under what the light goes through, and a reflectance (or null) besides.
LinearRgb through_filters(const Spectrum& light, double shift, const Spectrum* reflectance, Scratch& s) {
  if (reflectance == nullptr) return integrate_film(light, shift, s.filters);
  s.filters.push_back({reflectance, s.shift});
  const LinearRgb colour = integrate_film(light, shift, s.filters);
  s.filters.pop_back();
  return colour;
}

}  // namespace

LinearRgb shifted_rgb(const ShadingContext& context, const LinearRgb& rgb, Scratch& s) {
  // D65 times a reflectance of half the largest component, as for any coloured light.
  const double scale = 2.0 * std::max({rgb.r, rgb.g, rgb.b});
  if (!(scale > 0.0)) return LinearRgb{0.0};
  if (s.shift == 1.0 && s.filters.empty()) return rgb;  // which the spectrum would be matched to
  const auto [shape, set] = context.wavelengths->upsampled(rgb / scale, 0.0);
  s.texel = Spectrum::sigmoid_reflectance(shape);
  if (!s.filters.empty()) return scale * through_filters(Spectrum::d65(), s.shift, &s.texel, s);
  s.texel.evaluate(shifted_wavelengths(*set, s), set->size(), s.reflectance.data(), *s.kernels);
  const WavelengthSet::Sampled sampled{s.reflectance.data(), &s.texel, s.shift};
  return scale * set->film_under(Spectrum::d65(), s.shift, &sampled, s.lamp.data(), *s.kernels);
}

LinearRgb emitted_colour(const ShadingContext& context, int index, double t, Scratch& s) {
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  if (!material.in_time || !material.in_time->emission)
    return material.emission ? shifted_colour(context.spectra->emission(index), s) : LinearRgb{0.0};
  const EmissionNow now = emission_at(*material.in_time->emission, t);
  if (now.body) return shifted_colour({&*now.body, context.wavelengths}, s);
  if (!now.colour) return now.strength * shifted_colour(context.spectra->emission(index), s);
  const double sum = now.colour->r + now.colour->g + now.colour->b;
  return std::isfinite(sum) ? shifted_rgb(context, *now.colour, s) : LinearRgb{sum};
}

SeenSpectrum seen_reflectance(const ShadingContext& context, int index, double u, double v, double t,
                              Spectrum& texel) {
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  if (!reflects_by_point(material)) {
    const int slot = material.checker ? checker_slot(*material.checker, u, v) : 0;
    return context.spectra->reflectance(index, slot);
  }
  const LinearRgb rgb = point_reflectance(material, u, v, t);
  std::optional<double> uv = material.uv, ir = material.ir;
  if (material.in_time && material.in_time->reflectance) {
    uv = level_at(material.in_time->reflectance->uv, t);
    ir = level_at(material.in_time->reflectance->ir, t);
  }
  const double sum = rgb.r + rgb.g + rgb.b + uv.value_or(0.0) + ir.value_or(0.0);
  if (std::isnan(sum)) {
    texel = Spectrum::constant(sum);
    return {&texel, context.wavelengths};
  }
  const auto [shape, set] = context.wavelengths->upsampled(rgb, context.spectra->steepest_light());
  texel = Spectrum::sigmoid_reflectance(shape, uv, ir);
  return {&texel, set};
}

namespace {

void sample(const SeenSpectrum& reflectance, Scratch& s) {
  const WavelengthSet& set = *reflectance.set;
  reflectance.spectrum->evaluate(shifted_wavelengths(set, s), set.size(), s.reflectance.data(), *s.kernels);
}

}  // namespace

Reflectance fill_reflectance(const SeenSpectrum& seen, Scratch& s) {
  Reflectance reflectance{seen, {}};
  const Spectrum& spectrum = *reflectance.seen.spectrum;
  if (spectrum.is_grey()) {
    reflectance.grey = spectrum.at(visible_begin_nm);
  } else if (!reflectance.is_looked_up()) {
    sample(reflectance.seen, s);
  }
  return reflectance;
}

LampColours lamp_colours(const SeenSpectrum& lamp, DopplerFactor<Rest, Source> doppler, bool has_lobe,
                         const Reflectance& reflectance, Scratch& s) {
  const Spectrum& light = *lamp.spectrum;
  const SeenSpectrum& seen = reflectance.seen;
  const double shift = wavelength_at_origin(doppler, s.shift);
  LampColours colours;
  if (!s.filters.empty()) {
    if (reflectance.grey || has_lobe) colours.whole = through_filters(light, shift, nullptr, s);
    colours.reflected = reflectance.grey ? *reflectance.grey * colours.whole
                                         : through_filters(light, shift, seen.spectrum, s);
    return colours;
  }
  if (light.has_features()) {
    if (reflectance.grey || has_lobe) colours.whole = integrate_film(light, shift);
    colours.reflected = reflectance.grey ? *reflectance.grey * colours.whole
                                         : integrate_film(light, shift, seen.spectrum, s.shift);
    return colours;
  }
  const auto place = lamp.set->lights().at(light, shift);
  const bool known = place && ReflectedLight::has(*place);
  const LinearRgb film = known ? place->film() : LinearRgb{0.0};
  const double y = luminance(film);
  if (reflectance.grey || has_lobe) {
    colours.whole = !known          ? lamp.set->film_under(light, shift, nullptr, s.lamp.data(), *s.kernels)
                    : light.shape() ? whole_colour(lamp, shift, y, s)
                                    : film;
  }
  if (reflectance.grey) {
    colours.reflected = *reflectance.grey * colours.whole;
  } else if (seen.spectrum->has_features()) {
    colours.reflected = integrate_film(light, shift, seen.spectrum, s.shift);
  } else if (known && reflectance.is_looked_up()) {
    const ReflectedLight::Pair pair{std::uint64_t{seen.number} << 32 | lamp.number, &light, seen.spectrum,
                                    seen.set};
    colours.reflected =
        y * s.reflected.per_luminance(pair, s.shift, doppler.value, lamp.one_lamp_doppler, *s.kernels);
  } else {
    if (reflectance.is_looked_up()) sample(seen, s);
    const WavelengthSet::Sampled sampled{s.reflectance.data(), seen.spectrum, s.shift};
    colours.reflected = seen.set->film_under(light, shift, &sampled, s.lamp.data(), *s.kernels);
  }
  return colours;
}

}  // namespace backlight
