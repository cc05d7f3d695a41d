// The first root of many lines with a torus, over lanes: a template over their number, the same bits for any.
//
// The steps are those of torus.cpp: the roots of a depressed cubic cut the line into pieces on which the
// torus's quartic is monotone. Of three roots, the outer two are minima of the quartic (inside, if the line
// meets the torus about there), the middle one is minus their sum.
#pragma once

#include "local_lines.h"

namespace backlight {

struct TorusQuestion {
  double major, minor;
  double lambda_min;  ///< only what is beyond counts
  /// Then all that matters is whether there is one in front of lambda_max.
  bool existence_is_enough = false;
  double lambda_max = __builtin_inf();
};

template <class V>
class TorusLanes {
 public:
  using Mask = typename V::Mask;

  /// The first root of each line, or infinity; of a padded number of lines.
  static void run(const TorusQuestion& question, const LocalLines& lines, double* roots) {
    for (std::size_t k = 0; k < lines.padded(); k += V::width) {
      TorusLanes torus(question, lines, k);
      (question.existence_is_enough ? torus.any_root() : torus.first_root()).store(roots + k);
    }
  }

  /// Up to four roots of the whole line, in order; not a number: there is none.
  static BACKLIGHT_LANES void all_roots(const TorusQuestion& question, const LaneLine<V>& line,
                                        V (&roots)[4]) {
    TorusLanes torus(question, line);
    const Mask meets = torus.clip();
    torus.find_cuts();
    const V ends[5] = {torus.begin_, torus.cut_[0], torus.cut_[1], torus.cut_[2], torus.high_};
    Mask inside = torus.size_ < V(0.0);  // nowhere
    for (int i = 0; i < 4; ++i) {
      const V at_end = torus.distance(ends[i + 1]).value;
      const Mask inside_next =
          i < 3 ? (at_end <= V(0.0)) & (ends[i + 1] > torus.begin_) : ~(torus.size_ > V(0.0));
      const Mask found = meets & ((inside & ~inside_next) | (~inside & inside_next));
      torus.from_ = ends[i];
      torus.to_ = ends[i + 1];
      torus.falling_ = ~inside;
      torus.negative_ = select(inside, torus.distance(ends[i]).value, at_end);
      roots[i] = select(found, torus.polished(found), V(__builtin_nan("")));
      inside = inside_next;
    }
  }

 private:
  BACKLIGHT_LANES TorusLanes(const TorusQuestion& question, const LaneLine<V>& line)
      : p_(line.point),
        d_(line.direction),
        start_(-__builtin_inf()),
        major_(question.major),
        minor_(question.minor),
        size_(question.major + question.minor) {}

  BACKLIGHT_LANES TorusLanes(const TorusQuestion& question, const LocalLines& lines, std::size_t k)
      : p_(V::load(lines.point[0] + k), V::load(lines.point[1] + k), V::load(lines.point[2] + k)),
        d_(V::load(lines.direction[0] + k), V::load(lines.direction[1] + k), V::load(lines.direction[2] + k)),
        major_(question.major),
        minor_(question.minor),
        size_(question.major + question.minor) {
    centre_ = V::load(lines.lambda_centre + k);
    shift_ = V::load(lines.lambda_shift + k);
    per_length_ = V::load(lines.lambda_per_length + k);
    start_ = (V(question.lambda_min) - centre_ - shift_) / per_length_;
    lambda_max_ = V(question.lambda_max);
  }

  BACKLIGHT_LANES V first_root() {
    const V none(__builtin_inf());
    const Mask meets = clip();
    if (bits(meets) == 0) return none;
    find_cuts();
    const Mask found = find_bracket() & meets;
    if (bits(found) == 0) return none;
    return select(found, polished(found), none);
  }

  /// The first root where it may be behind λ_max; where there is one that is not, minus infinity.
  BACKLIGHT_LANES V any_root() {
    const V none(__builtin_inf());
    const Mask meets = clip();
    if (bits(meets) == 0) return none;
    find_cuts();
    const Mask crossed = find_bracket();
    const Mask found = crossed & meets;
    const V along = shift_ + to_ * per_length_;
    const V room = V(lambda_room) * (magnitude(centre_) + (magnitude(shift_) + magnitude(along)));
    const Mask before = found & ((centre_ + along) + room < lambda_max_);
    const Mask open = found & ~before;
    V root = select(before, -none, none);
    if (bits(open) != 0) root = select(open, polished(open), root);
    return root;
  }

  static BACKLIGHT_LANES V within(V a, V low, V high) { return smaller(larger(a, low), high); }

  struct ValueAndSlope {
    V value, slope;
  };

  /// (ρ - R)² + y² - r² and its slope along the line.
  BACKLIGHT_LANES ValueAndSlope distance(V t) const {
    const V x = p_.x + t * d_.x;
    const V y = p_.y + t * d_.y;
    const V z = p_.z + t * d_.z;
    const V rho = sqrt(x * x + z * z);
    const V beside = rho - major_;
    const V rate = (x * d_.x + z * d_.z) / select(rho > V(0.0), rho, V(1.0));
    return {(beside - minor_) * (beside + minor_) + y * y, V(2.0) * (beside * rate + y * d_.y)};
  }

  /// Where the torus can be: inside its sphere, between its flat tangent planes, beyond the start.
  BACKLIGHT_LANES Mask clip() {
    const V outer = size_ * V(1.0 + 1e-9);
    const V square = outer * outer - dot(p_, p_);
    high_ = sqrt(larger(square, V(0.0)));
    low_ = -high_;
    const V half = minor_ * V(1.0 + 1e-9);
    const Mask level = d_.y == V(0.0);
    const V rate = select(level, V(1.0), d_.y);
    const V one = (-half - p_.y) / rate;
    const V other = (half - p_.y) / rate;
    low_ = select(level, low_, larger(low_, smaller(one, other)));
    high_ = select(level, high_, smaller(high_, larger(one, other)));
    begin_ = larger(low_, start_);
    return (square >= V(0.0)) & (~level | (magnitude(p_.y) <= half)) & (begin_ < high_);
  }

  /// cos(2/3 arccos s) for 0 <= s <= 1, to 1.1e-5.
  static BACKLIGHT_LANES V third_of_angle(V s) {
    return V(cosine[0]) + s * (V(cosine[1]) + s * (V(cosine[2]) + s * (V(cosine[3]) + s * V(cosine[4]))));
  }

  /// The outer roots of t³ + Pt + Q; of a single one, twice that. From a guess that is right to 1.1e-5
  /// (Viète's cosines), or from beyond a single root, where Newton's steps all go one way. A cut that is off
  /// by δ changes the quartic there by δ² only.
  BACKLIGHT_LANES void find_cuts() {
    const V square = major_ * major_;
    const V p = dot(p_, p_) + square - minor_ * minor_ - V(2.0) * square * (d_.x * d_.x + d_.z * d_.z);
    const V q = V(-2.0) * square * (p_.x * d_.x + p_.z * d_.z);
    const Mask three = V(4.0) * p * p * p + V(27.0) * q * q < V(0.0);
    const V r = sqrt(larger(p / V(-3.0), V(0.0)));
    const V r2 = r + r;
    const V cube = select(three, r2 * r * r, V(1.0));
    const V w = within(-q / cube, V(-1.0), V(1.0));
    const V beyond = larger(size_, r2);
    const V single = select(q > V(0.0), -beyond, beyond);
    V last = select(three, r2 * third_of_angle(sqrt(V(0.5) + V(0.5) * w)), single);
    V first = select(three, -(r2 * third_of_angle(sqrt(V(0.5) - V(0.5) * w))), single);
    const V tolerance = V(1e-6) * size_;
    const V limit = select(three, r, V(-__builtin_inf()));
    Mask active = size_ > V(0.0);
    for (int i = 0; i < 60 && bits(active) != 0; ++i) {
      const V step_last = step(last, p, q);
      const V step_first = step(first, p, q);
      last = select(active, larger(last - step_last, limit), last);
      first = select(active, smaller(first - step_first, -limit), first);
      active = active & ((magnitude(step_last) > tolerance) | (magnitude(step_first) > tolerance));
    }
    const V middle = select(three, -(first + last), last);
    cut_[0] = within(first, begin_, high_);
    cut_[1] = within(middle, begin_, high_);
    cut_[2] = within(last, begin_, high_);
  }

  static BACKLIGHT_LANES V step(V t, V p, V q) {
    const V slope = V(3.0) * t * t + p;
    return select(slope > V(0.0), ((t * t + p) * t + q) / select(slope > V(0.0), slope, V(1.0)), V(0.0));
  }

  /// The first piece at whose ends the signs differ.
  BACKLIGHT_LANES Mask find_bracket() {
    const V at_begin = distance(begin_).value;
    const Mask inside = (begin_ > low_) & (at_begin <= V(0.0));
    const V at_first = distance(cut_[0]).value;
    const V at_last = distance(cut_[2]).value;
    const Mask in_first = (at_first <= V(0.0)) & (cut_[0] > begin_) & (cut_[0] < high_);
    const Mask in_last = (at_last <= V(0.0)) & (cut_[2] > begin_) & (cut_[2] < high_);
    // From outside: to the first minimum that is inside.
    from_ = select(in_first, begin_, cut_[1]);
    to_ = select(in_first, cut_[0], cut_[2]);
    negative_ = select(in_first, at_first, at_last);
    falling_ = ~inside;
    Mask found = in_first | in_last;
    if (bits(inside) != 0) {
      const V at_middle = distance(cut_[1]).value;
      const Mask out_again = (at_middle > V(0.0)) & (cut_[1] > begin_) & (cut_[1] < high_);
      const Mask behind_first = out_again | (cut_[2] >= high_);
      from_ = select(inside, select(behind_first, cut_[0], cut_[2]), from_);
      to_ = select(inside, select(out_again, cut_[1], high_), to_);
      const V there = select(behind_first, at_first, at_last);
      negative_ = select(inside, select(from_ > begin_, there, at_begin), negative_);
      found = found | inside;
    }
    return found;
  }

  /// Newton's steps, with a bisection wherever the step leaves the bracket or is not less than half the step
  /// before. They begin where a parabola has its zero whose vertex is the end inside.
  BACKLIGHT_LANES V polished(Mask wanted) {
    const V tolerance = V(1e-16) * size_;
    const V outside = select(falling_, from_, to_);
    const V vertex = select(falling_, to_, from_);
    const V depth = larger(-negative_, V(0.0));
    const V height = larger(distance(outside).value, V(0.0));
    const V sum = depth + height;
    V low = from_;
    V high = to_;
    V t = within(vertex + (outside - vertex) * sqrt(depth / select(sum > V(0.0), sum, V(1.0))), low, high);
    V step_before = high - low;
    Mask active = wanted;
    Mask quadratic = size_ < V(0.0);  // none: whether the step before was Newton's
    for (int i = 0; i < 200 && bits(active) != 0; ++i) {
      const ValueAndSlope at = distance(t);
      // At the low end the value is positive where it falls.
      const Mask is_low = ((at.value > V(0.0)) & falling_) | ((at.value <= V(0.0)) & ~falling_);
      low = select(active & is_low, t, low);
      high = select(active & ~is_low, t, high);
      const V newton = at.value / select(at.slope == V(0.0), V(1e-300), at.slope);
      // Steps of Newton's shrink as their squares: the next one would be this one's cube by the square of the
      // one before.
      const V size = magnitude(newton);
      const Mask exact =
          (size <= tolerance) |
          (quadratic & (size * size * size <= V(0.25) * tolerance * step_before * step_before));
      const V target = t - newton;
      const Mask useful = (target > low) & (target < high) & (V(2.0) * size < magnitude(step_before));
      const V bisected = low + V(0.5) * (high - low);
      const V next = select(exact, within(target, low, high), select(useful, target, bisected));
      const V step = select(useful, newton, V(0.5) * (high - low));
      const Mask done = exact | (magnitude(step) <= tolerance) | (next == t);
      step_before = select(active, step, step_before);
      t = select(active, next, t);
      quadratic = useful;
      active = active & ~done;
    }
    return t;
  }

  static constexpr double cosine[5] = {0.5000106084908355, 0.5768124795415821, -0.10649398677496215,
                                       0.038352908445762925, -0.008688352074050488};

  LaneVec3<V> p_, d_;
  V centre_, shift_, per_length_, lambda_max_;
  V start_, major_, minor_, size_;
  V low_, high_, begin_;
  V cut_[3];
  V from_, to_, negative_;
  Mask falling_;
};

}  // namespace backlight
