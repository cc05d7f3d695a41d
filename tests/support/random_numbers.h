// Numbers of tests that are as good as random, and the same on every machine.
#pragma once

#include <cmath>
#include <random>

#include "backlight/base/vector.h"

namespace backlight::test {

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  Vec3 direction() {
    const double z = between(-1.0, 1.0), angle = between(0.0, 6.283185307179586),
                 ring = std::sqrt(1.0 - z * z);
    return {ring * std::cos(angle), ring * std::sin(angle), z};
  }
  Vec3 point(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace backlight::test
