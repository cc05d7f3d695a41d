#include "backlight/colour/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planck.h"
#include "rec709.h"

namespace backlight {
namespace {

// What joins the blackbody to D65's table at `nm`: a factor on nm^-5 / (exp(x) - 1).
double d65_joint(double nm) {
  const double x = planck::second_constant_nm_kelvin / planck::d65_kelvin / nm;
  return cie::d65_in_table(nm) * std::pow(nm, 5.0) * std::expm1(x);
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (at <= x.front()) return y.front();
  if (at >= x.back()) return y.back();
  const auto above = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin());
  const double fraction = (at - x[above - 1]) / (x[above] - x[above - 1]);
  return y[above - 1] + fraction * (y[above] - y[above - 1]);
}

std::string fault_of(const std::vector<double>& wavelengths, const std::vector<double>& values) {
  if (wavelengths.empty()) return "a spectrum needs at least one wavelength";
  if (wavelengths.size() != values.size()) {
    return "a spectrum needs as many values as wavelengths; there are " + std::to_string(wavelengths.size()) +
           " wavelengths and " + std::to_string(values.size()) + " values";
  }
  const auto nth = [](std::size_t i) { return " (number " + std::to_string(i + 1) + ")"; };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || wavelengths[i] <= 0.0) {
      return "a wavelength must be a positive number of nanometres" + nth(i);
    }
    if (i > 0 && wavelengths[i] <= wavelengths[i - 1]) return "wavelengths must ascend" + nth(i);
    if (!std::isfinite(values[i])) return "a spectrum's value must be finite" + nth(i);
    if (values[i] < 0.0) return "a spectrum's value must not be negative" + nth(i);
  }
  return {};
}

// Of the exponential in Planck's law: what is left of a double bears 1/nm^5, and D^5.
constexpr double greatest_log = 600.0;

// The sum over the observer's table of the product of the spectra; `light` null: 1.
LinearRgb sum_over_film(const Spectrum& radiance, const Spectrum* light) {
  std::array<double, cie::sample_count> nm, value, factor;
  for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = cie::first_nm + static_cast<double>(i);
  radiance.evaluate_light(nm.data(), cie::sample_count, value.data());
  if (light != nullptr) light->evaluate_light(nm.data(), cie::sample_count, factor.data());
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < nm.size(); ++i) {
    const auto& w = rec709::film_weights[i];
    sum += (light == nullptr ? value[i] : factor[i] * value[i]) * LinearRgb{w[0], w[1], w[2]};
  }
  return sum;
}

}  // namespace

Spectrum Spectrum::constant(double value) {
  Spectrum result;
  result.form_.scale = value;
  return result;
}

void Spectrum::set_shape(const SigmoidReflectance& shape) {
  form_.c0 = shape.c0;
  form_.c1 = shape.c1;
  form_.c2 = shape.c2;
  form_.middle = shape.middle;
  form_.half = shape.half;
}

Spectrum Spectrum::reflectance(const LinearRgb& rgb, std::optional<double> uv, std::optional<double> ir) {
  const LinearRgb possible = glm::clamp(rgb, 0.0, 1.0);
  const bool grey = possible.x == possible.y && possible.y == possible.z;
  if (grey && !uv && !ir) return constant(possible.x);
  return sigmoid_reflectance(fit_sigmoid(possible), uv, ir);
}

Spectrum Spectrum::sigmoid_reflectance(const SigmoidReflectance& shape, std::optional<double> uv,
                                       std::optional<double> ir) {
  Spectrum result;
  result.form_.kind = Kind::sigmoid;
  result.form_.scale = 1.0;
  result.set_shape(shape);
  const double first = shape.at(cie::first_nm), last = shape.at(cie::last_nm);
  result.form_.below = uv ? std::clamp(*uv, 0.0, 1.0) : first;
  result.form_.above = ir ? std::clamp(*ir, 0.0, 1.0) : last;
  // Most have no levels of their own: there, the blend would add nothing.
  result.form_.levelled = result.form_.below != first || result.form_.above != last;
  return result;
}

Spectrum Spectrum::illuminant(const LinearRgb& rgb) {
  const LinearRgb possible = glm::max(rgb, 0.0);
  const double most = std::max({possible.x, possible.y, possible.z});
  if (most == 0.0) return {};
  if (possible.x == possible.y && possible.y == possible.z) return d65().scaled(most);
  // A sigmoid that peaks near 1/2 is smoother than one that must reach 1.
  Spectrum result = d65();
  result.form_.kind = Kind::illuminant;
  result.form_.scale = 2.0 * most;
  result.set_shape(fit_sigmoid(possible * (0.5 / most)));
  return result;
}

Spectrum Spectrum::d65() {
  Spectrum result;
  static const double short_factor = d65_joint(cie::first_nm);
  static const double long_factor = d65_joint(cie::last_nm);
  result.form_.kind = Kind::d65;
  result.form_.scale = 1.0;
  result.form_.below = short_factor;
  result.form_.above = long_factor;
  return result;
}

Spectrum Spectrum::blackbody(double kelvin) {
  return blackbody(kelvin, std::max(kelvin, planck::coldest_kelvin));
}

Spectrum Spectrum::blackbody(double kelvin, double reference_kelvin) {
  Spectrum result;
  result.form_.kind = Kind::blackbody;
  result.form_.scale = 1.0;
  result.form_.c0 = kelvin;
  result.form_.c1 = planck::log_film_luminance(reference_kelvin);
  return result;
}

Spectrum Spectrum::absolute_blackbody(double kelvin) {
  Spectrum result;
  result.form_.kind = Kind::blackbody;
  result.form_.scale = 1.0;
  result.form_.c0 = kelvin;
  result.form_.c1 = -planck::log_absolute_luminance();
  return result;
}

SpectrumOrError Spectrum::tabulated(std::vector<double> wavelengths, std::vector<double> values) {
  if (std::string fault = fault_of(wavelengths, values); !fault.empty()) return {{}, std::move(fault)};
  Spectrum result;
  result.form_.kind = Kind::tabulated;
  result.form_.scale = 1.0;
  result.table_ = std::make_shared<const Table>(Table{std::move(wavelengths), std::move(values)});
  return {std::move(result), {}};
}

Spectrum Spectrum::scaled(double factor) const {
  Spectrum result = *this;
  if (form_.kind == Kind::blackbody && factor > 0.0) {
    result.form_.c1 -= std::log(factor);  // which has room for any strength of any body
  } else {
    result.form_.scale *= factor;
  }
  return result;
}

double Spectrum::at(double nm) const {
  double value = 0.0;
  evaluate(&nm, 1, &value);
  return value;
}

void Spectrum::evaluate(const double* nm, int n, double* out) const {
  static const SpectralKernels& widest = spectral_kernels(InstructionSet::widest);
  evaluate(nm, n, out, widest);
}

void Spectrum::evaluate(const double* nm, int n, double* out, const SpectralKernels& kernels) const {
  if (form_.kind != Kind::tabulated) {
    kernels.evaluate(form_, nm, n, out);
    return;
  }
  for (int i = 0; i < n; ++i) out[i] = form_.scale * interpolate(table_->nm, table_->values, nm[i]);
}

void Spectrum::evaluate_light(const double* nm, int n, double* out, const SpectralKernels& kernels) const {
  if (form_.kind != Kind::blackbody || n == 0) return evaluate(nm, n, out, kernels);
  const double x = planck::second_constant_nm_kelvin / (*std::max_element(nm, nm + n) * form_.c0);
  Spectrum lowered = *this;
  lowered.form_.c1 = std::max(form_.c1, -x - greatest_log);
  lowered.evaluate(nm, n, out, kernels);
}

void Spectrum::evaluate_light(const double* nm, int n, double* out) const {
  evaluate_light(nm, n, out, spectral_kernels(InstructionSet::widest));
}

bool Spectrum::is_black() const {
  return form_.scale == 0.0;
}

bool Spectrum::is_grey() const {
  if (form_.scale == 0.0 || form_.kind == Kind::constant) return true;
  return form_.kind == Kind::sigmoid && form_.c0 == 0.0 && form_.c1 == 0.0 && !form_.levelled;
}

bool Spectrum::is_d65_shaped() const {
  return form_.scale == 0.0 || form_.kind == Kind::d65;
}

std::optional<double> Spectrum::share_of_d65() const {
  return form_.kind == Kind::d65 ? std::optional(form_.scale) : std::nullopt;
}

LinearRgb film_colour(const Spectrum& emission) {
  return sum_over_film(emission, nullptr);
}

LinearRgb colour_under_d65(const Spectrum& reflectance) {
  return colour_under(Spectrum::d65(), reflectance);
}

LinearRgb colour_under(const Spectrum& light, const Spectrum& reflectance) {
  return sum_over_film(reflectance, &light);
}

}  // namespace backlight
