#include "backlight/colour/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "backlight/colour/film_integral.h"
#include "planck.h"
#include "rec709.h"

namespace backlight {
namespace {

// What joins the blackbody to D65's table at `nm`: a factor on nm^-5 / (exp(x) - 1).
double d65_joint(double nm) {
  const double x = planck::second_constant_nm_kelvin / planck::d65_kelvin / nm;
  return cie::d65_in_table(nm) * std::pow(nm, 5.0) * std::expm1(x);
}

// Straight lines through the points (x, y). Wavelengths in rising order take no search.
class Interpolation {
 public:
  Interpolation(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {}

  double at(double nm) {
    if (x_.empty()) return 0.0;
    if (nm <= x_.front()) return y_.front();
    if (nm >= x_.back()) return y_.back();
    // x[above - 1] <= nm < x[above]
    constexpr int steps = 4;
    for (int i = 0; i < steps && x_[above_] <= nm; ++i) ++above_;
    if (x_[above_] <= nm || x_[above_ - 1] > nm) {
      above_ = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), nm) - x_.begin());
    }
    const double fraction = (nm - x_[above_ - 1]) / (x_[above_] - x_[above_ - 1]);
    return y_[above_ - 1] + fraction * (y_[above_] - y_[above_ - 1]);
  }

 private:
  const std::vector<double>& x_;
  const std::vector<double>& y_;
  std::size_t above_ = 1;
};

// `what`: "spectrum" or "line".
std::string fault_of(const std::string& what, const std::vector<double>& wavelengths,
                     const std::vector<double>& values, bool ascending) {
  if (wavelengths.empty()) return "a " + what + " needs at least one wavelength";
  if (wavelengths.size() != values.size()) {
    return "a " + what + " needs as many values as wavelengths; there are " +
           std::to_string(wavelengths.size()) + " wavelengths and " + std::to_string(values.size()) +
           " values";
  }
  const auto nth = [](std::size_t i) { return " (number " + std::to_string(i + 1) + ")"; };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || wavelengths[i] <= 0.0) {
      return "a wavelength must be a positive number of nanometres" + nth(i);
    }
    if (ascending && i > 0 && wavelengths[i] <= wavelengths[i - 1]) return "wavelengths must ascend" + nth(i);
    if (!std::isfinite(values[i])) return "a " + what + "'s value must be finite" + nth(i);
    if (values[i] < 0.0) return "a " + what + "'s value must not be negative" + nth(i);
  }
  return {};
}

// Of the exponential in Planck's law: what is left of a double bears 1/nm^5, and D^5.
constexpr double greatest_log = 600.0;

// Of the product of the spectra; `light` null: 1.
LinearRgb film_of_product(const Spectrum& radiance, const Spectrum* light) {
  if (light != nullptr && (light->has_features() || radiance.has_features())) {
    return integrate_film(*light, 1.0, &radiance, 1.0);
  }
  if (radiance.has_features()) return integrate_film(radiance, 1.0);
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
  return planckian(kelvin, planck::log_film_luminance(reference_kelvin));
}

Spectrum Spectrum::planckian(double kelvin, double log_divisor) {
  Spectrum result;
  result.form_.kind = Kind::blackbody;
  result.form_.scale = 1.0;
  result.form_.c0 = kelvin;
  result.form_.c1 = log_divisor;
  return result;
}

Spectrum Spectrum::absolute_blackbody(double kelvin) {
  return planckian(kelvin, -planck::log_absolute_luminance());
}

SpectrumOrError Spectrum::tabulated(std::vector<double> wavelengths, std::vector<double> values) {
  return tabulated(std::move(wavelengths), std::move(values), {}, {});
}

SpectrumOrError Spectrum::tabulated(std::vector<double> wavelengths, std::vector<double> values,
                                    std::vector<double> line_wavelengths, std::vector<double> line_values) {
  const bool no_lines = line_wavelengths.empty() && line_values.empty();
  std::string fault;
  if (no_lines || !wavelengths.empty() || !values.empty()) {
    fault = fault_of("spectrum", wavelengths, values, true);
  }
  if (fault.empty() && !no_lines) fault = fault_of("list of lines", line_wavelengths, line_values, false);
  if (!fault.empty()) return {{}, std::move(fault)};
  std::vector<Line> lines;
  for (std::size_t i = 0; i < line_values.size(); ++i) lines.push_back({line_wavelengths[i], line_values[i]});
  std::vector<Span> bright = bright_parts(wavelengths, values);
  Spectrum result;
  result.form_.kind = Kind::tabulated;
  result.form_.scale = 1.0;
  result.table_ = std::make_shared<const Table>(
      Table{std::move(wavelengths), std::move(values), std::move(lines), std::move(bright)});
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
  Interpolation table(table_->nm, table_->values);
  for (int i = 0; i < n; ++i) out[i] = form_.scale * table.at(nm[i]);
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
  if (form_.kind == Kind::tabulated) {
    const auto& values = table_->values;
    return table_->lines.empty() &&
           std::ranges::all_of(values, [&](double v) { return v == values.front(); });
  }
  return form_.kind == Kind::sigmoid && form_.c0 == 0.0 && form_.c1 == 0.0 && !form_.levelled;
}

bool Spectrum::is_d65_shaped() const {
  return form_.scale == 0.0 || form_.kind == Kind::d65;
}

std::optional<SigmoidReflectance> Spectrum::shape() const {
  if (form_.kind != Kind::sigmoid && form_.kind != Kind::illuminant) return std::nullopt;
  return SigmoidReflectance{form_.c0, form_.c1, form_.c2, form_.middle, form_.half};
}

Spectrum Spectrum::with_shape(const SigmoidReflectance& shape) const {
  Spectrum result = *this;
  result.set_shape(shape);
  return result;
}

std::span<const double> Spectrum::knots() const {
  static const std::array<double, cie::d65_by_5_nm.size()> joints = [] {
    std::array<double, cie::d65_by_5_nm.size()> nm{};
    for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = cie::first_nm + 5.0 * static_cast<double>(i);
    return nm;
  }();
  static constexpr std::array<double, 4> levels{300.0, cie::first_nm, cie::last_nm, 890.0};
  if (form_.kind == Kind::tabulated) return table_->nm;
  if (form_.kind == Kind::d65 || form_.kind == Kind::illuminant) return joints;
  if (form_.kind == Kind::sigmoid) return levels;
  return {};
}

std::vector<Spectrum::Span> Spectrum::bright_parts(const std::vector<double>& nm,
                                                   const std::vector<double>& values) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<Span> parts;
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (values[i] == 0.0) continue;
    // The straight lines to both neighbours, or the value kept beyond the ends.
    const double begin = i == 0 ? 0.0 : nm[i - 1];
    const double end = i + 1 == nm.size() ? infinity : nm[i + 1];
    if (!parts.empty() && begin <= parts.back().end) {
      parts.back().end = end;
    } else {
      parts.push_back({begin, end});
    }
  }
  return parts;
}

std::span<const Spectrum::Span> Spectrum::bright() const {
  static constexpr Span everywhere{0.0, std::numeric_limits<double>::infinity()};
  if (form_.kind == Kind::tabulated) return table_->bright;
  return {&everywhere, 1};
}

std::span<const Spectrum::Line> Spectrum::lines() const {
  if (form_.kind != Kind::tabulated) return {};
  return table_->lines;
}

LinearRgb film_colour(const Spectrum& emission) {
  return film_of_product(emission, nullptr);
}

LinearRgb colour_under_d65(const Spectrum& reflectance) {
  return colour_under(Spectrum::d65(), reflectance);
}

LinearRgb colour_under(const Spectrum& light, const Spectrum& reflectance) {
  return film_of_product(reflectance, &light);
}

}  // namespace backlight
