#include "kinks.h"

#include <algorithm>
#include <cmath>

#include "cie_tables.h"

namespace backlight {
namespace {

constexpr double first = cie::first_nm;
constexpr double last = cie::last_nm;
constexpr double blend_nm = 60.0;  // over which levels outside the visible range are reached

double slope_at(const SigmoidReflectance& s, double nm) {
  const double x = (s.c0 * nm + s.c1) * nm + s.c2;
  const double q = 1.0 + x * x;
  return s.half * (2.0 * s.c0 * nm + s.c1) / (q * std::sqrt(q));
}

}  // namespace

Kinks kinks_of(const SpectrumForm& form, double shift) {
  Kinks kinks;
  const bool levelled = form.kind == SpectrumForm::Kind::sigmoid && form.levelled;
  if (form.kind != SpectrumForm::Kind::sigmoid && form.kind != SpectrumForm::Kind::illuminant) return kinks;
  const SigmoidReflectance shape{form.c0, form.c1, form.c2, form.middle, form.half};
  const auto add = [&](double nm, double jump) {
    const double seen = nm / shift;
    if (seen > first && seen < last) kinks.list[kinks.count++] = {seen, shift * jump};
  };
  const double to_uv = levelled ? (shape.at(first) - form.below) / blend_nm : 0.0;
  const double to_ir = levelled ? (form.above - shape.at(last)) / blend_nm : 0.0;
  if (shift < 1.0) add(first, slope_at(shape, first) - to_uv);
  if (shift > 1.0) add(last, to_ir - slope_at(shape, last));
  if (levelled) {
    add(first - blend_nm, to_uv);
    add(last + blend_nm, -to_ir);
  }
  return kinks;
}

double steepness_of(const SigmoidReflectance& s) {
  double most = std::max(std::abs(slope_at(s, first)), std::abs(slope_at(s, last)));
  const auto take = [&](double nm) {
    if (nm > first && nm < last) most = std::max(most, std::abs(slope_at(s, nm)));
  };
  // Steepest about the roots of the polynomial; without any, on the flanks of the peak: where x² = 1/2 of
  // what is the least there, or so.
  if (s.c0 == 0.0) {
    if (s.c1 != 0.0) take(-s.c2 / s.c1);
    return most / (s.middle + s.half);
  }
  const double middle = -0.5 * s.c1 / s.c0;
  const double x = s.c2 + 0.5 * s.c1 * middle;
  const double apart2 = -x / s.c0;
  const double flank =
      apart2 > 0.0 ? std::sqrt(apart2) : std::sqrt(std::sqrt(1.0 + x * x) / (3.0 * std::abs(s.c0)));
  take(middle - flank);
  take(middle + flank);
  return most / (s.middle + s.half);
}

}  // namespace backlight
