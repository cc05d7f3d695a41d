// The tape over many lines at once, one instruction for all of them after the other. A template over the
// width of the lanes; compiled with -frounding-math.
#pragma once

#include "lane_affine.h"
#include "lane_numbers.h"
#include "line_work.h"
#include "polynomial_kernel.h"

namespace backlight {

template <class V>
BACKLIGHT_LANES void load(const double* from, std::size_t stride, LaneBounds<V>& number) {
  number.minus_lower = V::load(from);
  number.upper = V::load(from + stride);
}
template <class V>
BACKLIGHT_LANES void store(double* to, std::size_t stride, LaneBounds<V> number) {
  number.minus_lower.store(to);
  number.upper.store(to + stride);
}
template <class V>
BACKLIGHT_LANES void load(const double* from, std::size_t, LaneNumber<V>& number) {
  number.v = V::load(from);
}
template <class V>
BACKLIGHT_LANES void store(double* to, std::size_t, LaneNumber<V> number) {
  number.v.store(to);
}

template <class V>
BACKLIGHT_LANES void load(const double* from, std::size_t stride, LaneAffine<V>& number) {
  number.centre = V::load(from);
  number.slope = V::load(from + stride);
  number.error = V::load(from + 2 * stride);
}
template <class V>
BACKLIGHT_LANES void store(double* to, std::size_t stride, LaneAffine<V> number) {
  number.centre.store(to);
  number.slope.store(to + stride);
  number.error.store(to + 2 * stride);
}

template <class N>
struct Components;  ///< how many arrays one number takes
template <class V>
struct Components<LaneBounds<V>> {
  static constexpr std::size_t count = 2;
};
template <class V>
struct Components<LaneAffine<V>> {
  static constexpr std::size_t count = 3;
};
template <class V>
struct Components<LaneNumber<V>> {
  static constexpr std::size_t count = 1;
};

/// origin + s direction for s in [from, to].
template <class V>
BACKLIGHT_LANES LaneBounds<V> on_line(V origin, V direction, V from, V to, LaneBounds<V>*) {
  const V minus = -direction;
  return {larger(from * minus - origin, to * minus - origin),
          larger(from * direction + origin, to * direction + origin)};
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> on_line(V origin, V direction, V from, V, LaneNumber<V>*) {
  return LaneNumber<V>(origin + from * direction);
}
template <class V>
BACKLIGHT_LANES LaneBounds<V> exactly(V number, LaneBounds<V>*) {
  return {-number, number};
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> exactly(V number, LaneNumber<V>*) {
  return LaneNumber<V>(number);
}

/// Of min and max: the slope of the operand that is chosen, or, where that may be either, the slopes of both.
/// `first` holds 1 where `a` may be chosen and 0 where it may not be.
template <class V>
BACKLIGHT_LANES LaneBounds<V> slope_of_choice(LaneBounds<V> first, LaneBounds<V> a, LaneBounds<V> b) {
  const auto always = first.minus_lower < V(0.0);
  const auto never = first.upper == V(0.0);
  const auto of = [&](V one, V other) {
    return select(always, one, select(never, other, larger(one, other)));
  };
  return {of(a.minus_lower, b.minus_lower), of(a.upper, b.upper)};
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> slope_of_choice(LaneNumber<V> first, LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(first.v > V(0.0), a.v, b.v));
}

/// The chain rule; for the commonest operations without factors of ±1.
template <Operation operation, class N>
BACKLIGHT_LANES N chain(N a, N b, N a_slope, N b_slope, N along_a, N along_b, bool a_changes,
                        bool b_changes) {
  if constexpr (operation == Operation::min) {
    return slope_of_choice(slope_of_minimum(a, b), a_slope, b_slope);
  } else if constexpr (operation == Operation::max) {
    return slope_of_choice(slope_of_maximum(a, b), a_slope, b_slope);
  } else if constexpr (operation == Operation::negate) {
    return -a_slope;
  } else if constexpr (operation == Operation::square) {
    const N half = a * a_slope;
    return half + half;
  } else if constexpr (operation == Operation::add) {
    return a_changes ? (b_changes ? a_slope + b_slope : a_slope) : b_slope;
  } else if constexpr (operation == Operation::subtract) {
    return a_changes ? (b_changes ? a_slope - b_slope : a_slope) : -b_slope;
  } else {
    if (!b_changes) return along_a * a_slope;
    if (!a_changes) return along_b * b_slope;
    return along_a * a_slope + along_b * b_slope;
  }
}

/// Number types that have rules of their own for constant operands.
template <class N>
inline constexpr bool knows_constants = false;
template <class V>
inline constexpr bool knows_constants<LaneAffine<V>> = true;

template <class N, class V, bool with_slope>
class LineKernel {
 public:
  static void run(const LineWork& work) {
    for (std::size_t i = 0; i < work.step_count; ++i) {
      const LineProgram::Step& step = work.steps[i];
      double* const out = at(work, step.out);
      if constexpr (knows_constants<N>) {
        if ((step.constant_a || step.constant_b) && with_constant(work, step, out)) continue;
      }
      switch (step.operation) {
        case Operation::constant:
          constant(work, work.constants[step.a], out);
          break;
        case Operation::variable:
          variable(work, step.a, out);
          break;
#define BACKLIGHT_CASE(identifier, name, operands, value, da, db)                                    \
  case Operation::identifier: {                                                                      \
    const double* const in_a = at(work, step.a);                                                     \
    const double* const in_b = operands == 2 ? at(work, step.b) : in_a;                              \
    const bool changes = step.slope_a || step.slope_b;                                               \
    for (std::size_t k = 0; k < work.stride; k += V::width) {                                        \
      N a, b;                                                                                        \
      load(in_a + k, work.stride, a);                                                                \
      load(in_b + k, work.stride, b);                                                                \
      const N v = value;                                                                             \
      if constexpr (with_slope) {                                                                    \
        if (changes) {                                                                               \
          N a_slope, b_slope;                                                                        \
          load(in_a + values(work) + k, work.stride, a_slope);                                       \
          load(in_b + values(work) + k, work.stride, b_slope);                                       \
          const N along_a = step.slope_a ? N(da) : N(0.0);                                           \
          const N along_b = operands == 2 && step.slope_b ? N(db) : N(0.0);                          \
          store(out + values(work) + k, work.stride,                                                 \
                chain<Operation::identifier>(a, b, a_slope, b_slope, along_a, along_b, step.slope_a, \
                                             step.slope_b));                                         \
        } else {                                                                                     \
          store(out + values(work) + k, work.stride, N(0.0));                                        \
        }                                                                                            \
      }                                                                                              \
      store(out + k, work.stride, v);                                                                \
    }                                                                                                \
    break;                                                                                           \
  }
          BACKLIGHT_OPERATIONS(BACKLIGHT_CASE)
#undef BACKLIGHT_CASE
      }
    }
  }

 private:
  /// An operation of a constant and a form; false: there is no rule for it.
  static BACKLIGHT_LANES bool with_constant(const LineWork& work, const LineProgram::Step& step,
                                            double* out) {
    const double* const form = at(work, step.constant_b ? step.a : step.b);
    const V number(*at(work, step.constant_b ? step.b : step.a));
    const auto all = [&](const auto& rule) {
      for (std::size_t k = 0; k < work.stride; k += V::width) {
        N a;
        load(form + k, work.stride, a);
        store(out + k, work.stride, rule(a));
      }
      return true;
    };
    switch (step.operation) {
      case Operation::add:
        return all([&](N a) { return plus_constant(a, number); });
      case Operation::subtract:
        if (step.constant_b) return all([&](N a) { return plus_constant(a, -number); });
        return all([&](N a) { return plus_constant(-a, number); });
      case Operation::multiply:
        return all([&](N a) { return times_constant(a, number); });
      default:
        return false;
    }
  }

  static BACKLIGHT_LANES std::size_t values(const LineWork& work) {
    return Components<N>::count * work.stride;
  }
  static BACKLIGHT_LANES double* at(const LineWork& work, std::uint32_t index) {
    return work.registers + index * (with_slope ? 2 : 1) * values(work);
  }

  static BACKLIGHT_LANES void constant(const LineWork& work, double number, double* out) {
    for (std::size_t k = 0; k < work.stride; k += V::width) {
      store(out + k, work.stride, N(number));
      if constexpr (with_slope) store(out + values(work) + k, work.stride, N(0.0));
    }
  }

  static BACKLIGHT_LANES void variable(const LineWork& work, std::uint32_t index, double* out) {
    N* const kind = nullptr;
    for (std::size_t k = 0; k < work.stride; k += V::width) {
      const V origin = V::load(work.origin[index] + k);
      const V direction = V::load(work.direction[index] + k);
      store(out + k, work.stride,
            on_line(origin, direction, V::load(work.from + k), V::load(work.to + k), kind));
      if constexpr (with_slope) store(out + values(work) + k, work.stride, exactly(direction, kind));
    }
  }
};

/// The affine form of each piece, and where it leaves room for zeros. An empty region: first = to, last =
/// from.
template <class V>
void run_zeros(const LineWork& work) {
  LineKernel<LaneAffine<V>, V, false>::run(work);
  for (std::size_t k = 0; k < work.stride; k += V::width) {
    LaneAffine<V> form;
    load(work.registers + k, work.stride, form);
    const V from = V::load(work.from + k);
    const V to = V::load(work.to + k);
    const LaneZeros<V> zeros = zeros_of(form, from, to);
    select(zeros.none, to, zeros.first).store(work.found[0] + k);
    select(zeros.none, from, zeros.last).store(work.found[1] + k);
    zeros.sign.store(work.found[2] + k);
  }
}

template <int width>
LineKernels line_kernels() {
  using V = Lanes<width>;
  return {LineKernel<LaneBounds<V>, V, true>::run,  LineKernel<LaneBounds<V>, V, false>::run,
          LineKernel<LaneNumber<V>, V, true>::run,  run_zeros<V>,
          LineKernel<LaneAffine<V>, V, false>::run, PolynomialKernel<V>::run};
}

}  // namespace backlight
