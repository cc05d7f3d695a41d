#include "line_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace backlight {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The first piece is this part of the whole, and each next one this much longer than the last that was
/// settled whole. Chosen by counting pieces on surfaces of degree 2 to 8 and the gyroid.
constexpr double first_part = 0.125;
constexpr double growth = 1.5;

/// A piece whose end is hidden by rounding is made this much shorter: no simple fraction, so that roots at
/// round numbers are left behind.
constexpr double shorter = 0.61803398874989485;

/// The sign of all numbers in the interval, or 0.
int sign_of(const Interval& value) {
  if (value.continuity >= Continuity::partial) return 0;
  return value.lower > 0.0 ? 1 : value.upper < 0.0 ? -1 : 0;
}

double distance_from_zero(const Interval& value) {
  return std::max({0.0, value.lower, -value.upper});
}

}  // namespace

LineSearch::LineSearch(const LinePiece& piece, int most_steps)
    : piece_(&piece),
      begin_(piece.from),
      end_(piece.from + first_part * (piece.to - piece.from)),
      step_(end_ - begin_),
      least_(least_length(piece)),
      steps_left_(most_steps) {
  if (!(piece.from < piece.to)) state_ = piece.from == piece.to ? State::given_up : State::without_root;
}

void LineSearch::ask_point(State state, double at) {
  state_ = state;
  point_ = at;
}

void LineSearch::piece_is(const Interval& value, double slope_lower, double slope_upper) {
  if (value.continuity >= Continuity::defined || --steps_left_ < 0) {
    state_ = State::given_up;
  } else if (value.lower > 0.0 || value.upper < 0.0) {
    advance(sign_of(value), distance_from_zero(value));
  } else {
    slope_lower_ = slope_lower;
    slope_upper_ = slope_upper;
    sign_begin_ == 0 ? ask_point(State::at_begin, begin_) : ask_point(State::at_end, end_);
  }
}

void LineSearch::point_is(const Interval& value) {
  const int sign = sign_of(value);
  if (state_ == State::at_begin) {
    sign_begin_ = sign == 0 && begin_ == piece_->from ? piece_->sign : sign;
    size_begin_ = distance_from_zero(value);
    sign_begin_ == 0 ? void(state_ = State::given_up) : ask_point(State::at_end, end_);
    return;
  }
  sign_end_ = sign;
  size_end_ = distance_from_zero(value);
  both_ends_known();
}

void LineSearch::both_ends_known() {
  const bool monotone = slope_lower_ > 0.0 || slope_upper_ < 0.0;
  if (sign_end_ == 0) {
    // A root near the end by chance, once; twice, something is hidden.
    shortened_ ? void(state_ = State::given_up) : divide(shorter);
    shortened_ = true;
  } else if (sign_begin_ == sign_end_ && (monotone || stays_off_zero())) {
    advance(sign_end_, size_end_);
  } else if (sign_begin_ != sign_end_ && monotone) {
    enclose_root();
  } else {
    divide(0.5);
  }
}

/// With |f| known at the ends and bounds of the slope between them: where the steepest lines from both ends
/// meet, f has still not come to zero. The room is for the rounding of this very computation.
bool LineSearch::stays_off_zero() const {
  const double down = sign_begin_ > 0 ? slope_lower_ : -slope_upper_;
  const double up = sign_begin_ > 0 ? slope_upper_ : -slope_lower_;
  const double width = end_ - begin_;
  const double meeting = (size_begin_ - size_end_ + up * width) / (up - down);
  const double within = std::clamp(meeting, 0.0, width);
  const double room = 16.0 * epsilon * (size_begin_ + size_end_ + (up - down) * width);
  return size_begin_ + down * within > room && size_end_ - up * (width - within) > room;
}

void LineSearch::divide(double part) {
  step_ = part * (end_ - begin_);
  end_ = begin_ + step_;
  state_ = step_ > least_ ? State::piece : State::given_up;
}

/// On to the next piece, from where f has this sign and at least this size.
void LineSearch::advance(int sign, double size) {
  step_ = growth * (end_ - begin_);
  begin_ = end_;
  sign_begin_ = sign;
  size_begin_ = size;
  shortened_ = false;
  end_ = begin_ + step_;
  if (!(end_ + 0.25 * step_ < piece_->to)) end_ = piece_->to;
  state_ = begin_ < piece_->to ? State::piece : State::without_root;
}

/// There is one root between the ends, and f is monotone there.
void LineSearch::enclose_root() {
  // Where the secant through what is known of both ends meets zero.
  const double part = std::clamp(size_begin_ / (size_begin_ + size_end_), 0.01, 0.99);
  const double secant = begin_ + part * (end_ - begin_);
  const double start = secant > begin_ && secant < end_ ? secant : 0.5 * begin_ + 0.5 * end_;
  root_ = {start, RootKind::crossing, sign_begin_, sign_end_, begin_, end_};
  state_ = State::with_root;
}

}  // namespace backlight
