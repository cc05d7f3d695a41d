// Smooth lights at the observer's samples, and the rows of LightRows that are made from them.
#pragma once

#include <bit>
#include <cstdint>

#include "backlight/colour/light_rows.h"
#include "cie_tables.h"
#include "spline_weights.h"

namespace backlight {

/// Numbers from `least` (of a row) up to `end`. The first bits of a number's fraction, and its exponent, say
/// which row is at or below it.
struct RowRange {
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

/// Shifts at which any of D65's table is in the visible range; beyond both ends it is a blackbody there.
inline constexpr RowRange shifts{111.0 / 256.0, 592.0 / 256.0, 45};
static_assert(shifts.least * cie::last_nm <= cie::first_nm && shifts.end * cie::first_nm >= cie::last_nm);

/// Temperatures times shifts, in K. Beyond, a row and its weights are made for each place.
inline constexpr RowRange temperatures{64.0, 4194304.0, 44};

/// Those of weights: visible light of hot bodies changes little with the temperature, and less with more.
inline constexpr RowRange cold{temperatures.least, 8192.0, 46};
inline constexpr RowRange hot{cold.end, temperatures.end, 48};

constexpr bool is_hot(double kelvin) {
  return kelvin >= hot.least;
}

/// D65 at `shift` times the observer's wavelengths.
ObserverSamples daylight_at(double shift);

/// A blackbody of luminance 1.
ObserverSamples normalised_body(double kelvin);

LightRows::Row daylight_row(double shift);
LightRows::Row body_row(double kelvin);

/// The rows of all shifts, and of all temperatures. Written by generate_light_row_table.cpp.
extern const LightRows::Row daylight_row_table[shifts.rows()];
extern const LightRows::Row body_row_table[temperatures.rows()];

}  // namespace backlight
