#include "backlight/colour/observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include "backlight/colour/spectrum.h"
#include "kinks.h"
#include "rec709.h"
#include "spline_weights.h"

namespace backlight {
namespace {

// Of the density of wavelengths: docs/colour.md has the measurements behind the share.
constexpr double uniform_share = 0.7;

double root_of_observer(std::size_t sample) {
  const auto& cmf = cie::observer_1931[sample];
  return std::sqrt(cmf[0] + cmf[1] + cmf[2]);
}

// Wavelengths that cut the density into count - 1 equal parts.
std::vector<double> place_wavelengths(int count) {
  double root_sum = 0.0;
  for (std::size_t i = 0; i < cie::sample_count; ++i) root_sum += root_of_observer(i);
  const auto density = [root_sum](std::size_t i) {
    return uniform_share / cie::sample_count + (1.0 - uniform_share) * root_of_observer(i) / root_sum;
  };
  std::array<double, cie::sample_count> below{};
  for (std::size_t i = 1; i < below.size(); ++i)
    below[i] = below[i - 1] + 0.5 * (density(i - 1) + density(i));

  std::vector<double> nm;
  std::size_t cell = 0;
  for (int i = 0; i < count; ++i) {
    const double share = below.back() * i / (count - 1);
    while (cell + 2 < below.size() && below[cell + 1] < share) ++cell;
    nm.push_back(cie::first_nm + static_cast<double>(cell) +
                 (share - below[cell]) / (below[cell + 1] - below[cell]));
  }
  nm.back() = cie::last_nm;
  return nm;
}

// A sigmoid's colour, and its derivatives by coefficients in t = (nm - centre) / half width.
struct Seen {
  LinearRgb colour{0.0};
  Mat3 slopes{0.0};
};

constexpr double centre_nm = 595.0;
constexpr double half_width_nm = 235.0;

// Reflectances that change by no more per nm are followed well enough by the default number of wavelengths,
// and by fewer as well as their number says: docs/colour.md has the measurements.
constexpr double steepest_gentle = 0.013;
// Where they change by more.
constexpr int fine_count = 236;

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The change of a shape by (a, b, c) of a t² + b t + c.
SigmoidReflectance moved(const SigmoidReflectance& shape, const Vec3& by) {
  constexpr double centre = centre_nm / half_width_nm;
  return {shape.c0 + by.x / (half_width_nm * half_width_nm),
          shape.c1 + (by.y - 2.0 * centre * by.x) / half_width_nm,
          shape.c2 + (by.x * centre - by.y) * centre + by.z, shape.middle, shape.half};
}

}  // namespace

WavelengthSet::WavelengthSet(int count) {
  if (count < 4) throw std::invalid_argument("a WavelengthSet needs at least 4 wavelengths");
  nm_ = place_wavelengths(count);
  for (const double nm : nm_) places_.push_back((nm - centre_nm) / half_width_nm);
  ObserverSamples even;
  even.fill(1.0);
  for (std::vector<double>* channel : {&red_, &green_, &blue_}) channel->resize(nm_.size());
  SplineWeights(nm_).fill(even, {red_.data(), green_.data(), blue_.data()}, nullptr);
  std::vector<double> daylight(nm_.size());
  Spectrum::d65().evaluate(nm_.data(), count, daylight.data());
  const LinearRgb white = film(daylight.data());
  for (std::size_t i = 0; i < nm_.size(); ++i) {
    red_[i] /= white.x;
    green_[i] /= white.y;
    blue_[i] /= white.z;
  }
  lights_ = std::make_shared<const LightRows>(nm_);
}

namespace {

// A whole light shows the same whatever the set: the rows of one do for all.
const LightRows& whole_lights() {
  static const LightRows& lights = wavelength_set(default_wavelength_count).lights();
  return lights;
}

}  // namespace

LinearRgb WavelengthSet::film_under(const Spectrum& light, double shift, const Sampled* reflectance,
                                    double* work, const SpectralKernels& kernels) const {
  const std::optional<LightRows::Place> place = whole_lights().at(light, shift);
  if (!place) {  // the same at every wavelength
    light.evaluate(nm_.data(), size(), work, kernels);
    return film(work, reflectance == nullptr ? nullptr : reflectance->values, kernels);
  }
  if (reflectance == nullptr && !light.shape()) return place->film();
  return place->scale * film_at(*place, light, shift, reflectance, work, kernels);
}

LinearRgb WavelengthSet::film_per_luminance(const Spectrum& light, double shift, const Sampled* reflectance,
                                            double* work, const SpectralKernels& kernels) const {
  LightRows::Place place = whole_lights().at(light, shift).value();
  place.scale = 1.0;
  return film_at(place, light, shift, reflectance, work, kernels) / luminance(place.film());
}

// Of the place's scale 1. Coloured light is D65 times a reflectance.
LinearRgb WavelengthSet::film_at(const LightRows::Place& place, const Spectrum& light, double shift,
                                 const Sampled* reflectance, double* work,
                                 const SpectralKernels& kernels) const {
  const std::optional<SigmoidReflectance> colour = light.shape();
  if (colour) {
    for (std::size_t i = 0; i < nm_.size(); ++i) work[i] = shift * nm_[i];
    Spectrum::sigmoid_reflectance(*colour).evaluate(work, size(), work, kernels);
  }
  const LightRows::Weighting weighting = lights_->weighting(place);
  LinearRgb sum = reflectance == nullptr
                      ? weighting.film(work, nullptr, kernels)
                      : weighting.film(reflectance->values, colour ? work : nullptr, kernels);
  // Splines do not follow kinks: docs/colour.md equation (c3).
  if (reflectance != nullptr) {
    const Kinks kinks = kinks_of(reflectance->spectrum->form(), reflectance->shift);
    for (int i = 0; i < kinks.count; ++i) {
      const auto [nm, jump] = kinks.list[i];
      sum += (colour ? jump * colour->at(shift * nm) : jump) * weighting.left_out(nm);
    }
  }
  if (colour) {
    const Kinks kinks = kinks_of(light.form(), shift);
    for (int i = 0; i < kinks.count; ++i) {
      const auto [nm, jump] = kinks.list[i];
      const double at = reflectance == nullptr ? 1.0 : reflectance->spectrum->at(reflectance->shift * nm);
      sum += jump * at * weighting.left_out(nm);
    }
  }
  return sum;
}

const WavelengthSet& WavelengthSet::for_steepness(double steepness) const {
  return steepness > steepest_gentle ? fine() : *this;
}

const WavelengthSet& WavelengthSet::fine() const {
  if (size() >= fine_count) return *this;
  static const WavelengthSet& fine = wavelength_set(fine_count);
  return fine;
}

WavelengthSet::Upsampled WavelengthSet::upsampled(const LinearRgb& rgb, double steepness) const {
  const SigmoidReflectance shape = upsample(rgb);
  const WavelengthSet& set = for_steepness(std::max(steepness, steepness_of(shape)));
  return {set.match(shape, rgb), &set};
}

SigmoidReflectance WavelengthSet::match(const SigmoidReflectance& start, const LinearRgb& rgb) const {
  static const SpectralKernels& widest = spectral_kernels(InstructionSet::widest);
  const LightRows::Weights white = lights_->of_white();
  const auto see = [&](const SigmoidReflectance& shape) {
    SpectrumForm form;
    form.c0 = shape.c0;
    form.c1 = shape.c1;
    form.c2 = shape.c2;
    form.middle = shape.middle;
    form.half = shape.half;
    double sums[4][3];
    widest.film_and_slopes(form, nm_.data(), places_.data(), white.of, size(), sums);
    Seen seen;
    for (int c = 0; c < 3; ++c) {
      seen.colour[c] = sums[0][c];
      for (int k = 0; k < 3; ++k) seen.slopes[k][c] = sums[k + 1][c];
    }
    return seen;
  };
  constexpr int steps = 3;
  SigmoidReflectance best = start;
  Seen seen = see(best);
  for (int step = 0; step < steps; ++step) {
    const Vec3 off = seen.colour - rgb;
    if (!(largest(off) > 1e-8 * largest(rgb))) break;
    const SigmoidReflectance trial = moved(best, -(glm::inverse(seen.slopes) * off));
    const Seen next = see(trial);
    if (!(largest(next.colour - rgb) < largest(off))) break;
    best = trial;
    seen = next;
  }
  return best;
}

Spectrum WavelengthSet::match(const Spectrum& spectrum, const LinearRgb& rgb) const {
  const std::optional<SigmoidReflectance> shape = spectrum.shape();
  if (!shape || spectrum.scale() == 0.0) return spectrum;
  return spectrum.with_shape(match(*shape, rgb / spectrum.scale()));
}

const WavelengthSet& wavelength_set(int count) {
  static std::mutex guard;
  static std::map<int, WavelengthSet> made;  // an element stays where it is
  const std::lock_guard lock(guard);
  return made.try_emplace(count, count).first->second;
}

LinearRgb WavelengthSet::film(const double* radiance) const {
  static const SpectralKernels& widest = spectral_kernels(InstructionSet::widest);
  return film(radiance, widest);
}

LinearRgb WavelengthSet::film(const double* radiance, const SpectralKernels& kernels) const {
  return film(radiance, nullptr, kernels);
}

LinearRgb WavelengthSet::film(const double* lamp, const double* reflectance,
                              const SpectralKernels& kernels) const {
  double colour[3];
  kernels.film({red_.data(), green_.data(), blue_.data()}, lamp, reflectance, size(), colour);
  return {colour[0], colour[1], colour[2]};
}

double steepness_of(const Spectrum& spectrum) {
  const std::optional<SigmoidReflectance> shape = spectrum.shape();
  return shape ? steepness_of(*shape) : 0.0;
}

LinearRgb WavelengthSet::weight(int i) const {
  const auto at = static_cast<std::size_t>(i);
  return {red_[at], green_[at], blue_[at]};
}

Xyz colour_matching_functions(double nm) {
  if (!(nm >= cie::first_nm && nm <= cie::last_nm)) return Xyz{0.0};
  const auto cell =
      std::min(static_cast<std::size_t>(nm - cie::first_nm), std::size_t{cie::sample_count - 2});
  const double fraction = nm - (cie::first_nm + static_cast<double>(cell));
  const auto& a = cie::observer_1931[cell];
  const auto& b = cie::observer_1931[cell + 1];
  return (1.0 - fraction) * Xyz{a[0], a[1], a[2]} + fraction * Xyz{b[0], b[1], b[2]};
}

}  // namespace backlight
