// Paths that are straight but for waves, circles among them: where they lead, and bounds for all times.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/expression/expression.h"

namespace backlight {

/// start + velocity t + Σ (cosine cos(rate t) + sine sin(rate t)): each of the sum goes along an ellipse.
/// Docs/physics.md equation (28a).
class WavePath {
 public:
  /// Of formulas of x, y, z and t, t in units of which `per_time` go by in one of the path's times. Nothing
  /// where they are not such sums of t alone.
  static std::optional<WavePath> of(const std::array<Expression, 3>& formulas, double per_time);

  struct Motion {
    Vec3 place;
    Vec3 velocity;
  };
  [[nodiscard]] Motion at(double time) const;

  /// How far what at() and the formulas say may be apart for their rounding.
  [[nodiscard]] double doubt(double time) const { return doubt_ + doubt_rate_ * std::abs(time); }

  // At no time more.
  [[nodiscard]] double most_speed() const { return most_speed_; }
  [[nodiscard]] double most_acceleration() const { return most_acceleration_; }

  [[nodiscard]] bool is_straight() const { return turns_.empty(); }
  [[nodiscard]] const Vec3& start() const { return start_; }
  [[nodiscard]] const Vec3& velocity() const { return velocity_; }

 private:
  struct Turn {
    double rate;
    Vec3 cosine{0.0}, sine{0.0};
  };

  void find_bounds();

  Vec3 start_{0.0}, velocity_{0.0};
  std::vector<Turn> turns_;
  double most_speed_ = 0.0, most_acceleration_ = 0.0;
  double doubt_ = 0.0, doubt_rate_ = 0.0;
};

}  // namespace backlight
