// Paths that are straight but for waves, circles among them: where they lead, and bounds for all times.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/expression/expression.h"

namespace backlight {

/// A path as plain numbers, for lanes of times (src/surface/lane_path.h).
struct LanePath {
  struct Turn {
    double rate;
    double cosine[3], sine[3];
  };
  double start[3]{}, velocity[3]{};
  const Turn* turns = nullptr;
  int count = 0;
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;  ///< at no time more
  double doubt = 0.0, doubt_rate = 0.0;                ///< WavePath::doubt()
};

/// start + velocity t + Σ (cosine cos(rate t) + sine sin(rate t)): each of the sum goes along an ellipse.
/// Docs/physics.md equation (28a).
class WavePath {
 public:
  /// Of formulas of x, y, z and t, t in units of which `per_time` go by in one of the path's times. Nothing
  /// where they are not such sums of t alone.
  static std::optional<WavePath> of(const std::array<Expression, 3>& formulas, double per_time);

  /// Through the origin at time 0.
  static WavePath straight(const Vec3& velocity);

  struct Motion {
    Vec3 place;
    Vec3 velocity;
  };
  [[nodiscard]] Motion at(double time) const;

  /// How far what at() and the formulas say may be apart for their rounding.
  [[nodiscard]] double doubt(double time) const {
    return numbers_.doubt + numbers_.doubt_rate * std::abs(time);
  }

  // At no time more.
  [[nodiscard]] double most_speed() const { return numbers_.speed; }
  [[nodiscard]] double most_acceleration() const { return numbers_.acceleration; }
  /// How far from start() + velocity() t it goes along each axis.
  [[nodiscard]] const Vec3& farthest() const { return farthest_; }

  [[nodiscard]] bool is_straight() const { return turns_.empty(); }
  [[nodiscard]] bool is_still() const { return turns_.empty() && velocity() == Vec3{0.0}; }
  [[nodiscard]] Vec3 start() const { return {numbers_.start[0], numbers_.start[1], numbers_.start[2]}; }
  [[nodiscard]] Vec3 velocity() const {
    return {numbers_.velocity[0], numbers_.velocity[1], numbers_.velocity[2]};
  }

  /// Good for as long as this path is neither moved nor destroyed.
  [[nodiscard]] LanePath lanes() const;

 private:
  void find_bounds();

  LanePath numbers_;  ///< but for the turns
  std::vector<LanePath::Turn> turns_;
  Vec3 farthest_{0.0};
};

}  // namespace backlight
