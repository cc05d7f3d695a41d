// The crossings of the boundary of a solid along a line, in order.
#pragma once

#include <vector>

#include "csg_insides.h"
#include "csg_solid.h"
#include "solid_walk.h"
#include "surface_point.h"

namespace backlight {

/// Goes along the line of the whole, from the parameter `from` on. No part is asked before the line gets to
/// its bounding sphere, none for more than its next crossing, and a formula only once it matters whether the
/// line is inside it: what the answer does not depend on is not looked at.
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

  /// What comes next of a leaf: an event, or its bounding sphere, when the leaf is not yet asked.
  struct Next {
    Event event;
    bool asked;
  };

  /// What a thread needs for one line; used again for the next.
  struct Scratch {
    std::vector<SolidWalk> walks;  ///< of each leaf
    std::vector<Next> heap;        ///< the nearest on top
    std::vector<int> put_off;      ///< formulas that did not matter when the line got to them
    Insides insides;
  };

  Sweep(const Solid& solid, const LocalLine& line, double from, Scratch& scratch);

  /// The next crossing of the boundary of the whole; false: there are no more. Crossings before `from` may be
  /// left out.
  bool next(Event& crossing);

 private:
  [[nodiscard]] const PlacedSurface& surface(int leaf) const;
  void push(const Next& next);
  void pop();
  void reach(int leaf);
  void ask(int leaf);
  bool ask_what_matters();
  void push_next(int leaf, const LocalLine& line, double from);
  const Event* peek();
  bool take(Event& event);
  [[nodiscard]] bool coincide(const Event& a, const Event& b) const;
  [[nodiscard]] SurfacePoint point(const Event& event) const;

  const Solid& solid_;
  const LocalLine& line_;
  RestRay ray_;
  double reached_;
  Scratch& s_;
};

/// The parameter along a part's line of the point at t along that of the whole.
inline double parameter_of(const LocalLine& part, double t) {
  return (t - part.lambda_centre - part.lambda_shift) / part.lambda_per_length;
}

}  // namespace backlight
