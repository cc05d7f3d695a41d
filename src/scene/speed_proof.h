// That nothing of a body in motion reaches the speed of light: docs/physics.md equation (26).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "motion_levels.h"

namespace backlight {

/// Balls, points among them, in whose convex hull a body is, in its own coordinates.
struct HullBall {
  Vec3 centre{0.0};
  double radius = 0.0;
};
std::vector<HullBall> hull_of(const Shape& shape);

/// Times within ± this are all times.
inline constexpr double always = 1e15;

/// What is known of a body's motion up to a time; times in seconds.
struct SpeedProof {
  /// Of any point of it, in units of c; < 1 where proved.
  double speed = 0.0;
  double centre_speed = 0.0;  ///< of its origin
  /// Proved from here on.
  double begins = -std::numeric_limits<double>::infinity();
  /// Just before that a bound on the speed is not below that of light.
  double speed_before = 0.0;
};

/// The times of a thing's frame that its image may show, and the proofs for them.
class SpeedProver {
 public:
  /// `frame`: index of the thing's frame among the scene's; after the camera.
  SpeedProver(Compilation& c, int frame);

  /// No ray gets to a later time, in seconds.
  [[nodiscard]] double last() const { return last_; }

  /// The proof for a hull whose coordinates begin at `offset`, and in which matter flows at `within` at most,
  /// in lengths for a second; nothing if it may be seen at the speed of light, which has then been reported,
  /// with the key of `table` that says so.
  std::optional<SpeedProof> prove(const TableView& table, const std::vector<MotionLevel>& levels,
                                  const std::vector<HullBall>& hull, const Vec3& offset,
                                  double within = 0.0) const;

 private:
  void refuse(const TableView& table, const std::optional<RocketFlight>& rocket,
              const std::vector<HullBall>& hull, const SpeedProof& proof) const;

  Compilation& c_;
  Vec3 camera_{0.0};  ///< in the frame
  double last_ = 0.0;
};

/// Whether a value as written depends on t.
bool uses_time(const Description& description, const Node& node);

/// Proved backwards from `last`: as far as it is below the speed of light, or for `reach` seconds at least
/// and until `is_enough` of a time.
SpeedProof prove_speed(const std::vector<MotionLevel>& levels, const std::vector<HullBall>& hull, double c,
                       double last, double reach, const std::function<bool(double)>& is_enough,
                       double within = 0.0);

/// How much at most a body is stretched at times in [from, to].
double stretch_of(const std::vector<MotionLevel>& levels, double from, double to);

/// Bounds on a formula of t alone for times in [from, to], and on its rate.
IntervalSlope over_times(const Expression& formula, double from, double to);

}  // namespace backlight
