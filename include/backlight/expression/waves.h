// Formulas of one variable that are sums of waves: of them more is known than intervals can tell.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "backlight/expression/expression.h"

namespace backlight {

/// constant + slope v + Σ (cosine cos(rate v) + sine sin(rate v)), each rate > 0 and once.
struct WaveSum {
  struct Wave {
    double rate;
    double cosine, sine;
  };
  double constant = 0.0;
  double slope = 0.0;
  std::vector<Wave> waves;
  /// Rounding makes sum and formula differ by no more than this for |v|; what both are made from is so large
  /// at v = 0, and grows so fast.
  [[nodiscard]] double doubt(double v) const { return 32.0 * 0x1p-52 * (size + growth * v); }
  double size = 0.0;
  double growth = 0.0;
};

/// The formula as a sum of waves of the variable of this index. Nothing where it uses another variable, or is
/// not written as sums and multiples of constants, the variable, and sines and cosines of such sums that are
/// straight.
std::optional<WaveSum> wave_sum(const Expression& formula, std::size_t variable);

/// A time after which the rates of change of all formulas by the variable of this index are what they were,
/// whatever the other variables; nothing where none is known. Of formulas that depend on it by sines and
/// cosines of straight arguments, and by what is added in proportion to it.
std::optional<double> period_of_rates(std::span<const Expression> formulas, std::size_t variable);

}  // namespace backlight
