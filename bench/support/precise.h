// Numbers of 256 bits (77 digits) by MPFR, to be what others are compared with.
#pragma once

#include <mpfr.h>

namespace backlight::bench {

class Precise {
 public:
  Precise() { mpfr_init2(value_, bits); }
  Precise(double value) : Precise() { mpfr_set_d(value_, value, MPFR_RNDN); }  // NOLINT: a double is exact
  Precise(const Precise& other) : Precise() { mpfr_set(value_, other.value_, MPFR_RNDN); }
  Precise& operator=(const Precise& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~Precise() { mpfr_clear(value_); }

  explicit operator double() const { return mpfr_get_d(value_, MPFR_RNDN); }

  friend Precise operator+(const Precise& a, const Precise& b) { return made(mpfr_add, a, b); }
  friend Precise operator-(const Precise& a, const Precise& b) { return made(mpfr_sub, a, b); }
  friend Precise operator*(const Precise& a, const Precise& b) { return made(mpfr_mul, a, b); }
  friend Precise operator/(const Precise& a, const Precise& b) { return made(mpfr_div, a, b); }
  friend Precise operator-(const Precise& a) { return made(mpfr_neg, a); }
  friend Precise sqrt(const Precise& a) { return made(mpfr_sqrt, a); }
  friend Precise sin(const Precise& a) { return made(mpfr_sin, a); }
  friend Precise cos(const Precise& a) { return made(mpfr_cos, a); }
  friend Precise abs(const Precise& a) { return made(mpfr_abs, a); }
  friend bool operator<(const Precise& a, const Precise& b) { return mpfr_less_p(a.value_, b.value_) != 0; }

  /// -1, 0 or 1.
  [[nodiscard]] int sign() const { return mpfr_sgn(value_); }

 private:
  static constexpr mpfr_prec_t bits = 256;

  template <class Operation>
  static Precise made(Operation operation, const Precise& a, const Precise& b) {
    Precise result;
    operation(result.value_, a.value_, b.value_, MPFR_RNDN);
    return result;
  }
  template <class Operation>
  static Precise made(Operation operation, const Precise& a) {
    Precise result;
    operation(result.value_, a.value_, MPFR_RNDN);
    return result;
  }

  mpfr_t value_;
};

}  // namespace backlight::bench
