#include "implicit_roots.h"

#include <algorithm>
#include <cmath>

#include "backlight/expression/enclosure.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A line on which f has more cells than this has infinitely many roots, like sin(1/x), or might as well.
constexpr std::size_t most_cells = 20000;

/// Where a cell is divided when its ends happen to lie on roots: nowhere near a simple fraction.
constexpr double uneven = 0.381966011250105;

double magnitude(const Interval& i) {
  return std::max(-i.lower, i.upper);
}
bool has_zero(const Interval& i) {
  return i.lower <= 0.0 && i.upper >= 0.0;
}

/// Where f is less than this many times its own rounding, dividing a cell further takes very many steps to
/// tell apart what differs by rounding alone.
constexpr double hiding = 8.0;

VariableLine variables_of(const FormulaLine& line) {
  return {line.origin, line.direction};
}

}  // namespace

RootWalk::RootWalk(const ImplicitFormula& f, const FormulaLine& line, double from, double to, Jumps jumps)
    : f_(f),
      line_(line),
      from_(from),
      to_(to),
      start_(from),
      end_(to),
      a_(from),
      step_(0.0),
      jumps_(jumps),
      cells_left_(most_cells) {
  if (!(from <= to)) {
    a_ = end_ = from;
    start_ = infinity;
    return;
  }
  start_ = settle(from, -1);
  end_ = settle(to, 1);
  a_ = start_;
  at_a_ = at(a_);
  step_ = end_ - start_;
  sign_at_start_ = at_a_.sign;
  negative_ = at_a_.sign < 0;
}

/// The middle of a cell that is divided is the end of the next one: it is not looked at twice.
RootWalk::PointValue RootWalk::at(double s) {
  for (const auto& [where, value] : recent_) {
    if (where == s) return value;
  }
  next_recent_ ^= 1U;
  recent_[next_recent_] = {s, look_at(s)};
  return recent_[next_recent_].second;
}

RootWalk::PointValue RootWalk::look_at(double s) {
  ++work_.points;
  const Interval value = enclose(f_.expression().tape(), variables_of(line_), s);
  PointValue result;
  if (value.continuity == Continuity::undefined) return result;
  if (value.lower > 0.0) {
    result.sign = 1;
    result.least = value.lower;
  } else if (value.upper < 0.0) {
    result.sign = -1;
    result.least = -value.upper;
  } else {
    result.undetermined = value.continuity == Continuity::continuous;
  }
  // At a point the width of the interval is the rounding of f, and nothing else.
  result.hidden = result.undetermined || (value.continuity == Continuity::continuous &&
                                          result.least <= hiding * (value.upper - value.lower));
  return result;
}

/// A cell no wider than the spacing of doubles at its place says nothing new when divided. Relative to the
/// cell's own place on the line, whose origin is near the surface, down to a tiny part of the whole search.
double RootWalk::smallest_cell(double from, double to) const {
  return 2.0 * epsilon * std::max({std::abs(from), std::abs(to), 0x1p-40 * (end_ - start_)});
}

double RootWalk::settle(double s, int side) {
  if (!at(s).undetermined) return s;
  double distance = smallest_cell(s, s) + epsilon * (to_ - from_);
  for (int i = 0; i < 12; ++i, distance *= 8.0) {
    if (!at(s + side * distance).undetermined) return s + side * distance;
  }
  return s;
}

void RootWalk::advance(double to, const PointValue& there) {
  step_ = 2.0 * (to - a_);
  a_ = to;
  at_a_ = there;
}

/// Closes the unresolved root. True: it is reported as `root`.
bool RootWalk::end_zone(Root& root) {
  in_zone_ = false;
  root = {0.5 * (zone_start_ + zone_end_),
          RootKind::unresolved,
          sign_before_zone_,
          sign_after_zone_,
          zone_start_,
          zone_end_};
  root.t = std::clamp(root.t, from_, to_);
  return wanted(root);
}

/// The cell [a_, to] can be divided no further.
void RootWalk::add_to_zone(double to, const PointValue& there, bool core) {
  if (!in_zone_) {
    in_zone_ = true;
    zone_start_ = a_;
    sign_before_zone_ = at_a_.sign;
  }
  zone_end_ = to;
  if (core) zone_core_ = to;
  sign_after_zone_ = there.sign;
}

/// Newton's steps in double precision, inside a bracket that is halved whenever they do not do better.
Root RootWalk::polished(double low, double high, int sign_low) const {
  Root root{low, RootKind::crossing, sign_low, -sign_low, low, high};
  std::array<Dual, ImplicitFormula::variables> variables;
  double t = low + 0.5 * (high - low);
  double last_step = high - low;
  for (int i = 0; i < 200; ++i) {
    ++work_.polish;
    for (std::size_t k = 0; k < variables.size(); ++k) {
      variables[k] = {line_.origin[k] + t * line_.direction[k], line_.direction[k]};
    }
    const Dual f = f_.expression().evaluate(variables);
    if (f.value == 0.0) break;
    ((f.value < 0.0) == (sign_low < 0) ? low : high) = t;
    double step = f.value / f.derivative;
    double next = t - step;
    if (!(next > low && next < high && 2.0 * std::abs(step) <= last_step)) {
      if (std::abs(step) <= 0.25 * epsilon * std::abs(t)) break;
      next = low + 0.5 * (high - low);
      step = next - t;
    }
    if (next == t || next == low || next == high) {
      t = next;
      break;
    }
    last_step = std::abs(step);
    t = next;
    if (last_step <= 0.5 * epsilon * std::abs(t)) break;
  }
  root.t = t;
  return root;
}

/// Looks at the cell [a_, to]. `split`: nothing could be said of it.
RootWalk::Verdict RootWalk::try_cell(double to, Root& root) {
  ++work_.cells;
  const IntervalSlope cell = enclose(f_.expression().tape(), variables_of(line_), a_, to);
  const Continuity continuity = cell.value.continuity;
  if (continuity == Continuity::undefined) {
    advance(to, {});
    return Verdict::advanced;
  }
  if (!has_zero(cell.value)) {
    const bool positive = cell.value.lower > 0.0;
    advance(to, {positive ? 1 : -1, positive ? cell.value.lower : -cell.value.upper, false});
    return Verdict::advanced;
  }
  if (continuity != Continuity::continuous || at_a_.sign == 0) return Verdict::split;
  const bool monotone = !has_zero(cell.slope);
  double end = to;
  PointValue at_end = at(end);
  if (monotone && at_end.undetermined) {
    end = a_ + (1.0 - uneven) * (to - a_);
    at_end = at(end);
  }
  if (at_end.sign == 0) return Verdict::split;
  if (at_end.sign != at_a_.sign) {
    if (!monotone) return Verdict::split;
    root = polished(a_, end, at_a_.sign);
    advance(end, at_end);
    return Verdict::crossing;
  }
  // By the mean value theorem, f cannot come down to 0 and back up within the cell. The factor is for
  // rounding.
  const bool too_short = at_a_.least + at_end.least > magnitude(cell.slope) * (end - a_) * (1.0 + 0x1p-48);
  if (!monotone && !too_short) return Verdict::split;
  advance(end, at_end);
  return Verdict::advanced;
}

/// Whether the sign of f is hidden by the rounding of f itself all over [a_, to]. One or two points may lie
/// on roots by chance; these four do not.
bool RootWalk::hidden_by_rounding(double to) {
  const double length = to - a_;
  return hidden_at(to) && hidden_at(a_ + 0.5 * length) && hidden_at(a_ + uneven * length) &&
         hidden_at(a_ + 0.8090169943749475 * length);
}

/// Whether f has become negative, or ceased to be, without a root, from `at` on.
bool RootWalk::jumped(double at, Root& root) {
  const bool negative = at_a_.sign < 0;
  if (jumps_ == Jumps::ignore || in_zone_ || negative == negative_) return false;
  root = {at, RootKind::jump, negative_ ? -1 : 0, at_a_.sign, at, a_};
  return true;
}

bool RootWalk::next(Root& root) {
  if (!find(root)) return false;
  negative_ = root.sign_after < 0;
  return true;
}

bool RootWalk::find(Root& root) {
  if (held_) {
    root = held_root_;
    held_ = false;
    return true;
  }
  while (a_ < end_) {
    if (in_zone_ && at_a_.sign != 0 && a_ - zone_core_ >= zone_core_ - zone_start_ && end_zone(root)) {
      return true;
    }
    double to = std::min(a_ + step_, end_);
    if (end_ - to < smallest_cell(to, end_) || cells_left_ == 0) to = end_;
    cells_left_ -= cells_left_ > 0 ? 1 : 0;
    const double length = to - a_;
    const bool fine =
        in_zone_ && length <= 0.25 * (zone_core_ - zone_start_) && a_ - zone_core_ < zone_core_ - zone_start_;
    const double begin = a_;
    const Verdict verdict = try_cell(to, root);
    if (verdict == Verdict::advanced) {
      if (jumped(begin, root)) return true;
      continue;
    }
    if (verdict == Verdict::crossing) {
      if (root.t < from_ || root.t > to_) {
        negative_ = root.sign_after < 0;
        continue;
      }
      held_root_ = root;
      held_ = in_zone_ && end_zone(root);  // the unresolved one comes first
      if (!held_) root = held_root_;
      return true;
    }
    const bool smallest = !(length > smallest_cell(a_, to)) || cells_left_ == 0;
    if (!smallest && !fine && !hidden_by_rounding(to)) {
      step_ = length * (at(a_ + 0.5 * length).undetermined ? uneven : 0.5);
      continue;
    }
    // Too small to divide: a pole, a jump or the edge of a domain, which is no surface; or unresolved.
    const PointValue there = at(to);
    if (cells_left_ == 0 || enclose(f_.expression().tape(), variables_of(line_), a_, to).value.continuity ==
                                Continuity::continuous) {
      add_to_zone(to, there, smallest || !fine);
    }
    advance(to, there);
    if (jumped(begin, root)) return true;
  }
  return in_zone_ && end_zone(root);
}

std::vector<Root> all_roots(const ImplicitFormula& f, const FormulaLine& line, double from, double to) {
  std::vector<Root> roots;
  Root root;
  for (RootWalk walk(f, line, from, to); walk.next(root);) roots.push_back(root);
  return roots;
}

}  // namespace backlight
