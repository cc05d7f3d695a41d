// Matter that turns, swings or accelerates in the inertial frame that its surface is placed in.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "backlight/base/vector.h"
#include "backlight/expression/expression.h"
#include "backlight/expression/line_program.h"
#include "backlight/surface/body_box.h"
#include "backlight/surface/shape.h"
#include "backlight/surface/wave_path.h"

namespace backlight {

/// How the matter of a surface moves: docs/physics.md section 10. Places are in the local coordinates of the
/// surface, which rest in the frame; times are the frame's (c = 1), and velocities in local coordinates by
/// that time. Immutable; safe to use from many threads.
class MatterMotion {
 public:
  /// Three formulas of x, y, z and t, t in seconds.
  using Map = std::array<Expression, 3>;

  /// Equation (22): a body point is somewhere at each time, and each place is at each time a body point's.
  struct Body {
    Map place;  ///< of a body point
    Map point;  ///< of a place: which body point is there
    /// After which, in seconds, body points have the velocities again that they had, if one is known.
    std::optional<double> period{};
    /// Whether each body point is as fast as ever at all times.
    bool steady = false;
    /// Of the matter within the body, in its coordinates, in lengths for a second; without one its points
    /// rest.
    std::optional<Map> flow{};
    /// About all of it, if one is known.
    std::optional<BodyBox> box{};
  };

  /// Of a surface that goes away: a ball that holds it at all times, whose centre goes along a path. Local
  /// coordinates are then the frame's, but for a translation.
  struct Ball {
    Map path;       ///< of the centre; formulas of t alone
    double radius;  ///< > 0
    double speed;   ///< the centre is nowhere faster, < 1
    /// Before this time nothing is known of the motion, and the surface is not there.
    double begins = -std::numeric_limits<double>::infinity();
  };

  struct Time {
    double seconds_per_length = 1.0;
    /// False: nothing asks for own_time(), which may take as long as some hundred formulas.
    bool counts = true;
  };

  /// `body_shape`: whose texture coordinates the body points have.
  MatterMotion(Body body, const Shape& body_shape, std::optional<Ball> ball, Time time);
  /// Of matter that goes straight on with the surface's local coordinates, whose origin is at velocity · time
  /// from the surface's position: what is said of places is said of body points then. `velocity`: of the
  /// frame, in its axes; `radius`: of a ball about the origin that holds the surface.
  MatterMotion(const Vec3& velocity, double radius, Time time);
  /// Of a flow of matter, told by its velocity in local lengths for a second.
  MatterMotion(Map velocity, Time time);
  MatterMotion(const MatterMotion&) = delete;
  MatterMotion& operator=(const MatterMotion&) = delete;

  [[nodiscard]] const std::optional<Ball>& ball() const { return ball_; }

  /// With which velocity in its frame the local coordinates go straight on; null: they rest in it.
  [[nodiscard]] const Vec3* carriage() const { return carriage_ ? &*carriage_ : nullptr; }

  /// Of whose points it tells; null: of none.
  [[nodiscard]] const Shape* body_shape() const { return body_ ? &body_shape_ : nullptr; }

  /// The velocity of a flow in local lengths for a second; null of a body.
  [[nodiscard]] const Map* flow() const { return velocity_ ? &*velocity_ : nullptr; }

  /// A box about the body; null: none is known.
  [[nodiscard]] const BodyBox* box() const { return body_ && body_->box ? &*body_->box : nullptr; }

  /// The matter at a place.
  struct Matter {
    Vec3 body_point;  ///< the place itself where that is not told
    Vec3 velocity;
  };
  [[nodiscard]] Matter matter(const Vec3& place, double time) const;
  /// At several places, each at its time; of each the same as alone.
  void matter(std::span<const Vec3> places, std::span<const double> times, std::span<Matter> found) const;

  /// Whether own times are asked for.
  [[nodiscard]] bool counts_time() const { return time_.counts; }
  /// What the clock of the matter at a place has counted since the frame's time 0: equation (25).
  /// `rest_from_local`: what makes velocities of the frame's of local ones.
  [[nodiscard]] double own_time(const Vec3& place, double time, const Mat3& rest_from_local) const;

  /// The centre of the ball and its velocity. Only of a motion that has one.
  using Centre = WavePath::Motion;
  [[nodiscard]] Centre centre(double time) const;
  /// The same faster, to within near_centre_doubt(): for bounds.
  [[nodiscard]] Centre near_centre(double time) const;
  [[nodiscard]] double near_centre_doubt(double time) const { return waves_ ? waves_->doubt(time) : 0.0; }
  /// Whether near_centre() and strays() take little time, and the centre's acceleration is known.
  [[nodiscard]] bool is_quick() const { return waves_.has_value(); }
  [[nodiscard]] double most_acceleration() const { return waves_->most_acceleration(); }
  /// What near_centre() is computed from; null: it is not quick.
  [[nodiscard]] const LanePath* path() const { return waves_ ? &path_ : nullptr; }
  /// How far along each axis anything of the ball gets from the origin, ever; infinite where there are no
  /// bounds. Of what is quick.
  [[nodiscard]] Vec3 farthest() const;
  /// A bound on how far the centre is from where it would be at this velocity from `time` on, for as long as
  /// `half_time` before and after.
  [[nodiscard]] double strays(const Vec3& velocity, double time, double half_time) const;

 private:
  void find_velocities(std::span<const double> times, std::span<Matter> found) const;
  [[nodiscard]] Vec3 velocity_of(const Vec3& body_point, double time) const;
  [[nodiscard]] double change_of_velocity(const Vec3& velocity, double from, double to) const;
  [[nodiscard]] Vec3 given_velocity(const Vec3& place, double time) const;

  std::optional<Body> body_;
  std::optional<LineProgram> place_, point_;  ///< the body's, each as one
  Shape body_shape_;
  std::optional<Map> velocity_;
  std::optional<Vec3> carriage_;
  std::optional<Ball> ball_;
  std::optional<WavePath> waves_;  ///< the ball's path, if it is such
  LanePath path_;                  ///< the same
  Time time_;
};

}  // namespace backlight
