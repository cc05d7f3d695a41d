// The crossings of one part of a solid along a line, one after the other: what CSG merges.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "convex.h"
#include "implicit_roots.h"
#include "shape_table.h"

namespace backlight {

/// The crossings of a closed form are all known from the beginning. Those of a formula, which may be many,
/// are found as they are asked for: the walk puts a question, which is answered together with those of other
/// lines, and keeps what it was told. So it can be gone along again, as far as it is known.
class SolidWalk {
 public:
  enum class Kind : std::uint8_t {
    crossing,
    touch,  ///< the line meets the surface without getting to its other side
    jump    ///< it gets to the other side where there is no surface: at a pole, or the edge of a domain
  };
  struct Event {
    Crossing crossing;
    Kind kind = Kind::crossing;
  };
  /// What has to be answered before the walk goes on: the sign of f where the piece `question` begins, by
  /// bounds; or its first root there, by search_roots().
  enum class Asks : std::uint8_t { nothing, sign, root };

  /// All crossings of a shape that has few.
  void begin(const Crossings& all);
  /// All crossings of a shape that no line comes from inside, in their order.
  void begin(std::span<const Crossing> all);

  /// Those of f = 0 inside its bounds, which close it where they cut the inside. Crossings before `from` may
  /// be left out, when the sign of f is certain there. `keeps_touches`: unresolved roots at which f does not
  /// change its sign are events.
  void begin(const ImplicitFormula& f, const FormulaLine& line, const Stretch& bounds, double from,
             bool keeps_touches);

  [[nodiscard]] Asks asks() const { return asks_; }
  [[nodiscard]] const LinePiece& question() const { return piece_; }
  /// The answer, or 0.
  void sign_is(int sign);
  /// The answer.
  void root_is(const Root& root);

  /// Whether the line comes from inside: before the first event. Known when no sign is asked.
  [[nodiscard]] bool inside_before() const { return inside_before_; }

  /// Back to before the first event.
  void rewind() { next_ = 0; }
  /// False: there are no more, or, if something is asked, none is known. The events come in order of t.
  bool next(Event& event);

 private:
  void become(bool inside, double t, int part);
  void add(const Crossing& crossing, Kind kind);
  void begin_roots();
  void go_on();
  void finish();

  Asks asks_ = Asks::nothing;
  bool inside_before_ = false;
  bool inside_ = false;  // behind the last event that was found
  bool keeps_touches_ = false;
  double reached_ = -infinite;
  const ImplicitFormula* f_ = nullptr;
  LinePiece piece_;                  // what is still to be searched
  std::unique_ptr<RootWalk> roots_;  // along what is left of a line that the searches gave up
  Stretch bounds_;
  std::vector<Event> events_;
  std::size_t next_ = 0;
};

}  // namespace backlight
