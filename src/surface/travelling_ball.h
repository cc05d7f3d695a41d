// A ball whose centre goes along a path of waves: where lines first meet it, over any number of lanes, with
// the same bits for each. Docs/physics.md equations (28b) to (28d).
//
// Along a line with parameter s, w = x - c(t) leads from the centre to the line's point. Of
//   f(s) = (w² - r²)/2,   f' = w·u,   f'' = u² + w·n,   u = d - b ċ,   n = u' = -b² c̈,
// the third derivative is bounded, since the path's acceleration and jerk are. So each look at the path says
// of a stretch about s that there is no root in it, or where the first one is. Nothing is stepped over, and
// nothing is found that is not there, but for rounding.
#pragma once

#include "closed_forms.h"
#include "lane_path.h"

namespace backlight {

/// The frame's time along lines, start + s rate; s as of LaneLine. |rate| <= 1.
template <class V>
struct LaneClock {
  V start, rate;
};

struct TravellingBall {
  double radius;
  double begins;  ///< before this time nothing is known of it, and it is not there
  const LanePath* path;
};

BACKLIGHT_LANES TravellingBall ball_of(const LaneSurface& surface) {
  return {surface.values[0], surface.values[1], surface.path};
}

/// Which rays may meet it; those that are not light are not asked. `start` and `rate`: of the time along
/// them.
template <class V>
BACKLIGHT_LANES unsigned may_meet(const PassingBall& ball, const LaneRay<V>& ray, V start, V rate) {
  const LaneVec3<V> velocity(ball.velocity);
  const LaneVec3<V> from = ray.origin - LaneVec3<V>(ball.centre) - (start - V(ball.time)) * velocity;
  const LaneVec3<V> way = ray.direction - rate * velocity;
  const V size = length(ray.direction), square = dot(way, way), along = dot(from, way), far = dot(from, from);
  const typename V::Mask is_light = magnitude(rate + size) <= V(1e-9) * size;
  const V room = V(1e-12) * (far + dot(ray.origin, ray.origin) + start * start);
  const typename V::Mask apart =
      far * square - along * along > (V(ball.radius * ball.radius) + room) * square;
  return bits(~(is_light & apart));
}

template <class V>
class BallSearch {
  using Mask = typename V::Mask;
  using V3 = LaneVec3<V>;

 public:
  BACKLIGHT_LANES BallSearch(const TravellingBall& ball, const LaneLine<V>& line, const LaneClock<V>& clock)
      : path_(*ball.path),
        point_(line.point),
        direction_(line.direction),
        clock_(clock),
        radius_(ball.radius),
        square_radius_(ball.radius * ball.radius),
        by_slowest_(V(1.0) / (V(1.0) - magnitude(clock.rate) * V(ball.path->speed))),
        surely_(V(1.0 - 1e-12) / (V(1.0) + magnitude(clock.rate) * V(ball.path->speed))),
        bend_(clock.rate * clock.rate * V(ball.path->acceleration)),
        change_of_bend_(magnitude(clock.rate) * clock.rate * clock.rate * V(ball.path->jerk)),
        size_(largest_coordinate(line.point) + V(ball.radius)) {
    const V start = (V(ball.begins) - clock.start) / clock.rate;
    const Mask still = clock.rate == V(0.0), back = clock.rate < V(0.0);
    const V whole = select(clock.start >= V(ball.begins), V(infinity), V(-infinity));
    last_ = select(still, whole, select(back, start, V(infinity)));
    earliest_ = select(still | back, V(-infinity), start);
  }

  /// The first crossing at s > `from` of the lines that are wanted; not a number: there is none.
  V first(V from, Mask wanted) {
    from_ = larger(from, earliest_);
    seeking_ = wanted;
    marching_ = polishing_ = fresh_ = none();
    constexpr int most_looks = 500;
    for (int i = 0; i < most_looks && bits(seeking_ | marching_ | polishing_) != 0; ++i) {
      look();
      const Mask marches = marching_, polishes = polishing_;
      if (bits(seeking_) != 0) seek(i == most_seeks);
      if (bits(marches) != 0) march(marches);
      if (bits(polishes) != 0) polish(polishes);
    }
    return select(marching_ | polishing_, s_, root_);
  }

 private:
  static constexpr double infinity = __builtin_inf();
  static constexpr int most_seeks = 60;
  static BACKLIGHT_LANES Mask none() { return V(1.0) < V(0.0); }

  /// What f is at s.
  BACKLIGHT_LANES void look() {
    time_ = clock_.start + s_ * clock_.rate;
    const PathMoment<V> at = moment_of(path_, time_);
    w_ = point_ + s_ * direction_ - at.place;
    u_ = direction_ - clock_.rate * at.velocity;
    const V turn = -(clock_.rate * clock_.rate);
    const V square = dot(u_, u_);
    value_ = V(0.5) * (dot(w_, w_) - square_radius_);
    rate_ = dot(w_, u_);
    half_bend_ = V(0.5) * (square + turn * dot(w_, at.acceleration));
    turn_ = turn * dot(at.acceleration, direction_);
    speed_ = V(0.5) * square + V(0.5);  // |u| is no more
    distance_ = length(w_);
  }

  /// |f'''| = |3 u·n + w·n'| within h of s is no more.
  [[nodiscard]] BACKLIGHT_LANES V third(V h) const {
    const V speed = speed_ + bend_ * h;
    return (V(3.0) * speed * bend_ + (distance_ + speed * h) * change_of_bend_) * V(1.0 + 1e-12);
  }

  /// How far from s w·d, which grows at no less than 1/by_slowest_, and now at `pace`, which itself now grows
  /// by `turn`, may get by `way` at most.
  [[nodiscard]] BACKLIGHT_LANES V reach(V way, V pace, V turn) const {
    const V left = larger(way, V(0.0)), by_slowest = left * by_slowest_;
    // A little farther than it would be, without the jerk; if with the most of it that is far enough, too.
    const V more = V(1.25) * left, square = pace * pace + V(2.0) * turn * more;
    const V guess = V(2.0) * more / (pace + sqrt(larger(square, V(0.0))));
    const V least = guess * (pace + guess * (V(0.5) * turn - guess * change_of_bend_ * V(1.0 / 6.0)));
    const Mask enough = (square > V(0.0)) & (least >= left);
    return select(enough, smaller(guess, by_slowest), by_slowest) * V(1.0 + 1e-9);
  }

  /// To where the line passes the centre, by Newton's method within a bracket; any place near to it will do.
  void seek(bool is_last) {
    const V ahead = dot(w_, direction_), pace = dot(u_, direction_);
    Mask arrived = ~(magnitude(ahead) > V(0.25) * radius_);
    if (is_last) arrived = seeking_;
    arrived = arrived & seeking_;
    const V farthest = s_ - ahead * by_slowest_;
    const Mask beyond = ahead > V(0.0);
    high_ = select(beyond, s_, smaller(high_, farthest));
    low_ = select(beyond, larger(low_, farthest), s_);
    const V square = pace * pace - V(2.0) * turn_ * ahead;
    V next = s_ - V(2.0) * ahead / (pace + sqrt(larger(square, V(0.0))));
    next = select((next > low_) & (next < high_), next, V(0.5) * low_ + V(0.5) * high_);
    if (bits(arrived) != 0) next = select(arrived, begin(arrived, ahead, pace), next);
    s_ = select(seeking_, next, s_);
    seeking_ = seeking_ & ~arrived;
  }

  /// From where on roots are looked for: all are within reach of here.
  BACKLIGHT_LANES V begin(Mask arrived, V ahead, V pace) {
    const V forwards = reach(radius_ - ahead, pace, turn_), backwards = reach(radius_ + ahead, pace, -turn_);
    const V left = s_ - backwards;
    end_ = select(arrived, smaller(s_ + forwards, last_), end_);
    // f(s+h) >= value + rate h + bend h² all over the reach.
    const V whole = larger(forwards, backwards);
    const V bend = half_bend_ - third(whole) * whole * V(1.0 / 6.0);
    const Mask from_left = left >= from_, bent = from_left & (bend > V(0.0));
    const V half_rate = V(0.5) * rate_, discriminant = half_rate * half_rate - bend * value_;
    const QuadraticRoots<V> roots(select(bent, bend, V(1.0)), half_rate, value_,
                                  larger(discriminant, V(0.0)));
    const V start = select(bent, larger(left, s_ + roots.low), larger(left, from_));
    const Mask begins = arrived & ~(bent & (discriminant < V(0.0))) & (start <= end_);
    marching_ = marching_ | begins;
    fresh_ = fresh_ | (begins & ~from_left);
    return start;
  }

  /// value + rate h + bend h² = 0 at the first h > 0, where value > 0; else beyond all bounds.
  static BACKLIGHT_LANES V first_root(V value, V rate, V bend) {
    const V discriminant = rate * rate - V(4.0) * value * bend;
    const V divisor = sqrt(larger(discriminant, V(0.0))) - rate;
    return select((discriminant >= V(0.0)) & (divisor > V(0.0)), V(2.0) * value / divisor, V(infinity));
  }

  /// On from s, before which there is no root.
  void march(Mask marches) {
    sign_ = select(marches & fresh_ & (value_ < V(0.0)), V(-1.0), sign_);
    fresh_ = fresh_ & ~marches;
    const V value = sign_ * value_, rate = sign_ * rate_, bend = sign_ * half_bend_, left = end_ - s_;
    const V guess = first_root(value, rate, bend);
    const Mask curved = guess < V(infinity);
    // How far to look: where that is clear, past the root, and else as far as there certainly is none.
    const V falling = smaller(rate, V(0.0)), by_jolt = V(6.0) / third(left);
    const V spare = (bend - V(0.25) * falling * falling / value) * by_jolt;
    const V clear = larger(spare, sqrt(value + larger(rate, V(0.0)) * by_jolt));
    const V window = smaller(select(curved, V(1.25) * guess, clear), left);
    const V jolt = third(window), off = jolt * window * V(1.0 / 6.0);
    const V least = first_root(value, rate, bend - off), most = first_root(value, rate, bend + off);
    const V at_least = rate + least * (V(2.0) * bend + V(0.5) * jolt * least),
            at_most = rate + most * (V(2.0) * bend + V(0.5) * jolt * most);
    const Mask touched = marches & ~(value > V(0.0));  // but for rounding
    const Mask enclosed = marches & ~touched & (most <= window) & (at_least < V(0.0)) & (at_most < V(0.0));
    // And the ball's surface comes no nearer than its way and the line's together.
    const V step = larger(smaller(least, window), (distance_ - radius_) * sign_ * surely_);
    const Mask out = marches & ~(touched | enclosed) & ~(step < left);
    const Mask stuck = marches & ~(touched | enclosed | out) & ~(step > rounding());
    const V next = s_ + select(enclosed, guess, step);
    root_ = select(stuck, s_, root_);
    s_ = select(marches & ~touched, next, s_);
    marching_ = marching_ & ~(touched | enclosed | stuck | out);
    polishing_ = polishing_ | enclosed;
    if (bits(touched) != 0) polish(touched);
  }

  /// A root alone in its surroundings, near s.
  void polish(Mask polishes) {
    const V value = sign_ * value_, rate = sign_ * rate_, bend = sign_ * half_bend_;
    const V divisor = sqrt(larger(rate * rate - V(4.0) * value * bend, V(0.0))) - rate;
    const Mask falls = rate < V(0.0);
    const V step = select(falls, V(2.0) * value / select(falls, divisor, V(1.0)), V(0.0));
    const V size = magnitude(step);
    // What the step leaves out is f''' h³/6.
    const V off = third(size) * size * size * size * V(1.0 / 6.0);
    const Mask good = ~(off > V(0.125) * rounding() * magnitude(rate)) | ~(size > rounding());
    s_ = select(polishes, s_ + step, s_);
    root_ = select(polishes & good, s_, root_);
    polishing_ = (polishing_ | polishes) & ~(polishes & good);
  }

  /// Of s.
  [[nodiscard]] BACKLIGHT_LANES V rounding() const {
    return V(0x1p-52) * (size_ + magnitude(s_) + magnitude(time_));
  }

  const LanePath& path_;
  const V3 point_, direction_;
  const LaneClock<V> clock_;
  const V radius_, square_radius_;
  const V by_slowest_;             ///< s for each length that w·d grows by, at most
  const V surely_;                 ///< s for each length that lies between line and ball, at least
  const V bend_, change_of_bend_;  ///< no less than |n|, |n'|
  const V size_;
  V last_, earliest_;  ///< where it is there at all
  V from_{0.0};
  // Of each line: where it is looked at, and in which of three ways.
  V s_{0.0};
  Mask seeking_, marching_, polishing_;
  Mask fresh_;                         ///< it begins to march, and may do so inside
  V low_{-infinity}, high_{infinity};  ///< of the search for the centre
  V end_{0.0};                         ///< of the roots
  V sign_{1.0};                        ///< of f before the first root
  V root_{__builtin_nan("")};
  // look():
  V time_{0.0}, value_{0.0}, rate_{0.0}, half_bend_{0.0}, turn_{0.0}, speed_{0.0}, distance_{0.0};
  V3 w_{V(0.0), V(0.0), V(0.0)}, u_{V(0.0), V(0.0), V(0.0)};
};

/// The point of a crossing, and the velocity of the centre.
template <class V>
struct TravellingPoint {
  LaneLocalPoint<V> point;
  LaneVec3<V> velocity;
};

template <class V>
BACKLIGHT_LANES TravellingPoint<V> point_of(const TravellingBall& ball, const LaneLine<V>& line,
                                            const LaneClock<V>& clock, V along) {
  const V time = clock.start + along * clock.rate;
  const PathMoment<V> at = moment_of(*ball.path, time);
  const LaneVec3<V> out = line.at(along) - at.place;
  const LaneVec3<V> normal = (V(1.0) / length(out)) * out;
  const V error = doubt_of(*ball.path, time) + V(0x1p-50) * magnitude(time);
  return {{at.place + V(ball.radius) * normal, normal, error}, at.velocity};
}

struct TravellingBallForm : ClosedForm {
  static constexpr bool unit_gradient = true, is_convex = false, travels = true;
};

}  // namespace backlight
