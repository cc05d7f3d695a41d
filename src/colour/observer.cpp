#include "backlight/colour/observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include "backlight/colour/spectrum.h"
#include "rec709.h"

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

// Second derivatives at the nodes of the natural cubic spline through (x, y), by the tridiagonal equations.
std::vector<double> spline_curvatures(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> upper(n, 0.0), curvature(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
    const double bend = 6.0 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left);
    const double pivot = 2.0 * (left + right) - left * upper[i - 1];
    upper[i] = right / pivot;
    curvature[i] = (bend - left * curvature[i - 1]) / pivot;
  }
  curvature[n - 1] = 0.0;
  for (std::size_t i = n - 1; i-- > 1;) curvature[i] -= upper[i] * curvature[i + 1];
  return curvature;
}

double spline_at(const std::vector<double>& x, const std::vector<double>& y,
                 const std::vector<double>& curvature, std::size_t cell, double at) {
  const double width = x[cell + 1] - x[cell];
  const double a = (x[cell + 1] - at) / width, b = 1.0 - a;
  return a * y[cell] + b * y[cell + 1] +
         ((a * a * a - a) * curvature[cell] + (b * b * b - b) * curvature[cell + 1]) * (width * width / 6.0);
}

// The film colour of the spline that is 1 at one node and 0 at the others.
LinearRgb integrate_cardinal_spline(const std::vector<double>& nm, std::size_t node) {
  std::vector<double> unit(nm.size(), 0.0);
  unit[node] = 1.0;
  const std::vector<double> curvature = spline_curvatures(nm, unit);
  LinearRgb sum{0.0};
  std::size_t cell = 0;
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const double at = cie::first_nm + static_cast<double>(i);
    while (cell + 2 < nm.size() && nm[cell + 1] < at) ++cell;
    const auto& w = rec709::film_weights[i];
    sum += spline_at(nm, unit, curvature, cell, at) * LinearRgb{w[0], w[1], w[2]};
  }
  return sum;
}

}  // namespace

WavelengthSet::WavelengthSet(int count) {
  if (count < 4) throw std::invalid_argument("a WavelengthSet needs at least 4 wavelengths");
  nm_ = place_wavelengths(count);
  for (std::size_t i = 0; i < nm_.size(); ++i) {
    const LinearRgb weight = integrate_cardinal_spline(nm_, i);
    red_.push_back(weight.x);
    green_.push_back(weight.y);
    blue_.push_back(weight.z);
  }
  std::vector<double> daylight(nm_.size());
  Spectrum::d65().evaluate(nm_.data(), count, daylight.data());
  const LinearRgb white = film(daylight.data());
  for (std::size_t i = 0; i < nm_.size(); ++i) {
    red_[i] /= white.x;
    green_[i] /= white.y;
    blue_[i] /= white.z;
  }
  daylight_ = std::make_shared<const ShiftedDaylight>(nm_, red_, green_, blue_);
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
