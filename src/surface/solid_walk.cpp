#include "solid_walk.h"

#include <algorithm>

namespace backlight {

void SolidWalk::begin(const Crossings& all) {
  roots_.reset();
  inside_before_ = all.inside_before;
  next_ = 0;
  count_ = all.count;
  for (int i = 0; i < all.count; ++i) found_[i] = {all.list[i], Kind::crossing};
}

void SolidWalk::begin(const ImplicitFormula& f, const FormulaLine& line, const Stretch& bounds, double from,
                      bool keeps_touches) {
  roots_.reset();
  inside_before_ = inside_ = false;
  keeps_touches_ = keeps_touches;
  next_ = count_ = 0;
  reached_ = -infinite;
  bounds_ = bounds;
  if (!(bounds.in < bounds.out) || from >= bounds.out) return;
  if (from > bounds.in) {
    roots_.emplace(f, line, from, bounds.out, Jumps::report);
    const int sign = roots_->sign_at_start();
    inside_before_ = inside_ = sign < 0;
    if (sign != 0) return;
  }
  roots_.emplace(f, line, bounds.in, bounds.out, Jumps::report);
  become(roots_->sign_at_start() < 0, bounds.in, bounds.part_in);
}

void SolidWalk::add(const Crossing& crossing, Kind kind) {
  reached_ = std::max(reached_, crossing.t);
  found_[count_++] = {{reached_, crossing.part, crossing.unresolved}, kind};
}

void SolidWalk::become(bool inside, double t, int part) {
  if (inside != inside_) add({t, part, false}, Kind::crossing);
  inside_ = inside;
}

/// Looks for the next root, and adds what it means.
void SolidWalk::go_on() {
  next_ = count_ = 0;
  Root root;
  if (!roots_->next(root)) {
    roots_.reset();
    become(false, bounds_.out, bounds_.part_out);
    return;
  }
  const bool inside = root.sign_after < 0;
  if (root.kind == RootKind::jump) {
    add({root.t, 0, false}, Kind::jump);
    inside_ = inside;
    return;
  }
  count_root_solved();
  const bool unresolved = root.kind == RootKind::unresolved;
  const bool touch = inside == inside_;
  if (!touch || keeps_touches_ || !unresolved)
    add({root.t, 0, unresolved}, touch ? Kind::touch : Kind::crossing);
  inside_ = inside;
}

bool SolidWalk::next(Event& event) {
  while (next_ == count_) {
    if (!roots_) return false;
    go_on();
  }
  event = found_[next_++];
  return true;
}

}  // namespace backlight
