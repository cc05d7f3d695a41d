#include "backlight/colour/light_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
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
constexpr Range shifts{111.0 / 256.0, 592.0 / 256.0, 45};
static_assert(shifts.least * cie::last_nm <= cie::first_nm && shifts.end * cie::first_nm >= cie::last_nm);

// Temperatures times shifts, in K. Beyond, a row and its weights are made for each place.
constexpr Range temperatures{64.0, 4194304.0, 44};

// Those of weights: visible light of hot bodies changes little with the temperature, and less with more.
constexpr Range cold{temperatures.least, 8192.0, 46};
constexpr Range hot{cold.end, temperatures.end, 48};

constexpr bool is_hot(double kelvin) {
  return kelvin >= hot.least;
}

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

// Each nanometre of D65's own goes to the two of the observer's samples next to where it arrives, in shares
// by its distance. At rest that is D65 itself. Its table has a joint every 5 nm; read at the observer's
// samples their shifted places would make a sum that trembles with the shift, by 1e-4.
ObserverSamples daylight_at(double shift) {
  constexpr double before = cie::first_nm - 1.0, after = cie::last_nm + 1.0;
  static const std::vector<double> own = [] {
    std::vector<double> nm(static_cast<std::size_t>(shifts.end * after) + 1), values(nm.size());
    for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = std::max(1.0, static_cast<double>(i));
    Spectrum::d65().evaluate(nm.data(), static_cast<int>(nm.size()), values.data());
    return values;
  }();
  const double per_nm = 1.0 / shift;
  double shared[cie::sample_count + 3]{};  // from 359 nm on
  const auto end = static_cast<std::size_t>(shift * after);
  for (auto i = static_cast<std::size_t>(std::ceil(shift * before)); i <= end; ++i) {
    const double place = static_cast<double>(i) * per_nm - before;
    const auto sample = static_cast<std::size_t>(place);
    const double further = place - static_cast<double>(sample);
    const double light = per_nm * own[i];
    shared[sample] += (1.0 - further) * light;
    shared[sample + 1] += further * light;
  }
  ObserverSamples values;
  std::copy_n(shared + 1, values.size(), values.begin());
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

// Two threads may make the same; the one that comes second takes the first's.
template <class T, class Make>
const T& made(std::atomic<const T*>& place, const Make& make) {
  if (const T* there = place.load(std::memory_order_acquire)) return *there;
  auto own = std::make_unique<const T>(make());
  const T* first = nullptr;
  if (place.compare_exchange_strong(first, own.get(), std::memory_order_acq_rel)) return *own.release();
  return *first;
}

// Between which two of `range`, which are made if they are not there.
template <class Rows, class Make>
LightRows::Place place_in(const Range& range, LightRows::Family family, double x, Rows& rows,
                          const Make& make) {
  const std::size_t index = range.index(x);
  const double low = range.at(index), high = range.at(index + 1), step = high - low;
  return {family,
          &made(rows[index], [&] { return make(low); }),
          &made(rows[index + 1], [&] { return make(high); }),
          (x - low) / step,
          step,
          1.0,
          x};
}

LightRows::Row daylight_row(double shift) {
  const ObserverSamples light = daylight_at(shift);
  return {0.0, 0.0, sum_over_film(light), film_slope(light, shift)};
}

// Relative to the Boltzmann factor at 830 nm, so that none vanishes, however cold the body is.
double body_reference(double kelvin) {
  return planck::second_constant_nm_kelvin / (cie::last_nm * kelvin);
}

ObserverSamples body_at(double kelvin) {
  return samples_of(Spectrum::planckian(kelvin, -body_reference(kelvin)), 1.0);
}

// Of luminance 1.
ObserverSamples normalised_body(double kelvin) {
  ObserverSamples light = body_at(kelvin);
  const double y = luminance(sum_over_film(light));
  for (double& value : light) value /= y;
  return light;
}

LightRows::Row body_row(double kelvin) {
  const ObserverSamples light = body_at(kelvin);
  // d ln B / d ln T = x / (1 - exp(-x)) = x (1 + 1 / (exp(x) - 1)), x = c2/(λT); B is λ^-5 / (exp(x) - 1)
  const double share = exponential_of(-body_reference(kelvin));
  ObserverSamples growth;
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const double nm = cie::first_nm + static_cast<double>(i);
    const double x = planck::second_constant_nm_kelvin / (nm * kelvin);
    growth[i] = light[i] * (x * (1.0 + light[i] * share * (nm * nm) * (nm * nm) * nm));
  }
  const LinearRgb film = sum_over_film(light), slope = sum_over_film(growth) / kelvin;
  const double y = luminance(film), y_slope = luminance(slope);
  LightRows::Row row;
  row.log_scale = logarithm_of(y) - body_reference(kelvin);
  row.log_slope = y_slope / y;
  row.film = film / y;
  row.film_slope = slope / y - row.film * row.log_slope;
  return row;
}

}  // namespace

LinearRgb LightRows::Place::film() const {
  return scale * hermite(low->film, step * low->film_slope, high->film, step * high->film_slope, fraction);
}

LinearRgb LightRows::Weighting::film(const double* reflectance, const double* second,
                                     const SpectralKernels& kernels) const {
  const double* weights[4][3];
  for (std::size_t i = 0; i < around.size(); ++i) {
    weights[i][0] = around[i]->red.data();
    weights[i][1] = around[i]->green.data();
    weights[i][2] = around[i]->blue.data();
  }
  double colour[3];
  kernels.film_between(weights, share.data(), reflectance, second, static_cast<int>(around[0]->red.size()),
                       colour);
  return {colour[0], colour[1], colour[2]};
}

LinearRgb LightRows::Weighting::left_out(double nm) const {
  const auto cell =
      std::min(static_cast<std::size_t>(nm - cie::first_nm), std::size_t{cie::sample_count - 2});
  const double along = nm - (cie::first_nm + static_cast<double>(cell));
  const auto interpolated = [&](const Weights& row) {
    const float* at = &row.left_out[3 * cell];
    const LinearRgb before{at[0], at[1], at[2]}, after{at[3], at[4], at[5]};
    return before + along * (after - before);
  };
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < around.size(); ++i) sum += share[i] * interpolated(*around[i]);
  // It bends where a wavelength of the set is, too.
  for (std::size_t m = rows->beyond_[cell]; m < rows->beyond_[cell + 1]; ++m) {
    const double place = rows->nm_[m] - (cie::first_nm + static_cast<double>(cell));
    const double bend = std::min(along * (1.0 - place), place * (1.0 - along));
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Weights& row = *around[i];
      sum += bend * share[i] * LinearRgb{row.red[m], row.green[m], row.blue[m]};
    }
  }
  return sum;
}

LightRows::LightRows(std::vector<double> nm)
    : nm_(std::move(nm)),
      spline_(std::make_unique<const SplineWeights>(nm_)),
      daylight_(shifts.rows(), shifts.rows()),
      bodies_(temperatures.rows(), cold.rows() + hot.rows()) {
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const auto beyond = std::upper_bound(nm_.begin(), nm_.end(), cie::first_nm + static_cast<double>(i));
    beyond_.push_back(static_cast<std::size_t>(beyond - nm_.begin()));
  }
}

LightRows::~LightRows() {
  const auto drop = [](auto& made) {
    for (auto& one : made) delete one.load(std::memory_order_relaxed);
  };
  for (Rows* rows : {&daylight_, &bodies_}) {
    drop(rows->rows);
    drop(rows->weights);
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
  if (shifts.has(shift)) {
    Place place = place_in(shifts, Family::daylight, shift, daylight_.rows, daylight_row);
    place.scale = form.scale;
    return place;
  }
  const double joint = shift < 1.0 ? form.below : form.above;
  return body(planck::d65_kelvin * shift, 0.0, form.scale * joint / fifth_power);
}

LightRows::Place LightRows::body(double kelvin, double log_divisor, double scale) const {
  static thread_local Row own;
  Place place{Family::alone, &own, &own, 0.0, 0.0, 1.0, kelvin};
  if (temperatures.has(kelvin)) {
    place = place_in(temperatures, Family::bodies, kelvin, bodies_.rows, body_row);
  } else {
    own = body_row(kelvin);
  }
  const double log_scale = hermite(place.low->log_scale, place.step * place.low->log_slope,
                                   place.high->log_scale, place.step * place.high->log_slope, place.fraction);
  place.scale = scale * exponential_of(std::min(log_scale - log_divisor, greatest_log));
  return place;
}

LightRows::Weighting LightRows::weighting(const Place& place) const {
  static thread_local Weights own;
  if (place.family == Family::alone) {
    own = make_weights(normalised_body(place.at));
    return {this, {&own, &own, &own, &own}, {1.0, 0.0, 0.0, 0.0}};
  }
  const bool daylight = place.family == Family::daylight;
  const Range& range = daylight ? shifts : is_hot(place.at) ? hot : cold;
  const std::size_t before = !daylight && is_hot(place.at) ? cold.rows() : 0;
  const std::size_t index = range.index(place.at);
  const std::size_t first = std::min(index == 0 ? 0 : index - 1, range.rows() - 4);
  Weighting weighting{this, {}, {}};
  double at[4];
  for (std::size_t i = 0; i < 4; ++i) {
    at[i] = range.at(first + i);
    weighting.around[i] = &weights_of(place.family, before + first + i);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    double above = 1.0, below = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k == i) continue;
      above *= place.at - at[k];
      below *= at[i] - at[k];
    }
    weighting.share[i] = above / below;
  }
  return weighting;
}

const LightRows::Weights& LightRows::weights_of(Family family, std::size_t index) const {
  if (family == Family::daylight) {
    return made(daylight_.weights[index], [&] { return make_weights(daylight_at(shifts.at(index))); });
  }
  return made(bodies_.weights[index], [&] {
    const double kelvin = index < cold.rows() ? cold.at(index) : hot.at(index - cold.rows());
    return make_weights(normalised_body(kelvin));
  });
}

const LightRows::Weights& LightRows::of_white() const {
  return weights_of(Family::daylight, shifts.index(1.0));
}

LightRows::Weights LightRows::make_weights(const ObserverSamples& light) const {
  FilmWeights weights = spline_->under(light);
  std::vector<float> left_out = spline_->left_out(light, weights);
  return {std::move(weights.red), std::move(weights.green), std::move(weights.blue), std::move(left_out)};
}

}  // namespace backlight
