// The tape along lines in the arithmetic of polynomials, for tapes that are made of + - * and powers. A
// template over the width of the lanes; runs while rounding to nearest.
//
// A register holds the coefficients of Σ cₖ εᵏ and an error: the true coefficients differ from these by no
// more than the error, all differences added up. Norms are sums of magnitudes: |AB| <= |A||B|, so that
// products need nothing else (docs/implicit.md). One operation rounded to nearest is off by 2⁻⁵³ of its
// result at most, or by less than `least_number`.
#pragma once

#include "backlight/expression/line_polynomials.h"
#include "lane_numbers.h"

namespace backlight {

template <class V>
class PolynomialKernel {
 public:
  static void run(const LineWork& work, LinePolynomials& found) {
    const int degree = work.steps[work.step_count - 1].degree;
    found.degree = degree;
    for (std::size_t k = 0; k < work.stride; k += V::width) {
      PolynomialKernel kernel(work, k);
      for (std::size_t i = 0; i < work.step_count; ++i) kernel.take(work.steps[i]);
      const double* const result = work.registers;
      for (int c = 0; c <= degree; ++c) at(result, c).store(found.coefficient[c] + k);
      // The room is for the rounding of the errors themselves: sums and products of positive numbers.
      (at(result, error_of) * V(1.0 + 0x1p-30) + V(least_number)).store(found.error + k);
      kernel.half_.store(found.half + k);
    }
  }

 private:
  static constexpr int most = LinePolynomials::most_degree;
  static constexpr int error_of = most + 1;
  static constexpr std::size_t components = most + 2;
  static constexpr double least_number = 0x1p-1000;
  static constexpr double unit = 0x1p-53;

  BACKLIGHT_LANES PolynomialKernel(const LineWork& work, std::size_t k) : work_(work), k_(k) {
    from_ = V::load(work.from + k);
    // No shorter than the piece, whatever was rounded.
    half_ = V(0.5 + 0x1p-50) * (V::load(work.to + k) - from_);
  }

  static BACKLIGHT_LANES V at(const double* form, int component) {
    return V::load(form + static_cast<std::size_t>(component) * V::width);
  }
  [[nodiscard]] BACKLIGHT_LANES double* form(std::uint32_t index) const {
    return work_.registers + index * components * V::width;
  }
  static BACKLIGHT_LANES void put(double* form, int component, V value) {
    value.store(form + static_cast<std::size_t>(component) * V::width);
  }

  static BACKLIGHT_LANES V norm(const double* a, int degree) {
    V sum = magnitude(at(a, 0));
    for (int i = 1; i <= degree; ++i) sum = sum + magnitude(at(a, i));
    return sum;
  }

  BACKLIGHT_LANES void take(const LineProgram::Step& step) {
    double* const out = form(step.out);
    const double* const a = form(step.a);
    const double* const b = form(step.b);
    const int p = step.degree_a;
    const int q = step.degree_b;
    switch (step.operation) {
      case Operation::constant:
        put(out, 0, V(work_.constants[step.a]));
        put(out, error_of, V(0.0));
        return;
      case Operation::variable:
        return variable(step.a, out);
      case Operation::negate:
        for (int i = 0; i <= p; ++i) put(out, i, -at(a, i));
        put(out, error_of, at(a, error_of));
        return;
      case Operation::add:
        return step.constant_b   ? shift(a, p, at(b, 0), out)
               : step.constant_a ? shift(b, q, at(a, 0), out)
                                 : add(a, p, b, q, out);
      case Operation::subtract:
        return step.constant_b ? shift(a, p, -at(b, 0), out) : subtract(a, p, b, q, out);
      case Operation::multiply:
        return step.constant_b   ? scale(a, p, at(b, 0), out)
               : step.constant_a ? scale(b, q, at(a, 0), out)
                                 : multiply(a, p, b, q, out);
      case Operation::divide:
        return divide(a, p, at(b, 0), out);
      case Operation::square:
        return square(a, p, out);
      default:
        return power(a, p, static_cast<unsigned>(b[0]), out);
    }
  }

  /// The true place is origin + (from + half) direction + half direction ε. Two roundings of it by which
  /// from + half (1 + ε) is computed are allowed for, too: by |from + half| + 5 half.
  BACKLIGHT_LANES void variable(std::uint32_t index, double* out) {
    const V origin = V::load(work_.origin[index] + k_);
    const V direction = V::load(work_.direction[index] + k_);
    const V along = (from_ + half_) * direction;
    const V centre = origin + along;
    const V slope = half_ * direction;
    put(out, 0, centre);
    put(out, 1, slope);
    put(out, error_of,
        V(unit) * ((V(3.0) * magnitude(along) + magnitude(centre)) + V(6.0) * magnitude(slope)) +
            V(least_number));
  }

  static BACKLIGHT_LANES void shift(const double* a, int p, V by, double* out) {
    const V error = at(a, error_of);
    const V centre = at(a, 0) + by;
    for (int i = 1; i <= p; ++i) put(out, i, at(a, i));
    put(out, 0, centre);
    put(out, error_of, error + V(unit) * magnitude(centre));
  }

  static BACKLIGHT_LANES void scale(const double* a, int p, V by, double* out) {
    const V error = at(a, error_of) * magnitude(by);
    V size(0.0);
    for (int i = 0; i <= p; ++i) {
      const V c = at(a, i) * by;
      size = size + magnitude(c);
      put(out, i, c);
    }
    put(out, error_of, (error + V(unit) * size) + V(least_number));
  }

  static BACKLIGHT_LANES void divide(const double* a, int p, V by, double* out) {
    const V error = at(a, error_of) / magnitude(by);
    V size(0.0);
    for (int i = 0; i <= p; ++i) {
      const V c = at(a, i) / by;
      size = size + magnitude(c);
      put(out, i, c);
    }
    put(out, error_of, (error + V(unit) * size) + V(least_number));
  }

  static BACKLIGHT_LANES void add(const double* a, int p, const double* b, int q, double* out) {
    const V error = at(a, error_of) + at(b, error_of);
    const int both = p < q ? p : q;
    V size(0.0);
    for (int i = 0; i <= both; ++i) {
      const V c = at(a, i) + at(b, i);
      size = size + magnitude(c);
      put(out, i, c);
    }
    for (int i = both + 1; i <= p; ++i) put(out, i, at(a, i));
    for (int i = both + 1; i <= q; ++i) put(out, i, at(b, i));
    put(out, error_of, error + V(unit) * size);
  }

  static BACKLIGHT_LANES void subtract(const double* a, int p, const double* b, int q, double* out) {
    const V error = at(a, error_of) + at(b, error_of);
    const int both = p < q ? p : q;
    V size(0.0);
    for (int i = 0; i <= both; ++i) {
      const V c = at(a, i) - at(b, i);
      size = size + magnitude(c);
      put(out, i, c);
    }
    for (int i = both + 1; i <= p; ++i) put(out, i, at(a, i));
    for (int i = both + 1; i <= q; ++i) put(out, i, -at(b, i));
    put(out, error_of, error + V(unit) * size);
  }

  /// A coefficient is a sum of no more than seven products (degree 12): off by less than 8·2⁻⁵³ of the
  /// magnitudes' sum.
  static BACKLIGHT_LANES V product_error(V size_a, V error_a, V size_b, V error_b) {
    return (size_a * (error_b + V(8.0 * unit) * size_b) + error_a * (size_b + error_b)) + V(least_number);
  }

  static BACKLIGHT_LANES void multiply(const double* a, int p, const double* b, int q, double* out) {
    const V error = product_error(norm(a, p), at(a, error_of), norm(b, q), at(b, error_of));
    V c[most + 1];
    for (int k = 0; k <= p + q; ++k) {
      const int first = k > q ? k - q : 0;
      const int last = k < p ? k : p;
      V sum = at(a, first) * at(b, k - first);
      for (int i = first + 1; i <= last; ++i) sum = sum + at(a, i) * at(b, k - i);
      c[k] = sum;
    }
    for (int k = 0; k <= p + q; ++k) put(out, k, c[k]);
    put(out, error_of, error);
  }

  static BACKLIGHT_LANES void square(const double* a, int p, double* out) {
    const V size = norm(a, p);
    const V its = at(a, error_of);
    const V error = product_error(size, its, size, its);
    V c[most + 1];
    for (int k = 0; k <= 2 * p; ++k) {
      const int first = k > p ? k - p : 0;
      V sum(0.0);
      for (int i = first; 2 * i < k; ++i) sum = sum + at(a, i) * at(a, k - i);
      sum = sum + sum;
      if (k % 2 == 0) sum = sum + at(a, k / 2) * at(a, k / 2);
      c[k] = sum;
    }
    for (int k = 0; k <= 2 * p; ++k) put(out, k, c[k]);
    put(out, error_of, error);
  }

  /// The powers are multiplied up in a place of their own, behind all registers.
  BACKLIGHT_LANES void power(const double* a, int p, unsigned n, double* out) {
    double* const result = form(work_.register_count);
    double* const base = form(work_.register_count + 1);
    for (int i = 0; i <= p; ++i) {
      put(base, i, at(a, i));
      put(result, i, at(a, i));
    }
    put(base, error_of, at(a, error_of));
    put(result, error_of, at(a, error_of));
    int degree = p;
    unsigned bit = 1;
    while (bit <= n / 2) bit *= 2;
    for (bit /= 2; bit != 0; bit /= 2) {
      square(result, degree, result);
      degree *= 2;
      if ((n & bit) == 0) continue;
      multiply(result, degree, base, p, result);
      degree += p;
    }
    for (int i = 0; i <= degree; ++i) put(out, i, at(result, i));
    put(out, error_of, at(result, error_of));
  }

  const LineWork& work_;
  const std::size_t k_;
  V from_, half_;
};

}  // namespace backlight
