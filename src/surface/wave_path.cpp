#include "backlight/surface/wave_path.h"

#include <algorithm>

#include "backlight/expression/waves.h"
#include "backlight/surface/implicit.h"
#include "lane_path.h"

namespace backlight {

std::optional<WavePath> WavePath::of(const std::array<Expression, 3>& formulas, double per_time) {
  WavePath path;
  LanePath& numbers = path.numbers_;
  for (int i = 0; i < 3; ++i) {
    const auto sum = wave_sum(formulas[static_cast<std::size_t>(i)], ImplicitFormula::t);
    if (!sum) return std::nullopt;
    numbers.doubt += sum->doubt(0.0);
    numbers.doubt_rate += (sum->doubt(1.0) - sum->doubt(0.0)) * per_time;
    numbers.start[i] = sum->constant;
    numbers.velocity[i] = sum->slope * per_time;
    for (const WaveSum::Wave& wave : sum->waves) {
      const double rate = wave.rate * per_time;
      auto turn = std::ranges::find(path.turns_, rate, &LanePath::Turn::rate);
      if (turn == path.turns_.end()) turn = path.turns_.insert(turn, {rate, {}, {}});
      turn->cosine[i] = wave.cosine;
      turn->sine[i] = wave.sine;
    }
  }
  path.find_bounds();
  return path;
}

WavePath WavePath::straight(const Vec3& velocity) {
  WavePath path;
  for (int i = 0; i < 3; ++i) path.numbers_.velocity[i] = velocity[i];
  path.numbers_.doubt_rate = 0x1p-50;
  path.find_bounds();
  return path;
}

LanePath WavePath::lanes() const {
  LanePath numbers = numbers_;
  numbers.turns = turns_.data();
  numbers.count = static_cast<int>(turns_.size());
  return numbers;
}

WavePath::Motion WavePath::at(double time) const {
  return moment_of(lanes(), time);
}

void WavePath::find_bounds() {
  constexpr double room = 1.0 + 1e-14;
  numbers_.speed = glm::length(velocity()) * room + numbers_.doubt_rate;
  for (const LanePath::Turn& turn : turns_) {
    // Half the longer axis of the ellipse.
    const Vec3 cosine{turn.cosine[0], turn.cosine[1], turn.cosine[2]},
        sine{turn.sine[0], turn.sine[1], turn.sine[2]};
    const double a = glm::dot(cosine, cosine), b = glm::dot(sine, sine);
    const double longest = std::sqrt(0.5 * (a + b + std::hypot(a - b, 2.0 * glm::dot(cosine, sine))));
    const double speed = turn.rate * (longest * room + numbers_.doubt);
    numbers_.speed += speed;
    numbers_.acceleration += turn.rate * speed;
    numbers_.jerk += turn.rate * turn.rate * speed;
    farthest_ += glm::sqrt(cosine * cosine + sine * sine) * room;
  }
  farthest_ += Vec3(numbers_.doubt);
}

}  // namespace backlight
