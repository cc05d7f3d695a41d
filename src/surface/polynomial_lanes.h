// The first root of many polynomials, over lanes: a template over their number and the degree, the same bits
// for any width.
//
// A piece of the line, [a, b], is looked at in Bernstein's form: the function is between the least and the
// largest of the n+1 coefficients, the first and the last of which are its values at the ends, and has as
// many roots as their signs change, or fewer by an even number (Descartes's rule). So pieces are without a
// root, or have exactly one, or are cut (docs/implicit.md).
//
// Places are multiples of 2⁻³⁰, so that ends and middles of pieces are exact: nothing is between two pieces.
#pragma once

#include <cstdint>

#include "backlight/base/lanes.h"
#include "backlight/expression/line_polynomials.h"

namespace backlight {

/// What is asked about polynomials, and found.
struct PolynomialQuestions {
  LinePolynomials polynomials;
  /// The sign at ε = -1; 0: not known yet.
  alignas(64) double sign[LinePolynomials::most];

  static constexpr double no_root = 0.0, crossing = 1.0, undecided = 2.0;
  alignas(64) double verdict[LinePolynomials::most];
  // Of a crossing: the piece, where it is the only root, where the polynomial has its own, and there
  // |p''/2p'|: Newton's steps go on to errors of that times their square.
  alignas(64) double low[LinePolynomials::most];
  alignas(64) double high[LinePolynomials::most];
  alignas(64) double at[LinePolynomials::most];
  alignas(64) double bend[LinePolynomials::most];
  /// How many pieces were looked at.
  alignas(64) double pieces[LinePolynomials::most];
};

/// One set of kernels.
struct PolynomialKernels {
  /// Sets `sign` where the polynomial itself is certain of it, else to 0.
  void (*find_signs)(PolynomialQuestions& lines, std::size_t count);
  /// Finds the first roots; where existence is enough, only `verdict` and `pieces`.
  void (*find_roots)(PolynomialQuestions& lines, std::size_t count, bool existence_is_enough);
};

/// Coefficient j of ηᵏ on [-1, 1] in Bernstein's form of degree n: its polar form with j times 1 and n - j
/// times -1. No more than 1.
template <int n>
struct BernsteinMatrix {
  double entry[n + 1][n + 1];

  static constexpr double choose(int of, int k) {
    if (k < 0 || k > of) return 0.0;
    double result = 1.0;
    for (int i = 0; i < k; ++i) result = result * (of - i) / (i + 1);
    return result;
  }
  constexpr BernsteinMatrix() : entry{} {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) {
        double sum = 0.0;
        for (int i = 0; i <= k; ++i) {
          const double term = choose(j, i) * choose(n - j, k - i);
          sum += (k - i) % 2 == 0 ? term : -term;
        }
        entry[j][k] = sum / choose(n, k);
      }
    }
  }
};

template <class V, int n>
class PolynomialLanes {
 public:
  using Mask = typename V::Mask;

  static void find_signs(PolynomialQuestions& lines, std::size_t count) {
    for (std::size_t k = 0; k < count; k += V::width) {
      const PolynomialLanes p(lines, k);
      V even = p.c_[0];
      for (int i = 2; i <= n; i += 2) even = even + p.c_[i];
      V odd = p.c_[1];
      for (int i = 3; i <= n; i += 2) odd = odd + p.c_[i];
      const V value = even - odd;
      select(value > p.room_, V(1.0), select(value < -p.room_, V(-1.0), V(0.0))).store(lines.sign + k);
    }
  }

  static void find_roots(PolynomialQuestions& lines, std::size_t count, bool existence_is_enough) {
    for (std::size_t k = 0; k < count; k += V::width) {
      PolynomialLanes p(lines, k);
      p.search(lines, k, existence_is_enough);
    }
  }

 private:
  /// The first piece is this long, the next ones so much longer than one without a root.
  static constexpr double first_length = 1.0;
  static constexpr double growth = 1.5;
  /// What is left of a piece is cut to this.
  static constexpr double part = 0.5;
  static constexpr double shortest = 0x1p-20;
  static constexpr int most_pieces = 64;

  /// The nearest multiple of 2⁻³⁰.
  static BACKLIGHT_LANES V place(V a) {
    const V magic(0x1.8p22);
    return (a + magic) - magic;
  }

  BACKLIGHT_LANES PolynomialLanes(const PolynomialQuestions& lines, std::size_t k) {
    V size(0.0);
    for (int i = 0; i <= n; ++i) {
      c_[i] = V(0.0);
      if (i <= lines.polynomials.degree) c_[i] = V::load(lines.polynomials.coefficient[i] + k);
      size = size + magnitude(c_[i]);
    }
    // Each Bernstein coefficient is computed by 4n + 8 roundings of sums of no more than `size`.
    room_ = V::load(lines.polynomials.error + k) + V((4 * n + 10) * 0x1p-53) * size;
  }

  /// Bernstein's coefficients on [middle - half, middle + half] of the polynomial times the sign in front.
  BACKLIGHT_LANES void look_at(V middle, V half) {
    V q[n + 1];
    for (int i = 0; i <= n; ++i) q[i] = c_[i];
    for (int i = 0; i < n; ++i) {
      for (int j = n - 1; j >= i; --j) q[j] = q[j] + middle * q[j + 1];
    }
    V power = half;
    for (int i = 1; i <= n; ++i) {
      q[i] = q[i] * power;
      power = power * half;
    }
    constexpr BernsteinMatrix<n> matrix;
    for (int j = 0; 2 * j <= n; ++j) {
      V even = q[0];
      for (int i = 2; i <= n; i += 2) even = even + V(matrix.entry[j][i]) * q[i];
      V odd = V(matrix.entry[j][1]) * q[1];
      for (int i = 3; i <= n; i += 2) odd = odd + V(matrix.entry[j][i]) * q[i];
      b_[j] = even + odd;
      b_[n - j] = even - odd;
    }
    if (n % 2 == 0) b_[n / 2] = middle_coefficient(q, matrix);
  }
  static BACKLIGHT_LANES V middle_coefficient(const V (&q)[n + 1], const BernsteinMatrix<n>& matrix) {
    V even = q[0];
    for (int i = 2; i <= n; i += 2) even = even + V(matrix.entry[n / 2][i]) * q[i];
    return even;
  }

  BACKLIGHT_LANES void search(PolynomialQuestions& lines, std::size_t k, bool existence_is_enough) {
    const V sign = V::load(lines.sign + k);
    for (int i = 0; i <= n; ++i) c_[i] = c_[i] * sign;
    // A sign that is certain is certain of a room that is a number.
    Mask active = ((sign > V(0.0)) | (sign < V(0.0))) & (room_ < V(__builtin_inf()));
    V verdict(PolynomialQuestions::undecided);
    V low(0.0), high(0.0), guess(0.0), pieces(0.0);
    V begin(-1.0);
    V length(first_length);
    for (int step = 0; step < most_pieces && bits(active) != 0; ++step) {
      pieces = select(active, pieces + V(1.0), pieces);
      // At the end of the line a little more does not count.
      const V end = select(begin + V(1.25) * length < V(1.0), place(begin + length), V(1.0));
      const V width = end - begin;
      look_at(V(0.5) * (begin + end), V(0.5) * width);
      // How many coefficients from the first on are certainly positive, and how small the least is; how many
      // from the last on are certainly negative.
      Mask positive = active;
      Mask negative = active;
      V in_front(1.0), behind(0.0);
      V least = b_[0] - room_;
      for (int j = 1; j <= n; ++j) {
        positive = positive & (b_[j] > room_);
        in_front = select(positive, in_front + V(1.0), in_front);
        least = select(positive, smaller(least, b_[j] - room_), least);
      }
      for (int j = n; j >= 1; --j) {
        negative = negative & (b_[j] < -room_);
        behind = select(negative, behind + V(1.0), behind);
      }
      Mask found = (behind >= V(1.0)) & (in_front + behind >= V(double(n)));
      if (existence_is_enough) found = behind >= V(1.0);
      found = found & active;
      const Mask finished = positive & (end >= V(1.0));
      if (bits(found) != 0) {
        verdict = select(found, V(PolynomialQuestions::crossing), verdict);
        low = select(found, begin, low);
        high = select(found, end, high);
        guess = select(found, begin + width * secant(), guess);
      }
      verdict = select(finished, V(PolynomialQuestions::no_root), verdict);
      // No zero in front of where lines from a point as low as the least of those in front, down to the
      // others, come to 0.
      V steepest(0.0);
      for (int j = 1; j <= n; ++j) steepest = larger(steepest, (least - (b_[j] - room_)) * V(1.0 / j));
      const V free =
          select((least > V(0.0)) & (steepest > V(0.0)),
                 least / (V(n * (1.0 + 0x1p-40)) * select(steepest > V(0.0), steepest, V(1.0))), V(0.0));
      const V ahead = select(free > V(0x1p-20), place(begin + free * width) - V(0x1p-30), begin);
      const V cut = place(V(part) * (end - ahead));
      length = select(positive, growth * length, cut);
      begin = select(positive, end, ahead);
      active = active & ~found & ~finished & (length > V(shortest));
    }
    verdict.store(lines.verdict + k);
    pieces.store(lines.pieces + k);
    if (existence_is_enough) return;
    low.store(lines.low + k);
    high.store(lines.high + k);
    polish(low, high, guess, verdict == V(PolynomialQuestions::crossing), lines, k);
  }

  /// Where the line between the ends is zero, as a part of the piece.
  BACKLIGHT_LANES V secant() const {
    const V first = larger(b_[0], V(0.0));
    const V sum = first - b_[n];
    return first / select(sum > V(0.0), sum, V(1.0));
  }

  /// Newton's steps, with bisections wherever they leave the bracket or are not half as long as before.
  BACKLIGHT_LANES void polish(V low, V high, V at, Mask active, PolynomialQuestions& lines, std::size_t k) {
    const Mask wanted = active;
    const V unknown(__builtin_inf());
    V bend = unknown;
    V before = high - low;
    for (int step = 0; step < 60 && bits(active) != 0; ++step) {
      V value = c_[n];
      V slope(0.0);
      V half_curve(0.0);
      for (int i = n - 1; i >= 0; --i) {
        half_curve = half_curve * at + slope;
        slope = slope * at + value;
        value = value * at + c_[i];
      }
      low = select(active & (value > V(0.0)), at, low);
      high = select(active & ~(value > V(0.0)), at, high);
      const V divisor = select(slope < V(0.0), slope, V(-1.0));
      const V move = -(value / divisor);
      const V target = at + move;
      const Mask useful =
          (slope < V(0.0)) & (target >= low) & (target <= high) & (V(2.0) * magnitude(move) <= before);
      const V next = select(useful, target, V(0.5) * (low + high));
      const V moved = magnitude(next - at);
      bend = select(active, select(useful, magnitude(half_curve / divisor), unknown), bend);
      at = select(active, next, at);
      before = select(active, moved, before);
      active = active & (moved > V(0x1p-24)) & (high > low);
    }
    select(wanted, at, V(0.0)).store(lines.at + k);
    bend.store(lines.bend + k);
  }

  V c_[n + 1];
  V b_[n + 1];
  V room_;
};

/// The kernels of the least degree among some that is not below the polynomials': the coefficients above are
/// 0.
template <class V>
PolynomialKernels polynomial_kernels_of(int degree) {
  const auto of = []<int n>() -> PolynomialKernels {
    return {PolynomialLanes<V, n>::find_signs, PolynomialLanes<V, n>::find_roots};
  };
  if (degree <= 2) return of.template operator()<2>();
  if (degree <= 3) return of.template operator()<3>();
  if (degree <= 4) return of.template operator()<4>();
  if (degree <= 6) return of.template operator()<6>();
  if (degree <= 8) return of.template operator()<8>();
  return of.template operator()<12>();
}

}  // namespace backlight
