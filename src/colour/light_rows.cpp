#include "backlight/colour/light_rows.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "backlight/base/lane_exponential.h"
#include "backlight/base/lane_power.h"
#include "backlight/colour/spectrum.h"
#include "planck.h"
#include "spline_weights.h"

namespace backlight {
namespace {

// Numbers from `least` (of a row) up to `end`. The first bits of a number's fraction, and its exponent, say
// which row is at or below it.
struct Range {
  double least;
  double end;
  int bits_below_row;

  [[nodiscard]] constexpr std::uint64_t row_bits(double x) const {
    return std::bit_cast<std::uint64_t>(x) >> bits_below_row;
  }
  [[nodiscard]] constexpr bool has(double x) const { return x >= least && x < end; }
  [[nodiscard]] constexpr std::size_t rows() const { return row_bits(end) - row_bits(least) + 1; }
  [[nodiscard]] constexpr std::size_t index(double x) const { return row_bits(x) - row_bits(least); }
  [[nodiscard]] double at(std::size_t index) const {
    return std::bit_cast<double>((row_bits(least) + index) << bits_below_row);
  }
};

// Shifts at which any of D65's table is in the visible range; beyond both ends it is a blackbody there.
constexpr Range shifts{111.0 / 256.0, 592.0 / 256.0, 42};
static_assert(shifts.least * cie::last_nm <= cie::first_nm && shifts.end * cie::first_nm >= cie::last_nm);

// Temperatures times shifts, in K. Beyond, a row is made for each place.
constexpr Range temperatures{64.0, 4194304.0, 44};

// Greater powers of e would leave no room for what a strength, a distance and D make of them.
constexpr double greatest_log = 600.0;

double exponential_of(double x) {
  return exponential(Lanes<2>(x)).value().v[0];
}

double logarithm_of(double x) {
  return 0.69314718055994530942 * log2_of_positive(Lanes<2>(x)).v[0];
}

LinearRgb weighted_sum(const ObserverSamples& light, const WeightLanes& weights) {
  Lanes<2> red_green = 0.0, blue = 0.0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    red_green = red_green + Lanes<2>(light[i]) * Lanes<2>::load(weights.of[i]);
    blue = blue + Lanes<2>(light[i]) * Lanes<2>::load(weights.of[i] + 2);
  }
  return {red_green.v[0], red_green.v[1], blue.v[0]};
}

LinearRgb sum_over_film(const ObserverSamples& light) {
  return weighted_sum(light, film_weight_lanes);
}

ObserverSamples samples_of(const Spectrum& light, double shift) {
  ObserverSamples nm, values;
  for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = shift * (cie::first_nm + static_cast<double>(i));
  light.evaluate(nm.data(), cie::sample_count, values.data());
  return values;
}

// (λ w)' by the neighbours.
constexpr WeightLanes make_moment_slopes() {
  WeightLanes slopes;
  for (std::size_t i = 1; i + 1 < cie::sample_count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double nm = cie::first_nm + static_cast<double>(i);
      slopes.of[i][c] =
          0.5 * ((nm + 1.0) * rec709::film_weights[i + 1][c] - (nm - 1.0) * rec709::film_weights[i - 1][c]);
    }
  }
  return slopes;
}

// d/ds Σ w(λ) S(sλ) = -1/s Σ (λ w)' S(sλ), whatever teeth S has.
LinearRgb film_slope(const ObserverSamples& light, double shift) {
  static constexpr WeightLanes moment_slopes = make_moment_slopes();
  return weighted_sum(light, moment_slopes) * (-1.0 / shift);
}

template <class T>
T hermite(const T& low, const T& low_slope, const T& high, const T& high_slope, double t) {
  const double u = 1.0 - t;
  return u * u * (1.0 + 2.0 * t) * low + t * t * (3.0 - 2.0 * t) * high +
         t * u * (u * low_slope - t * high_slope);
}

LinearRgb weighted(const LightRows::Row& row, const double* a, const double* b,
                   const SpectralKernels& kernels) {
  double colour[3];
  kernels.film({row.red.data(), row.green.data(), row.blue.data()}, a, b, static_cast<int>(row.red.size()),
               colour);
  return {colour[0], colour[1], colour[2]};
}

}  // namespace

LinearRgb LightRows::Place::film() const {
  return scale * hermite(low->film, step * low->film_slope, high->film, step * high->film_slope, fraction);
}

LinearRgb LightRows::Place::film(const double* reflectance, const double* second,
                                 const SpectralKernels& kernels) const {
  if (fraction == 0.0) return scale * weighted(*low, reflectance, second, kernels);
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < around.size(); ++i) {
    sum += share[i] * weighted(*around[i], reflectance, second, kernels);
  }
  return scale * sum;
}

LinearRgb LightRows::Place::left_out(double nm) const {
  const auto cell =
      std::min(static_cast<std::size_t>(nm - cie::first_nm), std::size_t{cie::sample_count - 2});
  const double along = nm - (cie::first_nm + static_cast<double>(cell));
  const auto of = [&](const Row& row) {
    const float* at = &row.left_out[3 * cell];
    const LinearRgb before{at[0], at[1], at[2]}, after{at[3], at[4], at[5]};
    return before + along * (after - before);
  };
  const LinearRgb before = of(*low);
  return scale * (before + fraction * (of(*high) - before));
}

LightRows::LightRows(std::vector<double> nm)
    : spline_(std::make_unique<const SplineWeights>(std::move(nm))),
      daylight_(shifts.rows()),
      bodies_(temperatures.rows()) {}

LightRows::~LightRows() {
  for (Rows* rows : {&daylight_, &bodies_}) {
    for (std::atomic<const Row*>& row : *rows) delete row.load(std::memory_order_relaxed);
  }
}

std::optional<LightRows::Place> LightRows::at(const Spectrum& light, double shift) const {
  const SpectrumForm& form = light.form();
  const double shift2 = shift * shift;
  const double fifth_power = shift2 * shift2 * shift;
  if (form.kind == SpectrumForm::Kind::blackbody) {
    return body(form.c0 * shift, form.c1, form.scale / fifth_power);
  }
  if (form.kind != SpectrumForm::Kind::d65 && form.kind != SpectrumForm::Kind::illuminant) return {};
  if (shifts.has(shift)) return daylight(shift, form.scale);
  const double joint = shift < 1.0 ? form.below : form.above;
  return body(planck::d65_kelvin * shift, 0.0, form.scale * joint / fifth_power);
}

template <class Make>
const LightRows::Row& LightRows::row(Rows& rows, std::size_t index, const Make& make) const {
  std::atomic<const Row*>& place = rows[index];
  if (const Row* made = place.load(std::memory_order_acquire)) return *made;
  // Two threads may make the same row; the one that comes second takes the first's.
  auto row = std::make_unique<const Row>(make());
  const Row* first = nullptr;
  if (place.compare_exchange_strong(first, row.get(), std::memory_order_acq_rel)) return *row.release();
  return *first;
}

// `scale` is 1.
template <class Range, class Make>
LightRows::Place LightRows::between(Rows& rows, const Range& range, double x, const Make& make) const {
  const std::size_t index = range.index(x);
  const double low = range.at(index);
  Place place{};
  place.step = range.at(index + 1) - low;
  place.fraction = (x - low) / place.step;
  place.scale = 1.0;
  const std::size_t first = std::min(index == 0 ? 0 : index - 1, range.rows() - place.around.size());
  double at[4];
  for (std::size_t i = 0; i < 4; ++i) {
    at[i] = range.at(first + i);
    place.around[i] = &row(rows, first + i, [&] { return make(at[i]); });
  }
  for (std::size_t i = 0; i < 4; ++i) {
    double above = 1.0, below = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k == i) continue;
      above *= x - at[k];
      below *= at[i] - at[k];
    }
    place.share[i] = above / below;
  }
  place.low = place.around[index - first];
  place.high = place.around[index - first + 1];
  return place;
}

LightRows::Place LightRows::daylight(double shift, double scale) const {
  Place place = between(daylight_, shifts, shift, [this](double s) { return make_daylight(s); });
  place.scale = scale;
  return place;
}

LightRows::Place LightRows::body(double kelvin, double log_divisor, double scale) const {
  static thread_local Row own;
  Place place{&own, &own, 0.0, 0.0, 1.0, {}, {}};
  if (temperatures.has(kelvin)) {
    place = between(bodies_, temperatures, kelvin, [this](double t) { return make_body(t); });
  } else {
    own = make_body(kelvin);
  }
  const double log_scale = hermite(place.low->log_scale, place.step * place.low->log_slope,
                                   place.high->log_scale, place.step * place.high->log_slope, place.fraction);
  place.scale = scale * exponential_of(std::min(log_scale - log_divisor, greatest_log));
  return place;
}

LightRows::Row LightRows::make_daylight(double shift) const {
  const ObserverSamples light = samples_of(Spectrum::d65(), shift);
  Row row;
  row.film = sum_over_film(light);
  row.film_slope = film_slope(light, shift);
  fill_weights(light, row);
  return row;
}

LightRows::Row LightRows::make_body(double kelvin) const {
  // Relative to the Boltzmann factor at 830 nm, so that none vanishes, however cold the body is.
  const double reference = planck::second_constant_nm_kelvin / (cie::last_nm * kelvin);
  ObserverSamples light = samples_of(Spectrum::planckian(kelvin, -reference), 1.0);
  // d ln B / d ln T = x / (1 - exp(-x)), x = c2/(λT)
  ObserverSamples growth;
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const double x = planck::second_constant_nm_kelvin / ((cie::first_nm + static_cast<double>(i)) * kelvin);
    growth[i] = light[i] * (x / exponential(Lanes<2>(-x)).complement().v[0]);
  }
  const LinearRgb film = sum_over_film(light), slope = sum_over_film(growth) / kelvin;
  const double y = luminance(film), y_slope = luminance(slope);
  Row row;
  row.log_scale = logarithm_of(y) - reference;
  row.log_slope = y_slope / y;
  row.film = film / y;
  row.film_slope = slope / y - row.film * row.log_slope;
  for (double& value : light) value /= y;
  fill_weights(light, row);
  return row;
}

void LightRows::fill_weights(const ObserverSamples& light, Row& row) const {
  FilmWeights weights = spline_->under(light);
  row.left_out = spline_->left_out(light, weights);
  row.red = std::move(weights.red);
  row.green = std::move(weights.green);
  row.blue = std::move(weights.blue);
}

}  // namespace backlight
