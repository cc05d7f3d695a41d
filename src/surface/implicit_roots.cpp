#include "implicit_roots.h"

#include <algorithm>
#include <cmath>

#include "backlight/expression/enclosure.h"
#include "newton_bracket.h"
#include "root_evidence.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A line on which f has more cells than this has infinitely many roots, like sin(1/x), or might as well:
/// what is left of it is divided into `last_cells` at most.
constexpr std::size_t most_cells = 20000;
constexpr double last_cells = 4096.0;

/// However nearly a line is parallel to a jump of f, cells beside that are divided to this part of the whole.
constexpr double widest_jump = 0x1p-20;

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

RootWalk::RootWalk(const ImplicitFormula& f, const LinePiece& piece, Jumps jumps)
    : f_(f),
      line_(piece),
      start_(piece.from),
      end_(piece.to),
      a_(piece.from),
      step_(0.0),
      jumps_(jumps),
      cells_left_(most_cells) {
  if (!(line_.from <= line_.to)) {
    a_ = end_ = line_.from;
    start_ = infinity;
    return;
  }
  if (piece.sign == 0) start_ = settle(line_.from, -1);
  end_ = settle(line_.to, 1);
  a_ = start_;
  at_a_ = at(a_);
  if (piece.sign != 0 && at_a_.sign == 0) at_a_ = {piece.sign, 0.0};
  step_ = end_ - start_;
  jump_cell_ = std::min(RootEvidence(f_, line_).resolution_of_jumps(), widest_jump * step_);
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
  result.doubtful = value.continuity == Continuity::partial;
  // At a point the width of the interval is the rounding of f, and nothing else.
  result.hidden = result.undetermined || (value.continuity == Continuity::continuous &&
                                          result.least <= hiding * (value.upper - value.lower));
  return result;
}

/// A cell no wider than the spacing of doubles at its place says nothing new when divided. Relative to the
/// cell's own place on the line, whose origin is near the surface, down to a tiny part of the whole search.
double RootWalk::smallest_cell(double from, double to) const {
  const double spacing = 2.0 * epsilon * std::max({std::abs(from), std::abs(to), 0x1p-40 * (end_ - start_)});
  return std::max(spacing, least_cell_);
}

double RootWalk::settle(double s, int side) {
  if (!at(s).undetermined) return s;
  double distance = smallest_cell(s, s) + epsilon * (line_.to - line_.from);
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

/// Closes the stretch that could not be divided further. True: there is a root on it, reported as `root`.
bool RootWalk::end_zone(Root& root) {
  in_zone_ = false;
  const RootEvidence evidence(f_, line_);
  const bool changes = sign_before_zone_ * sign_after_zone_ < 0 || zone_has_root_;
  if (evidence.vanishes(zone_start_, zone_end_)) return false;
  if (!changes && !evidence.comes_to_zero(zone_start_, zone_end_)) return false;
  return report_zone(root);
}

/// What kind of root it is. Where f is 0 all over the stretch, as between two boxes that touch, its ends are
/// faces.
bool RootWalk::report_zone(Root& root) {
  const RootEvidence evidence(f_, line_);
  const double start = zone_start_;
  const double end = zone_end_;
  if (sign_before_zone_ * sign_after_zone_ < 0 && evidence.goes_through(start, end)) {
    root = polished(start, end, sign_before_zone_);
    return wanted(root);
  }
  const auto face = [&](double at, int before, int after) {
    return Root{std::clamp(at, line_.from, line_.to), RootKind::crossing, before, after, at, at};
  };
  const bool face_before = sign_before_zone_ != 0 && evidence.leaves_at_once(start, -1, end - start);
  const bool face_behind = sign_after_zone_ != 0 && evidence.leaves_at_once(end, 1, end - start);
  if (face_before || face_behind) {
    root = face_before ? face(start, sign_before_zone_, 0) : face(end, 0, sign_after_zone_);
    if (face_before && face_behind) hold(face(end, 0, sign_after_zone_));
    return wanted(root);
  }
  root = {std::clamp(0.5 * (start + end), line_.from, line_.to),
          RootKind::unresolved,
          sign_before_zone_,
          sign_after_zone_,
          start,
          end};
  return wanted(root);
}

void RootWalk::hold(const Root& root) {
  if (wanted(root)) held_[held_count_++] = root;
}

/// The cell [a_, to] can be divided no further.
void RootWalk::add_to_zone(double to, const PointValue& there, bool core) {
  if (!in_zone_) {
    in_zone_ = true;
    zone_start_ = a_;
    sign_before_zone_ = at_a_.sign;
    zone_has_root_ = false;
  }
  zone_has_root_ = zone_has_root_ || changes_sign(to);
  zone_end_ = to;
  if (core) zone_core_ = to;
  sign_after_zone_ = there.sign;
}

/// Whether f certainly has different signs somewhere in [a_, to].
bool RootWalk::changes_sign(double to) {
  const int middle = at(a_ + 0.5 * (to - a_)).sign;
  return at_a_.sign * middle < 0 || at_a_.sign * at(to).sign < 0 || middle * at(to).sign < 0;
}

Root RootWalk::polished(double low, double high, int sign_low) const {
  Root root{0.5 * low + 0.5 * high, RootKind::crossing, sign_low, -sign_low, low, high};
  NewtonBracket bracket{low, high, sign_low > 0, least_length(line_)};
  std::array<Dual, ImplicitFormula::variables> variables;
  Dual f;
  do {
    ++work_.polish;
    for (std::size_t k = 0; k < variables.size(); ++k) {
      variables[k] = {line_.origin[k] + root.t * line_.direction[k], line_.direction[k]};
    }
    f = f_.expression().evaluate(variables);
  } while (!bracket.improve(root.t, f.value, f.derivative));
  return root;
}

/// Looks at the cell [a_, to]. `split`: nothing could be said of it.
RootWalk::Verdict RootWalk::try_cell(double to, Root& root) {
  ++work_.cells;
  const IntervalSlope cell = enclose(f_.expression().tape(), variables_of(line_), a_, to);
  continuity_ = cell.value.continuity;
  if (continuity_ == Continuity::undefined) {
    advance(to, {});
    return Verdict::advanced;
  }
  if (!has_zero(cell.value)) {
    const bool positive = cell.value.lower > 0.0;
    advance(to, {positive ? 1 : -1, positive ? cell.value.lower : -cell.value.upper, false});
    return Verdict::advanced;
  }
  if (continuity_ != Continuity::continuous || at_a_.sign == 0) return Verdict::split;
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

/// Whether rounding hides something of f all over [a_, to]. One or two points may lie on roots by chance;
/// these four do not.
bool RootWalk::everywhere(double to, bool PointValue::*what) {
  const double length = to - a_;
  return at_a_.*what && at(to).*what && at(a_ + 0.5 * length).*what && at(a_ + uneven * length).*what &&
         at(a_ + 0.8090169943749475 * length).*what;
}

/// Whether the cell [a_, to] lies close behind a stretch that is hidden, and f leaves zero little by little.
bool RootWalk::beside_zone(double to) const {
  const double core = zone_core_ - zone_start_;
  return in_zone_ && to - a_ <= 0.25 * core && a_ - zone_core_ < core &&
         RootEvidence(f_, line_).rises_slowly(zone_core_, to);
}

/// What is to be done about a cell of which nothing could be said.
RootWalk::Outlook RootWalk::outlook(double to, bool fine) {
  const double length = to - a_;
  const bool smallest = !(length > smallest_cell(a_, to));
  if (continuity_ == Continuity::continuous) {
    const bool hidden = smallest || fine || everywhere(to, &PointValue::hidden);
    return hidden ? Outlook::zone : Outlook::divide;
  }
  // A pole, a jump or the edge of a domain is no surface, nor is a piece on which f may be defined nowhere.
  const bool jump = smallest || !(length > jump_cell_) || everywhere(to, &PointValue::doubtful);
  return jump ? Outlook::drop : Outlook::divide;
}

void RootWalk::count_cell() {
  if (cells_left_ > 0 && --cells_left_ == 0) least_cell_ = (end_ - a_) / last_cells;
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

/// A crossing was found behind a_.
bool RootWalk::meet_crossing(Root& root) {
  if (root.t < line_.from || root.t > line_.to) {
    negative_ = root.sign_after < 0;
    return false;
  }
  if (!in_zone_) return true;
  const Root crossing = root;
  const bool before = end_zone(root);  // comes first
  if (!before) root = crossing;
  if (before) hold(crossing);
  return true;
}

bool RootWalk::find(Root& root) {
  if (held_count_ > 0) {
    root = held_[0];
    held_[0] = held_[1];
    --held_count_;
    return true;
  }
  while (a_ < end_) {
    if (in_zone_ && at_a_.sign != 0 && a_ - zone_core_ >= zone_core_ - zone_start_ && end_zone(root)) {
      return true;
    }
    double to = std::min(a_ + step_, end_);
    // A scrap at the end is taken along, unless that would undo a division.
    if (end_ - to < std::min(0.5 * step_, smallest_cell(to, end_))) to = end_;
    count_cell();
    const double length = to - a_;
    const bool fine = beside_zone(to);
    const double begin = a_;
    const Verdict verdict = try_cell(to, root);
    if (verdict == Verdict::crossing) {
      if (meet_crossing(root)) return true;
      continue;
    }
    if (verdict == Verdict::split) {
      const Outlook what = outlook(to, fine);
      if (what == Outlook::divide) {
        step_ = length * (at(a_ + 0.5 * length).undetermined ? uneven : 0.5);
        continue;
      }
      if (what == Outlook::zone) add_to_zone(to, at(to), !fine || !(length > smallest_cell(a_, to)));
      advance(to, at(to));
    }
    // No root is looked for across a place where f is not continuous.
    if (continuity_ != Continuity::continuous && in_zone_ && end_zone(root)) return true;
    if (jumped(begin, root)) return true;
  }
  return in_zone_ && end_zone(root);
}

}  // namespace backlight
