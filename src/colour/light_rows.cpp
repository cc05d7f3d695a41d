#include "backlight/colour/light_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "backlight/base/lane_exponential.h"
#include "backlight/base/thread_memory.h"
#include "backlight/colour/spectrum.h"
#include "light_kernels.h"
#include "light_samples.h"
#include "planck.h"
#include "room.h"
#include "spline_weights.h"

namespace backlight {
namespace {

double exponential_of(double x) {
  return exponential(Lanes<2>(x)).value().v[0];
}

// The first 16 bits of a float, rounded, and what they say.
std::uint16_t half(float number) {
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(number) + 0x8000U) >> 16);
}

float whole(std::uint16_t half) {
  return std::bit_cast<float>(std::uint32_t{half} << 16);
}

// Between which two of a table.
LightRows::Place place_in(const RowRange& range, LightRows::Family family, double x,
                          const LightRows::Row* rows) {
  const std::size_t index = range.index(x);
  const double low = range.at(index), high = range.at(index + 1), step = high - low;
  return {family, rows + index, rows + index + 1, (x - low) / step, step, 1.0, x};
}

}  // namespace

LinearRgb LightRows::Place::film() const {
  return scale * hermite(low->film, step * low->film_slope, high->film, step * high->film_slope, fraction);
}

LinearRgb LightRows::Weighting::film(const double* reflectance, const double* second,
                                     const SpectralKernels& kernels) const {
  const double* weights[4][3];
  for (std::size_t i = 0; i < around.size(); ++i) {
    std::copy_n(around[i].of, 3, weights[i]);
  }
  double colour[3];
  kernels.film_between(weights, share.data(), reflectance, second, static_cast<int>(rows->nm_.size()),
                       colour);
  return {colour[0], colour[1], colour[2]};
}

LinearRgb LightRows::Weighting::left_out(double nm) const {
  const auto cell =
      std::min(static_cast<std::size_t>(nm - cie::first_nm), std::size_t{cie::sample_count - 2});
  const double along = nm - (cie::first_nm + static_cast<double>(cell));
  const auto interpolated = [&](const Weights& row) {
    const std::uint16_t* const at = row.left_out + 3 * cell;
    const LinearRgb before{whole(at[0]), whole(at[1]), whole(at[2])};
    const LinearRgb after{whole(at[3]), whole(at[4]), whole(at[5])};
    return before + along * (after - before);
  };
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < around.size(); ++i) sum += share[i] * interpolated(around[i]);
  // It bends where a wavelength of the set is, too.
  for (std::size_t m = rows->beyond_[cell]; m < rows->beyond_[cell + 1]; ++m) {
    const double place = rows->nm_[m] - (cie::first_nm + static_cast<double>(cell));
    const double bend = std::min(along * (1.0 - place), place * (1.0 - along));
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Weights& row = around[i];
      sum += bend * share[i] * LinearRgb{row.of[0][m], row.of[1][m], row.of[2][m]};
    }
  }
  return sum;
}

// Room that is not written to is not taken from the system.
LightRows::Shelf::Shelf(std::size_t rows, std::size_t wavelengths)
    : there(rows),
      weights(std::make_unique_for_overwrite<double[]>(rows * 3 * wavelengths)),
      left_out(std::make_unique_for_overwrite<std::uint16_t[]>(rows * left_out_count)) {}

LightRows::LightRows(std::vector<double> nm)
    : nm_(std::move(nm)),
      spline_(std::make_unique<const SplineWeights>(nm_)),
      daylight_(shifts.rows(), nm_.size()),
      bodies_(cold.rows() + hot.rows(), nm_.size()) {
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const auto beyond = std::upper_bound(nm_.begin(), nm_.end(), cie::first_nm + static_cast<double>(i));
    beyond_.push_back(static_cast<std::size_t>(beyond - nm_.begin()));
  }
}

LightRows::~LightRows() = default;

std::optional<LightRows::Place> LightRows::at(const Spectrum& light, double shift) const {
  const SpectrumForm& form = light.form();
  const double shift2 = shift * shift;
  const double fifth_power = shift2 * shift2 * shift;
  if (form.kind == SpectrumForm::Kind::blackbody) {
    return body(form.c0 * shift, form.c1, form.scale / fifth_power);
  }
  if (form.kind != SpectrumForm::Kind::d65 && form.kind != SpectrumForm::Kind::illuminant) return {};
  if (shifts.has(shift)) {
    Place place = place_in(shifts, Family::daylight, shift, daylight_row_table);
    place.scale = form.scale;
    return place;
  }
  const double joint = shift < 1.0 ? form.below : form.above;
  return body(planck::d65_kelvin * shift, 0.0, form.scale * joint / fifth_power);
}

namespace {

// Of its scale 1.
LightRows::Place place_of_body(double kelvin) {
  if (temperatures.has(kelvin))
    return place_in(temperatures, LightRows::Family::bodies, kelvin, body_row_table);
  static constinit thread_local ThreadMemory<LightRows::Row> memory;
  LightRows::Row& own = memory.get();
  own = body_row(kelvin);
  return {LightRows::Family::alone, &own, &own, 0.0, 0.0, 1.0, kelvin};
}

// By which power of e its light has been divided.
double log_scale_of(const LightRows::Place& place) {
  return hermite(place.low->log_scale, place.step * place.low->log_slope, place.high->log_scale,
                 place.step * place.high->log_slope, place.fraction);
}

}  // namespace

Spectrum LightRows::blackbody(double kelvin) {
  const Place place = place_of_body(std::max(kelvin, planck::coldest_kelvin));
  return Spectrum::planckian(kelvin, log_scale_of(place) + std::log(luminance(place.film())));
}

std::uint64_t LightRows::films(const Spectrum& light, const double* shift, std::uint64_t points,
                               double* const (&film)[4], const SpectralKernels& kernels) {
  return kernels.films(light.form(), daylight_row_table, body_row_table, shift, points, film);
}

LightRows::Place LightRows::body(double kelvin, double log_divisor, double scale) const {
  Place place = place_of_body(kelvin);
  place.scale = scale * exponential_of(std::min(log_scale_of(place) - log_divisor, greatest_log));
  return place;
}

LightRows::Weighting LightRows::weighting(const Place& place) const {
  if (place.family == Family::alone) {
    const Weights own = make_weights(normalised_body(place.at));
    return {this, {own, own, own, own}, {1.0, 0.0, 0.0, 0.0}};
  }
  const bool daylight = place.family == Family::daylight;
  const RowRange& range = daylight ? shifts : is_hot(place.at) ? hot : cold;
  const std::size_t before = !daylight && is_hot(place.at) ? cold.rows() : 0;
  const std::size_t index = range.index(place.at);
  const std::size_t first = std::min(index == 0 ? 0 : index - 1, range.rows() - 4);
  Weighting weighting{this, {}, {}};
  double at[4];
  for (std::size_t i = 0; i < 4; ++i) {
    at[i] = range.at(first + i);
    weighting.around[i] = weights_of(place.family, before + first + i);
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

LightRows::Weights LightRows::weights_of(Family family, std::size_t index) const {
  Shelf& shelf = family == Family::daylight ? daylight_ : bodies_;
  const std::size_t n = nm_.size();
  double* const first = &shelf.weights[index * 3 * n];
  std::uint16_t* const left_out = &shelf.left_out[index * left_out_count];
  if (!shelf.there[index].load(std::memory_order_acquire)) {
    // Two threads may make the same: the one that comes first puts it there.
    const Weights own = make_weights(family == Family::daylight ? daylight_at(shifts.at(index))
                                     : index < cold.rows()      ? normalised_body(cold.at(index))
                                                           : normalised_body(hot.at(index - cold.rows())));
    const std::lock_guard lock(shelf.filling);
    if (!shelf.there[index].load(std::memory_order_relaxed)) {
      // A scene that asks for one row asks for its neighbours.
      constexpr std::size_t together = 16;
      const std::size_t begin = index - index % together;
      const std::size_t count = std::min(together, shelf.there.size() - begin);
      if (std::ranges::none_of(std::span(shelf.there).subspan(begin, count),
                               [](const auto& one) { return one.load(std::memory_order_relaxed); })) {
        take_room(std::span(&shelf.weights[begin * 3 * n], count * 3 * n));
        take_room(std::span(&shelf.left_out[begin * left_out_count], count * left_out_count));
      }
      for (std::size_t c = 0; c < 3; ++c) std::copy_n(own.of[c], n, first + c * n);
      std::copy_n(own.left_out, left_out_count, left_out);
      shelf.there[index].store(true, std::memory_order_release);
    }
  }
  return {{first, first + n, first + 2 * n}, left_out};
}

LightRows::Weights LightRows::of_white() const {
  return weights_of(Family::daylight, shifts.index(1.0));
}

// Good until the next are made in the same thread.
LightRows::Weights LightRows::make_weights(const ObserverSamples& light) const {
  static constinit thread_local ThreadMemory<std::vector<double>> weights_memory;
  static constinit thread_local ThreadMemory<std::vector<float>> floats_memory;
  static constinit thread_local ThreadMemory<std::vector<std::uint16_t>> left_out_memory;
  std::vector<double>& weights = weights_memory.get();
  std::vector<float>& floats = floats_memory.get(left_out_count);
  std::vector<std::uint16_t>& left_out = left_out_memory.get(left_out_count);
  const std::size_t n = nm_.size();
  if (weights.size() < 3 * n) weights.resize(3 * n);
  double* const of[3] = {weights.data(), weights.data() + n, weights.data() + 2 * n};
  spline_->fill(light, of, floats.data());
  std::ranges::transform(floats, left_out.begin(), half);
  return {{of[0], of[1], of[2]}, left_out.data()};
}

}  // namespace backlight
