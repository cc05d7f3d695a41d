// The search for the first root along one line, as a machine that asks for bounds and is told them: so that
// many can be run side by side, and each does the same whether it is alone or not.
//
// It goes the way of RootWalk (implicit_roots.h) as long as that is easy: pieces without a root, pieces with
// certain signs at their ends. At the first difficulty (rounding hides a sign, f is not continuous, a piece
// becomes too small) it gives up, and the line is RootWalk's.
#pragma once

#include "backlight/expression/interval.h"
#include "implicit_roots.h"

namespace backlight {

class LineSearch {
 public:
  /// The piece must outlive the search.
  LineSearch(const LinePiece& piece, int most_steps);

  [[nodiscard]] const LinePiece& piece() const { return *piece_; }
  [[nodiscard]] bool is_finished() const { return state_ >= State::without_root; }
  [[nodiscard]] bool has_given_up() const { return state_ == State::given_up; }
  /// The root, if one was found: it is enclosed, and t is where Newton's steps may begin.
  [[nodiscard]] bool has_root() const { return state_ == State::with_root; }
  [[nodiscard]] const Root& root() const { return root_; }

  // What is to be computed next: f and its slope on [begin, end], or f at `point`.
  [[nodiscard]] bool asks_piece() const { return state_ == State::piece; }
  [[nodiscard]] bool asks_point() const { return state_ == State::at_begin || state_ == State::at_end; }
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return end_; }
  [[nodiscard]] double point() const { return point_; }

  void piece_is(const Interval& value, double slope_lower, double slope_upper);
  void point_is(const Interval& value);

 private:
  enum class State { piece, at_begin, at_end, without_root, with_root, given_up };

  void ask_point(State state, double at);
  void both_ends_known();
  [[nodiscard]] bool stays_off_zero() const;
  void divide(double part);
  void advance(int sign, double size);
  void enclose_root();

  const LinePiece* piece_;
  State state_ = State::piece;
  double begin_, end_;
  double step_;   ///< length of the next piece
  double least_;  ///< pieces are not made shorter: a few roundings of the coordinates
  double point_ = 0.0;
  int steps_left_;

  // The sign of f at the ends, 0 if not known, and a lower bound of |f| there.
  int sign_begin_ = 0;
  int sign_end_ = 0;
  double size_begin_ = 0.0;
  double size_end_ = 0.0;
  double slope_lower_ = 0.0;
  double slope_upper_ = 0.0;
  bool shortened_ = false;

  Root root_;
};

}  // namespace backlight
