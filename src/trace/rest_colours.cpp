#include "backlight/trace/rest_colours.h"

#include <algorithm>
#include <cmath>

#include "backlight/colour/upsampling.h"

namespace backlight {
namespace {

const SpectralKernels& kernels() {
  static const SpectralKernels& widest = spectral_kernels(InstructionSet::widest);
  return widest;
}

// By the same quadrature as shifted colours: docs/colour.md, "At rest".
LinearRgb seen_under(const Spectrum& light, const SeenSpectrum& reflectance) {
  const Spectrum* spectrum = reflectance.spectrum;
  const WavelengthSet* set = reflectance.set;
  if (light.has_features() || spectrum->has_features()) return colour_under(light, *spectrum);
  std::vector<double> values(set->nm().size()), work(set->nm().size());
  spectrum->evaluate(set->nm().data(), set->size(), values.data(), kernels());
  const WavelengthSet::Sampled sampled{values.data(), spectrum, 1.0};
  return set->film_under(light, 1.0, &sampled, work.data(), kernels());
}

FilmQuadrature quadrature(const Spectrum& light, const WavelengthSet& set) {
  if (light.has_features()) return film_quadrature(light);
  FilmQuadrature rule{{set.nm().begin(), set.nm().end()}, {}};
  const Spectrum one = Spectrum::constant(1.0);
  std::vector<double> values(rule.nm.size(), 0.0), work(rule.nm.size());
  for (double& value : values) {
    value = 1.0;
    const WavelengthSet::Sampled sampled{values.data(), &one, 1.0};
    rule.weight.push_back(set.film_under(light, 1.0, &sampled, work.data(), kernels()));
    value = 0.0;
  }
  return rule;
}

}  // namespace

RestColours::RestColours(const Scene& scene, const WavelengthSet& wavelengths, const SceneSpectra& spectra)
    : materials_(scene.materials.size()),
      wavelengths_(&wavelengths),
      steepest_light_(spectra.steepest_light()) {
  table_.reserve(scene.lights.size() * materials_ * 2);
  const auto product = [&](std::size_t light, std::size_t material, int slot, const Colour& reflectance) {
    const Colour& lamp = scene.lights[light].colour;
    const bool plain = lamp.spectrum.is_d65_shaped() || reflectance.spectrum.is_grey();
    if (plain) return lamp.rgb * reflectance.rgb;
    return seen_under(*spectra.light(light).spectrum, spectra.reflectance(static_cast<int>(material), slot));
  };
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    for (std::size_t i = 0; i < materials_; ++i) {
      const Material& m = scene.materials[i];
      table_.push_back(product(light, i, 0, m.checker ? m.checker->colours[0] : m.reflectance));
      table_.push_back(m.checker ? product(light, i, 1, m.checker->colours[1]) : LinearRgb{0.0});
    }
    const Colour& colour = scene.lights[light].colour;
    Lamp lamp{colour.rgb, {}, {}};
    if (!colour.spectrum.is_d65_shaped()) {
      const Spectrum& spectrum = *spectra.light(light).spectrum;
      lamp.gentle = quadrature(spectrum, wavelengths);
      lamp.steep = quadrature(spectrum, wavelengths.fine());
    }
    lamps_.push_back(std::move(lamp));
  }
}

bool RestColours::needs_spectra(const Scene& scene) {
  return std::ranges::any_of(scene.lights, [](const Light& l) { return !l.colour.spectrum.is_d65_shaped(); });
}

LinearRgb RestColours::under(std::size_t light, const LinearRgb& texel) const {
  const Lamp& lamp = lamps_[light];
  if (std::isnan(texel.r + texel.g + texel.b)) return LinearRgb{texel.r + texel.g + texel.b};
  if (lamp.gentle.nm.empty()) return texel * lamp.rgb;
  const auto [shape, set] = wavelengths_->upsampled(texel, steepest_light_);
  const FilmQuadrature& rule = set == wavelengths_ ? lamp.gentle : lamp.steep;
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < rule.nm.size(); ++i) sum += shape.at(rule.nm[i]) * rule.weight[i];
  return sum;
}

}  // namespace backlight
