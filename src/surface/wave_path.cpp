#include "backlight/surface/wave_path.h"

#include <algorithm>
#include <cmath>

#include "backlight/expression/waves.h"
#include "backlight/surface/implicit.h"

namespace backlight {

std::optional<WavePath> WavePath::of(const std::array<Expression, 3>& formulas, double per_time) {
  WavePath path;
  for (int i = 0; i < 3; ++i) {
    const auto sum = wave_sum(formulas[static_cast<std::size_t>(i)], ImplicitFormula::t);
    if (!sum) return std::nullopt;
    path.doubt_ += sum->doubt(0.0);
    path.doubt_rate_ += (sum->doubt(1.0) - sum->doubt(0.0)) * per_time;
    path.start_[i] = sum->constant;
    path.velocity_[i] = sum->slope * per_time;
    for (const WaveSum::Wave& wave : sum->waves) {
      const double rate = wave.rate * per_time;
      auto turn = std::ranges::find(path.turns_, rate, &Turn::rate);
      if (turn == path.turns_.end()) turn = path.turns_.insert(turn, {rate});
      turn->cosine[i] = wave.cosine;
      turn->sine[i] = wave.sine;
    }
  }
  path.find_bounds();
  return path;
}

WavePath::Motion WavePath::at(double time) const {
  Motion motion{start_ + time * velocity_, velocity_};
  for (const Turn& turn : turns_) {
    const double sine = std::sin(turn.rate * time), cosine = std::cos(turn.rate * time);
    motion.place += cosine * turn.cosine + sine * turn.sine;
    motion.velocity += turn.rate * (cosine * turn.sine - sine * turn.cosine);
  }
  return motion;
}

void WavePath::find_bounds() {
  constexpr double room = 1.0 + 1e-14;
  most_speed_ = glm::length(velocity_) * room + doubt_rate_;
  most_acceleration_ = 0.0;
  for (const Turn& turn : turns_) {
    // Half the longer axis of the ellipse.
    const double a = glm::dot(turn.cosine, turn.cosine), b = glm::dot(turn.sine, turn.sine);
    const double longest =
        std::sqrt(0.5 * (a + b + std::hypot(a - b, 2.0 * glm::dot(turn.cosine, turn.sine))));
    most_speed_ += turn.rate * (longest * room + doubt_);
    most_acceleration_ += turn.rate * turn.rate * (longest * room + doubt_);
  }
}

}  // namespace backlight
