// Every operation of the table by itself, its exact values, and numbers at which arithmetic goes wrong.
#pragma once

#include <gtest/gtest.h>
#include <mpfr.h>

#include <vector>

#include "backlight/expression/tape.h"

namespace backlight::test {

/// An operation by itself, whether or not a text could call it.
inline Tape tape_of(Operation operation) {
  Tape tape;
  tape.registers = 2;
  tape.instructions = {{Operation::variable, 0, 0, 0}, {Operation::variable, 1, 1, 0}, {operation, 0, 0, 1}};
  return tape;
}

/// v = operation(x, y), rounded once to the precision of v.
inline void exact(mpfr_t v, Operation operation, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding) {
  switch (operation) {
    case Operation::add:
      mpfr_add(v, x, y, rounding);
      break;
    case Operation::subtract:
      mpfr_sub(v, x, y, rounding);
      break;
    case Operation::multiply:
      mpfr_mul(v, x, y, rounding);
      break;
    case Operation::divide:
      mpfr_div(v, x, y, rounding);
      break;
    case Operation::negate:
      mpfr_neg(v, x, rounding);
      break;
    case Operation::square:
      mpfr_sqr(v, x, rounding);
      break;
    case Operation::integer_power:
    case Operation::pow:
      mpfr_pow(v, x, y, rounding);
      break;
    case Operation::sin:
      mpfr_sin(v, x, rounding);
      break;
    case Operation::cos:
      mpfr_cos(v, x, rounding);
      break;
    case Operation::tan:
      mpfr_tan(v, x, rounding);
      break;
    case Operation::asin:
      mpfr_asin(v, x, rounding);
      break;
    case Operation::acos:
      mpfr_acos(v, x, rounding);
      break;
    case Operation::atan:
      mpfr_atan(v, x, rounding);
      break;
    case Operation::atan2:
      mpfr_atan2(v, x, y, rounding);
      break;
    case Operation::sinh:
      mpfr_sinh(v, x, rounding);
      break;
    case Operation::cosh:
      mpfr_cosh(v, x, rounding);
      break;
    case Operation::tanh:
      mpfr_tanh(v, x, rounding);
      break;
    case Operation::exp:
      mpfr_exp(v, x, rounding);
      break;
    case Operation::log:
      mpfr_log(v, x, rounding);
      break;
    case Operation::sqrt:
      mpfr_sqrt(v, x, rounding);
      break;
    case Operation::cbrt:
      mpfr_cbrt(v, x, rounding);
      break;
    case Operation::abs:
      mpfr_abs(v, x, rounding);
      break;
    case Operation::floor:
      mpfr_floor(v, x);
      break;
    case Operation::min:
      mpfr_min(v, x, y, rounding);
      break;
    case Operation::max:
      mpfr_max(v, x, y, rounding);
      break;
    case Operation::mod: {
      mpfr_fmod(v, x, y, rounding);
      if (mpfr_sgn(v) * mpfr_sgn(y) < 0) mpfr_add(v, v, y, rounding);
      break;
    }
    case Operation::constant:
    case Operation::variable:
      ADD_FAILURE() << "not an operation";
  }
}

/// The value at a point, right to 200 bits and then rounded down or up.
inline double exact(Operation operation, double a, double b, mpfr_rnd_t rounding) {
  mpfr_t x, y, v;
  mpfr_inits2(200, x, y, v, nullptr);
  mpfr_set_d(x, a, MPFR_RNDN);
  mpfr_set_d(y, b, MPFR_RNDN);
  exact(v, operation, x, y, rounding);
  const double result = mpfr_get_d(v, rounding);
  mpfr_clears(x, y, v, nullptr);
  return result;
}

inline const std::vector<double> nasty{0.0,
                                       -0.0,
                                       1.0,
                                       -1.0,
                                       0.5,
                                       -0.5,
                                       2.0,
                                       -3.0,
                                       1e-300,
                                       -1e-300,
                                       5e-324,
                                       1e300,
                                       -1e300,
                                       0.1,
                                       -0.7,
                                       3.0,
                                       1e-9,
                                       1.5707963267948966,
                                       3.141592653589793,
                                       -3.141592653589793,
                                       6.283185307179586,
                                       100.0,
                                       -1e5,
                                       1e10,
                                       710.0,
                                       -745.0,
                                       0.9999999999999999};

}  // namespace backlight::test
