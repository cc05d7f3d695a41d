#include "root_evidence.h"

#include <algorithm>
#include <cmath>

#include "backlight/expression/enclosure.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// f is said to come down to zero where it is this many times smaller than beside it. About a simple root or
/// a kink it grows as the distance, about a double one as its square; about a pole or a jump it does not.
constexpr double growth = 8.0;
/// f may be zero where it is less than this many times its rounding.
constexpr double hiding = 8.0;
/// At a face f gets this many times larger within a small part of the stretch on which it is hidden.
constexpr double steep = 64.0;
/// How far beside a place f is looked at, in resolutions or in lengths of the stretch that is hidden.
constexpr double next = 16.0;
/// Below this the numbers of a formula have run out of the range of doubles.
constexpr double vanishing = 0x1p-1000;
/// A stretch longer than this part of its coordinates, over which f vanishes so, says nothing of f.
constexpr double long_stretch = 0x1p-10;

double most(const Interval& i) {
  return std::max(std::abs(i.lower), std::abs(i.upper));
}
double least(const Interval& i) {
  return std::max({0.0, i.lower, -i.upper});
}
bool is_continuous(const Interval& i) {
  return i.continuity == Continuity::continuous;
}

}  // namespace

bool RootEvidence::matters(std::size_t variable) const {
  return line_.direction[variable] != 0.0 && (variable != ImplicitFormula::t || f_.uses_time());
}

double RootEvidence::resolution(double s) const {
  double size = std::abs(s);
  for (std::size_t i = 0; i < ImplicitFormula::variables; ++i) {
    if (matters(i)) size = std::max(size, std::abs(line_.origin[i]));
  }
  return 16.0 * epsilon * size;
}

double RootEvidence::resolution_of_jumps() const {
  double longest = 0.0;
  for (std::size_t i = 0; i < ImplicitFormula::variables; ++i) {
    if (matters(i)) longest = std::max(longest, std::abs(line_.origin[i] / line_.direction[i]));
  }
  return 2.0 * epsilon * longest;
}

/// f where the line is rounded to doubles: what is left of its bounds is the rounding of f alone, without
/// that of the place.
Interval RootEvidence::at_double(double s) const {
  std::array<Interval, ImplicitFormula::variables> place;
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = point(line_.origin[i] + s * line_.direction[i]);
  return enclose(f_.expression().tape(), place);
}

Interval RootEvidence::over(double from, double to) const {
  const VariableLine line{line_.origin, line_.direction};
  return enclose(f_.expression().tape(), line, std::min(from, to), std::max(from, to)).value;
}

/// What f does beside a place where it is as small as `least_found`.
RootEvidence::Side RootEvidence::beside(double end, int side, double length, double least_found) const {
  const double nearest = next * resolution(end);
  if (!is_continuous(over(end, end + side * nearest))) return Side::broken;
  for (const double part : {0.0, 0x1p-8, 0x1p-4, 0x1p4, 0x1p8, 0x1p12}) {
    const double far = end + side * std::max(nearest, part * std::max(length, 0.0625 * nearest));
    const Interval there = at_double(far);
    if (is_continuous(there) && least(there) >= growth * least_found && least(there) > 0.0 &&
        is_continuous(over(end, far))) {
      return Side::falling;
    }
  }
  return Side::level;
}

bool RootEvidence::vanishes(double from, double to) const {
  if (!(to - from > long_stretch / (next * epsilon) * resolution(from))) return false;
  for (const double part : {0.25, 0.5, 0.75}) {
    const Interval value = at_double(from + part * (to - from));
    if (!(most(value) > 0.0 && most(value) < vanishing)) return false;
  }
  return true;
}

bool RootEvidence::comes_to_zero(double from, double to) const {
  double least_found = infinity;
  bool hidden = false;
  for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Interval value = at_double(from + part * (to - from));
    if (!is_continuous(value)) continue;
    least_found = std::min(least_found, most(value));
    hidden = hidden || least(value) <= hiding * (value.upper - value.lower);
  }
  if (!(least_found < infinity)) return false;
  const Side before = beside(from, -1, to - from, least_found);
  const Side behind = beside(to, 1, to - from, least_found);
  if (before == Side::broken || behind == Side::broken) return false;
  if (before == Side::falling && behind == Side::falling) return true;
  return hidden && (before == Side::falling || behind == Side::falling);
}

bool RootEvidence::leaves_at_once(double end, int side, double length) const {
  const double distance = 0x1p-10 * length;
  if (distance < next * resolution(end)) return false;
  return !rises_slowly(end, end + side * distance);
}

bool RootEvidence::rises_slowly(double from, double to) const {
  const Interval there = at_double(to);
  return !is_continuous(there) || !(least(there) > 0.0 && least(there) >= steep * most(at_double(from)));
}

/// Whether f is all but straight over the piece, which is then where its slope has a sign.
bool RootEvidence::is_steady(double from, double to, int& sign) const {
  const VariableLine line{line_.origin, line_.direction};
  const IntervalSlope piece = enclose(f_.expression().tape(), line, from, to);
  const double low = std::min(std::abs(piece.slope.lower), std::abs(piece.slope.upper));
  sign = piece.slope.lower > 0.0 ? 1 : piece.slope.upper < 0.0 ? -1 : 0;
  return is_continuous(piece.value) && sign != 0 && most(piece.slope) <= 1.5 * low;
}

bool RootEvidence::goes_through(double from, double to) const {
  const double length = next * std::max(resolution(from), to - from);
  int before = 0;
  int behind = 0;
  return is_steady(from - length, from, before) && is_steady(to, to + length, behind) && before == behind;
}

}  // namespace backlight
