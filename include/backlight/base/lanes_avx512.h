// Eight lanes where the machine has registers of bits: comparing eight numbers makes eight bits there. (gcc
// 12 makes eight integers of a comparison of its own vectors, and bits of those.) Part of lanes.h.
#pragma once

#include "backlight/base/lanes.h"

#if defined(__AVX512DQ__)

namespace backlight {

template <>
struct LaneMask<8> {
  using Vec = LaneRegister<8>::Integers;
  __mmask8 v;

  LaneMask() = default;
  BACKLIGHT_LANES LaneMask(__mmask8 bits) : v(bits) {}  // NOLINT: that is what it is
  /// Of integers that are all ones or all zeros.
  explicit BACKLIGHT_LANES LaneMask(Vec all) : v(_mm512_movepi64_mask((__m512i)all)) {}

  friend BACKLIGHT_LANES LaneMask operator&(LaneMask a, LaneMask b) {
    return static_cast<__mmask8>(a.v & b.v);
  }
  friend BACKLIGHT_LANES LaneMask operator|(LaneMask a, LaneMask b) {
    return static_cast<__mmask8>(a.v | b.v);
  }
  friend BACKLIGHT_LANES LaneMask operator~(LaneMask a) { return static_cast<__mmask8>(~a.v); }
};

template <>
struct Lanes<8> {
  static constexpr int width = 8;
  using Mask = LaneMask<8>;
  using Vec = LaneRegister<8>::Numbers;
  Vec v;

  Lanes() = default;
  BACKLIGHT_LANES Lanes(Vec all) : v(all) {}
  BACKLIGHT_LANES Lanes(double same) : v(same - Vec{}) {}  // NOLINT: as of any number of lanes

  static BACKLIGHT_LANES Lanes load(const double* from) { return (Vec)_mm512_loadu_pd(from); }
  BACKLIGHT_LANES void store(double* to) const { _mm512_storeu_pd(to, (__m512d)v); }

  friend BACKLIGHT_LANES Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend BACKLIGHT_LANES Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend BACKLIGHT_LANES Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a) { return -a.v; }
  friend BACKLIGHT_LANES Mask operator<(Lanes a, Lanes b) { return compared<_CMP_LT_OQ>(a, b); }
  friend BACKLIGHT_LANES Mask operator<=(Lanes a, Lanes b) { return compared<_CMP_LE_OQ>(a, b); }
  friend BACKLIGHT_LANES Mask operator>(Lanes a, Lanes b) { return compared<_CMP_GT_OQ>(a, b); }
  friend BACKLIGHT_LANES Mask operator>=(Lanes a, Lanes b) { return compared<_CMP_GE_OQ>(a, b); }
  friend BACKLIGHT_LANES Mask operator==(Lanes a, Lanes b) { return compared<_CMP_EQ_OQ>(a, b); }

 private:
  template <int how>
  static BACKLIGHT_LANES Mask compared(Lanes a, Lanes b) {
    return _mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, how);
  }
};

BACKLIGHT_LANES Lanes<8> select(LaneMask<8> mask, Lanes<8> a, Lanes<8> b) {
  return (Lanes<8>::Vec)_mm512_mask_blend_pd(mask.v, (__m512d)b.v, (__m512d)a.v);
}

BACKLIGHT_LANES unsigned bits(LaneMask<8> mask) {
  return mask.v;
}

template <>
BACKLIGHT_LANES LaneMask<8> mask_of_bits<8>(unsigned all) {
  return static_cast<__mmask8>(all);
}

}  // namespace backlight

#endif
