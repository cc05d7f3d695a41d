// One number with the interface of the lanes (base/lanes.h), so that what is written for lanes is the law for
// numbers too.
#pragma once

#include <cmath>

#include "backlight/base/lanes.h"

namespace backlight {

struct SingleMask {
  bool v;

  friend SingleMask operator&(SingleMask a, SingleMask b) { return {a.v && b.v}; }
  friend SingleMask operator|(SingleMask a, SingleMask b) { return {a.v || b.v}; }
  friend SingleMask operator~(SingleMask a) { return {!a.v}; }
};

struct SingleLane {
  static constexpr int width = 1;
  using Mask = SingleMask;
  double v[1];

  SingleLane() = default;
  SingleLane(double number) : v{number} {}  // NOLINT: as a number is in lanes

  static SingleLane load(const double* from) { return {*from}; }
  void store(double* to) const { *to = v[0]; }
  [[nodiscard]] double number() const { return v[0]; }

  friend SingleLane operator+(SingleLane a, SingleLane b) { return {a.v[0] + b.v[0]}; }
  friend SingleLane operator-(SingleLane a, SingleLane b) { return {a.v[0] - b.v[0]}; }
  friend SingleLane operator*(SingleLane a, SingleLane b) { return {a.v[0] * b.v[0]}; }
  friend SingleLane operator/(SingleLane a, SingleLane b) { return {a.v[0] / b.v[0]}; }
  friend SingleLane operator-(SingleLane a) { return {-a.v[0]}; }
  friend SingleMask operator<(SingleLane a, SingleLane b) { return {a.v[0] < b.v[0]}; }
  friend SingleMask operator<=(SingleLane a, SingleLane b) { return {a.v[0] <= b.v[0]}; }
  friend SingleMask operator>(SingleLane a, SingleLane b) { return {a.v[0] > b.v[0]}; }
  friend SingleMask operator>=(SingleLane a, SingleLane b) { return {a.v[0] >= b.v[0]}; }
  friend SingleMask operator==(SingleLane a, SingleLane b) { return {a.v[0] == b.v[0]}; }
};

inline SingleLane select(SingleMask mask, SingleLane a, SingleLane b) {
  return mask.v ? a : b;
}
inline unsigned bits(SingleMask mask) {
  return mask.v ? 1U : 0U;
}
inline SingleLane sqrt(SingleLane a) {
  return {std::sqrt(a.v[0])};
}

}  // namespace backlight
