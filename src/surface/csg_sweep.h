// The crossings of the boundary of a solid along a line, in order.
#pragma once

#include <vector>

#include "body_lanes.h"
#include "csg_insides.h"
#include "csg_solid.h"
#include "solid_walk.h"
#include "surface_point.h"

namespace backlight {

/// Goes along the line of the whole. No part is asked before the line gets to its bounding sphere, none for
/// more than its next crossing, and a formula only once it matters whether the line is inside it: what the
/// answer does not depend on is not looked at.
///
/// What formulas are asked is answered from outside, for many lines at once; then the line is gone along
/// again, by the same steps, with what is known. A sweep is begun again for the next line: sizes settle after
/// the first few, and from then on nothing is allocated.
class Sweep {
 public:
  /// A crossing of one part, at t along the line of the whole.
  struct Event {
    double t;
    int leaf;
    SolidWalk::Kind kind;
    Crossing crossing;  ///< along the part's own line
    /// The whole is on the other side of the surface than the part is (or, of a subtracted part, is not):
    /// of coincident faces, another one bounds the whole.
    bool turned = false;
  };
  enum class Found : std::uint8_t { nothing, crossing, question };

  /// Where along line `index` the leaves that move can be.
  struct Moving {
    const LineStretches* of_leaf;
    std::size_t index;
  };

  void begin(const Solid& solid, const LocalLine& line, double lambda_min, const Moving& moving);

  /// The first crossing of the boundary of the whole beyond lambda_min; or what is asked has to be answered
  /// first.
  Found first(Event& crossing);

  /// Of a question: what is asked, and of which leaf.
  [[nodiscard]] SolidWalk& asked() { return asked_->walk; }
  [[nodiscard]] int asked_leaf() const { return asked_->leaf; }

 private:
  /// A leaf whose bounding sphere the line meets, and what comes next of it.
  struct Part {
    enum class Next : std::uint8_t {
      nothing,
      bounds,   ///< its bounding sphere, at t: it is not asked yet
      unknown,  ///< not before t
      event
    };
    int leaf;
    double meets;  ///< its bounding sphere, along the line of the whole
    bool begun;    ///< its walk along its own line, from `from` on
    LocalLine line;
    double from;
    Stretch within;  ///< along its own line
    SolidWalk walk;
    Next next;
    double t;
    Event event;
  };

  [[nodiscard]] const PlacedSurface& surface(int leaf) const;
  [[nodiscard]] double margin_at(int leaf, double t) const;
  void add_part(int leaf, double meets);
  void add_moving_part(int leaf, const Moving& moving);
  bool next(Event& crossing);
  Part* nearest(int but_leaf = -1);
  Part* nearest_event();
  bool look_at(Part& part);
  void reach(Part& part);
  void begin_walk(Part& part);
  void ask(Part& part);
  bool ask_what_matters();
  void go_on(Part& part);
  bool take(Event& event);
  bool take_coincident(Event& event, Event& crossing);
  [[nodiscard]] bool are_close(const Event& event, const Part& other) const;
  [[nodiscard]] bool coincide(const Event& a, const Event& b);
  [[nodiscard]] SurfacePoint point(const Event& event);
  Part& part(int leaf);

  const Solid* solid_ = nullptr;
  LocalLine line_;
  double lambda_min_ = 0.0;
  double from_ = 0.0;
  double reached_ = 0.0;
  std::vector<Part> parts_;  // in the order of the leaves; `count_` of them
  std::size_t count_ = 0;
  std::vector<int> put_off_;  // formulas that did not matter when the line got to them
  Insides insides_;
  Part* asked_ = nullptr;
};

/// The parameter along a part's line of the point at t along that of the whole.
inline double parameter_of(const LocalLine& part, double t) {
  return (t - part.lambda_centre - part.lambda_shift) / part.lambda_per_length;
}

}  // namespace backlight
