// The crossings of one solid along a line, one after the other: what CSG merges.
#pragma once

#include <cstdint>
#include <optional>

#include "convex.h"
#include "implicit_roots.h"
#include "shape_table.h"

namespace backlight {

/// Finds the crossings as they are asked for: a formula may have many, and only those up to the first of the
/// whole count. A walk is begun again for the next line; it allocates nothing.
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

  /// All crossings of a shape that has few.
  void begin(const Crossings& all);

  /// Those of f = 0 inside its bounds, which close it where they cut the inside. Crossings before `from` may
  /// be left out, when the sign of f is certain there. `keeps_touches`: unresolved roots at which f does not
  /// change its sign are events.
  void begin(const ImplicitFormula& f, const FormulaLine& line, const Stretch& bounds, double from,
             bool keeps_touches);

  /// Whether the line comes from inside: before the first event.
  [[nodiscard]] bool inside_before() const { return inside_before_; }

  /// False: there are no more. The events come in order of t.
  bool next(Event& event);

 private:
  void become(bool inside, double t, int part);
  void add(const Crossing& crossing, Kind kind);
  void go_on();

  bool inside_before_ = false;
  bool inside_ = false;  // behind the last event that was found
  bool keeps_touches_ = false;
  double reached_ = -infinite;
  std::optional<RootWalk> roots_;  // of a formula whose end is not yet reached
  Stretch bounds_;
  Event found_[4];  // not yet asked for: from next_ on
  int next_ = 0;
  int count_ = 0;
};

}  // namespace backlight
