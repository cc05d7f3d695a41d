#include "backlight/colour/spectrum.h"

#include <algorithm>
#include <cmath>

#include "planck.h"
#include "rec709.h"

namespace backlight {
namespace {

constexpr double d65_kelvin = 6504.0;

// The width in nm of the blend from the ends of the visible range to a level beyond it.
constexpr double blend_nm = 60.0;

// Logarithm of the scale that joins the 6504 K blackbody to D65's table at `nm`.
double d65_joint(double nm) {
  return std::log(planck::relative_radiance(d65_kelvin, nm, 0.0) / cie::d65_in_table(nm));
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

template <class Radiance>
LinearRgb sum_over_film(const Radiance& radiance) {
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < rec709::film_weights.size(); ++i) {
    const auto& w = rec709::film_weights[i];
    sum += radiance(cie::first_nm + static_cast<double>(i)) * LinearRgb{w[0], w[1], w[2]};
  }
  return sum;
}

}  // namespace

Spectrum Spectrum::constant(double value) {
  Spectrum result;
  result.scale_ = value;
  return result;
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
  result.kind_ = Kind::sigmoid;
  result.scale_ = 1.0;
  result.shape_ = shape;
  result.uv_ = uv ? std::clamp(*uv, 0.0, 1.0) : shape.at(cie::first_nm);
  result.ir_ = ir ? std::clamp(*ir, 0.0, 1.0) : shape.at(cie::last_nm);
  return result;
}

Spectrum Spectrum::illuminant(const LinearRgb& rgb) {
  const LinearRgb possible = glm::max(rgb, 0.0);
  const double most = std::max({possible.x, possible.y, possible.z});
  if (most == 0.0) return {};
  if (possible.x == possible.y && possible.y == possible.z) return d65().scaled(most);
  // A sigmoid that peaks near 1/2 is smoother than one that must reach 1.
  Spectrum result = d65();
  result.kind_ = Kind::illuminant;
  result.scale_ = 2.0 * most;
  result.shape_ = fit_sigmoid(possible * (0.5 / most));
  return result;
}

Spectrum Spectrum::d65() {
  Spectrum result;
  result.kind_ = Kind::d65;
  result.scale_ = 1.0;
  result.short_log_scale_ = d65_joint(cie::first_nm);
  result.long_log_scale_ = d65_joint(cie::last_nm);
  return result;
}

Spectrum Spectrum::blackbody(double kelvin) {
  return blackbody(kelvin, kelvin);
}

Spectrum Spectrum::blackbody(double kelvin, double reference_kelvin) {
  Spectrum result;
  result.kind_ = Kind::blackbody;
  result.scale_ = 1.0;
  result.kelvin_ = kelvin;
  result.long_log_scale_ = planck::log_film_luminance(reference_kelvin);
  return result;
}

SpectrumOrError Spectrum::tabulated(std::vector<double> wavelengths, std::vector<double> values) {
  if (std::string fault = fault_of(wavelengths, values); !fault.empty()) return {{}, std::move(fault)};
  Spectrum result;
  result.kind_ = Kind::tabulated;
  result.scale_ = 1.0;
  result.table_ = std::make_shared<const Table>(Table{std::move(wavelengths), std::move(values)});
  return {std::move(result), {}};
}

Spectrum Spectrum::scaled(double factor) const {
  Spectrum result = *this;
  result.scale_ *= factor;
  return result;
}

double Spectrum::reflectance_at(double nm) const {
  const double inside = shape_.at(nm);
  if (nm < cie::first_nm) {
    return inside + std::min((cie::first_nm - nm) / blend_nm, 1.0) * (uv_ - inside);
  }
  if (nm > cie::last_nm) return inside + std::min((nm - cie::last_nm) / blend_nm, 1.0) * (ir_ - inside);
  return inside;
}

double Spectrum::d65_at(double nm) const {
  if (nm < cie::first_nm) return planck::relative_radiance(d65_kelvin, nm, short_log_scale_);
  if (nm > cie::last_nm) return planck::relative_radiance(d65_kelvin, nm, long_log_scale_);
  return cie::d65_in_table(nm);
}

// Hands the visitor this spectrum as a function of the wavelength: the kind is looked up once for a whole
// batch.
template <class Visitor>
void Spectrum::visit(const Visitor& visitor) const {
  const double scale = scale_;
  switch (kind_) {
    case Kind::constant:
      return visitor([scale](double) { return scale; });
    case Kind::sigmoid:
      // Most have no levels of their own outside the visible range: there, the blend would add nothing.
      if (uv_ == shape_.at(cie::first_nm) && ir_ == shape_.at(cie::last_nm)) {
        return visitor([shape = shape_, scale](double nm) { return scale * shape.at(nm); });
      }
      return visitor([this, scale](double nm) { return scale * reflectance_at(nm); });
    case Kind::d65:
      return visitor([this, scale](double nm) { return scale * d65_at(nm); });
    case Kind::illuminant:
      return visitor([this, scale](double nm) { return scale * (shape_.at(nm) * d65_at(nm)); });
    case Kind::blackbody:
      return visitor([this, scale](double nm) {
        const double value = scale * planck::relative_radiance(kelvin_, nm, long_log_scale_);
        return std::min(value, std::numeric_limits<double>::max());
      });
    case Kind::tabulated:
      return visitor(
          [this, scale](double nm) { return scale * interpolate(table_->nm, table_->values, nm); });
  }
}

double Spectrum::at(double nm) const {
  double value = 0.0;
  evaluate(&nm, 1, &value);
  return value;
}

void Spectrum::evaluate(const double* nm, int n, double* out) const {
  if (kind_ == Kind::d65) {
    // The test of where each is, apart from the look-up in the table: most are in it.
    bool all_inside = true;
    for (int i = 0; i < n; ++i) {
      const double at = nm[i];
      all_inside &= (at >= cie::first_nm) & (at <= cie::last_nm);
      out[i] = scale_ * cie::d65_in_table(std::clamp(at, double{cie::first_nm}, double{cie::last_nm}));
    }
    for (int i = 0; i < n && !all_inside; ++i) {
      if (!(nm[i] >= cie::first_nm && nm[i] <= cie::last_nm)) out[i] = scale_ * d65_at(nm[i]);
    }
    return;
  }
  visit([nm, n, out](const auto& value_at) {
    for (int i = 0; i < n; ++i) out[i] = value_at(nm[i]);
  });
}

bool Spectrum::is_grey() const {
  if (scale_ == 0.0 || kind_ == Kind::constant) return true;
  const bool flat = shape_.c0 == 0.0 && shape_.c1 == 0.0;
  const double level = shape_.at(cie::first_nm);
  return kind_ == Kind::sigmoid && flat && uv_ == level && ir_ == level;
}

bool Spectrum::is_d65_shaped() const {
  return scale_ == 0.0 || kind_ == Kind::d65;
}

LinearRgb film_colour(const Spectrum& emission) {
  return sum_over_film([&](double nm) { return emission.at(nm); });
}

LinearRgb colour_under_d65(const Spectrum& reflectance) {
  return colour_under(Spectrum::d65(), reflectance);
}

LinearRgb colour_under(const Spectrum& light, const Spectrum& reflectance) {
  return sum_over_film([&](double nm) { return light.at(nm) * reflectance.at(nm); });
}

}  // namespace backlight
