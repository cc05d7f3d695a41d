// The roots of a formula along a line, in order, with none missed and none invented (docs/implicit.md).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "backlight/surface/implicit.h"
#include "backlight/surface/shape.h"

namespace backlight {

/// Variable i of the formula (x, y, z, time) is origin[i] + s direction[i] at the line's parameter s. The
/// origin is best near the surface (local_line.h), and s a length.
struct FormulaLine {
  std::array<double, ImplicitFormula::variables> origin{};
  std::array<double, ImplicitFormula::variables> direction{};
};

enum class RootKind : std::uint8_t {
  crossing,    ///< one root, or the end of a stretch of them, at which f certainly gets to 0
  unresolved,  ///< f comes to 0 continuously, and rounding hides whether it touches it, and how often
  jump         ///< no root: f becomes negative, or ceases to be, at a pole, a jump or the edge of its domain
};

/// Whether RootWalk tells of jumps.
enum class Jumps : std::uint8_t { ignore, report };

/// A root at s = t.
struct Root {
  double t = 0.0;
  RootKind kind = RootKind::crossing;
  /// The signs of f just before and after: -1 inside, 1 outside, 0 unknown (the edge of a domain, or a whole
  /// stretch where f is 0, at whose ends there are crossings). A crossing has different ones. An unresolved
  /// root with equal signs is a touching (or a near miss, or an even number of roots); with different signs
  /// there are an odd number of roots in the enclosure.
  int sign_before = 0;
  int sign_after = 0;
  /// Where the root is. Of a crossing: the bracket in which it was found, where f is monotone; t is then as
  /// good as double precision evaluation of f allows, which is a few ulp where f is well conditioned.
  double lower = 0.0;
  double upper = 0.0;
};

/// A piece of a line: s from `from` to `to`.
struct LinePiece : FormulaLine {
  double from = 0.0;
  double to = 0.0;
  int sign = 0;  ///< of f at `from`; 0: not known
};

/// Pieces below this are not divided: a few roundings of the coordinates on the piece.
double least_length(const LinePiece& piece);

/// "None": t = infinity.
inline Root no_root() {
  return {std::numeric_limits<double>::infinity()};
}
/// "Not found out": t is not a number.
inline Root given_up() {
  return {std::numeric_limits<double>::quiet_NaN()};
}
inline bool is_given_up(const Root& root) {
  return std::isnan(root.t);
}
inline bool found(const Root& root) {
  return root.t < std::numeric_limits<double>::infinity();
}

/// How much work a search was; for the choice between searches, tests and charts.
struct RootWork {
  std::size_t cells = 0;         ///< pieces of the line over which f and its slope were enclosed
  std::size_t points = 0;        ///< points at which f was enclosed
  std::size_t polish = 0;        ///< evaluations of f and its slope in double precision
  std::size_t forms = 0;         ///< pieces over which f was enclosed by an affine form
  std::size_t without_form = 0;  ///< those of them where there was none
  std::size_t polynomials = 0;   ///< lines along which the polynomial was found
  std::size_t parts = 0;         ///< pieces over which such a one was looked at
  std::size_t walked = 0;        ///< all of these that were done one line at a time, by RootWalk
  std::size_t given_up = 0;      ///< lines that were left to RootWalk
  /// Such lines are counted, and have no root. Lines of more than 200 pieces are among them.
  bool only_count = false;
};

/// Whether it matters where the first root is, or only whether there is any: then t is anywhere on the piece,
/// and the root may be another one than the first.
enum class RootsWanted : std::uint8_t { places, existence };

/// The first root on each piece, or no_root(), or given_up(), where RootWalk has to look. The lines are
/// searched side by side, over lanes; what is found of one does not depend on the others (line_search.h). A
/// root's enclosure ends where the sign behind it is certain: the search for the next one may begin there.
/// `finder`: interval, affine, or, for a formula that has a LineProgram::degree(), polynomial. The work is
/// added to `work`.
void search_roots(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                  RootFinder finder, RootWork& work, RootsWanted wanted = RootsWanted::places);

/// The first root on each piece, or no_root(): search_roots(), and RootWalk where that gives up.
void first_roots(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                 RootFinder finder = RootFinder::interval, RootWork* work = nullptr,
                 RootsWanted wanted = RootsWanted::places);

/// Adds a root to what roots_solved_by_this_thread() says (surface/implicit_surface.h).
void count_root_solved();

/// Lines on which f has more pieces are RootWalk's.
inline int most_pieces(const RootWork& work) {
  return work.only_count ? 200 : 2000;
}

/// Walks the roots one after the other: `next` finds the first one beyond those found before.
class RootWalk {
 public:
  RootWalk(const ImplicitFormula& f, const LinePiece& piece, Jumps jumps = Jumps::ignore);

  /// False: there are no more.
  bool next(Root& root);

  /// The sign of f where the walk began: -1, 1 or 0 if unknown.
  [[nodiscard]] int sign_at_start() const { return sign_at_start_; }

  [[nodiscard]] const RootWork& work() const { return work_; }

 private:
  /// f at one point: its sign if certain, and how far from 0 it certainly is.
  struct PointValue {
    int sign = 0;
    double least = 0.0;
    bool undetermined = false;  ///< continuous, and nothing but rounding hides the sign
    bool hidden = false;        ///< the same, or nearly so
    bool doubtful = false;      ///< rounding hides whether f is defined at all
  };

  PointValue at(double s);
  PointValue look_at(double s);
  /// Moves s outwards (side = ±1) until the sign of f there is certain, if it soon is.
  double settle(double s, int side);
  [[nodiscard]] double smallest_cell(double from, double to) const;
  void advance(double to, const PointValue& there);
  bool end_zone(Root& root);
  bool report_zone(Root& root);
  void hold(const Root& root);
  void add_to_zone(double to, const PointValue& there, bool core);
  bool changes_sign(double to);
  Root polished(double low, double high, int sign_low) const;
  [[nodiscard]] bool wanted(const Root& root) const {
    return root.upper >= line_.from && root.lower <= line_.to;
  }
  bool find(Root& root);
  bool jumped(double at, Root& root);
  enum class Verdict { advanced, crossing, split };
  Verdict try_cell(double to, Root& root);
  bool meet_crossing(Root& root);
  enum class Outlook { divide, zone, drop };
  Outlook outlook(double to, bool fine);
  [[nodiscard]] bool beside_zone(double to) const;
  bool everywhere(double to, bool PointValue::*what);
  void count_cell();

  const ImplicitFormula& f_;
  const LinePiece line_;
  double start_, end_;  // a little wider than the piece, at points where the sign of f is certain
  double a_;            // everything before is done
  double step_;         // of the next cell
  PointValue at_a_;
  std::array<std::pair<double, PointValue>, 2> recent_{
      {{std::numeric_limits<double>::quiet_NaN(), {}}, {std::numeric_limits<double>::quiet_NaN(), {}}}};
  std::size_t next_recent_ = 0;
  int sign_at_start_ = 0;
  const Jumps jumps_;
  bool negative_ = false;  // f, behind what was told last
  // An unresolved root that is being collected. Close behind its last cell, rounding may hide f again: only a
  // gap of its own length ends it.
  bool in_zone_ = false;
  double zone_start_ = 0.0;
  double zone_core_ = 0.0;  // the end of its last cell in which rounding hides f all over
  double zone_end_ = 0.0;
  int sign_before_zone_ = 0;
  int sign_after_zone_ = 0;
  bool zone_has_root_ = false;  // f changes its sign in a cell of it, continuously
  // Found together with the one before: the end of a stretch of roots, and a crossing behind an open zone.
  std::array<Root, 2> held_;
  std::size_t held_count_ = 0;
  Continuity continuity_ = Continuity::continuous;  // of f over the cell that was looked at last
  double jump_cell_ = 0.0;   // a cell in which f is not continuous is not divided further than this
  double least_cell_ = 0.0;  // nor any cell further than this
  std::size_t cells_left_;
  mutable RootWork work_;
};

}  // namespace backlight
