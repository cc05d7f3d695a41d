#include "solid_walk.h"

#include <algorithm>

namespace backlight {

void SolidWalk::begin(const Crossings& all) {
  begin(std::span(all.list, static_cast<std::size_t>(all.count)));
  inside_before_ = all.inside_before;
}

void SolidWalk::begin(std::span<const Crossing> all) {
  asks_ = Asks::nothing;
  roots_.reset();
  inside_before_ = false;
  next_ = 0;
  events_.clear();
  for (const Crossing& crossing : all) events_.push_back({crossing, Kind::crossing});
}

void SolidWalk::begin(const ImplicitFormula& f, const FormulaLine& line, const Stretch& bounds, double from,
                      bool keeps_touches) {
  begin(Crossings{});
  inside_ = false;
  keeps_touches_ = keeps_touches;
  reached_ = -infinite;
  bounds_ = bounds;
  f_ = &f;
  if (!(bounds.in < bounds.out) || from >= bounds.out) return;
  piece_ = {line, std::max(from, bounds.in), bounds.out};
  asks_ = Asks::sign;
}

void SolidWalk::sign_is(int sign) {
  if (piece_.from > bounds_.in) {
    if (sign == 0) {
      piece_.from = bounds_.in;
      return;
    }
    inside_before_ = inside_ = sign < 0;
  }
  piece_.sign = sign;
  if (sign == 0) return begin_roots();
  become(sign < 0, piece_.from, bounds_.part_in);
  asks_ = Asks::root;
}

void SolidWalk::root_is(const Root& root) {
  if (is_given_up(root)) return begin_roots();
  if (!found(root)) return finish();
  count_root_solved();
  add({root.t, 0, false}, Kind::crossing);
  inside_ = root.sign_after < 0;
  // Where the bracket ends the sign is certain.
  piece_.from = root.upper;
  piece_.sign = root.sign_after;
  if (!(piece_.from < piece_.to)) finish();
}

void SolidWalk::begin_roots() {
  asks_ = Asks::nothing;
  roots_ = std::make_unique<RootWalk>(*f_, piece_, Jumps::report);
  if (piece_.sign == 0) become(roots_->sign_at_start() < 0, piece_.from, bounds_.part_in);
}

void SolidWalk::add(const Crossing& crossing, Kind kind) {
  reached_ = std::max(reached_, crossing.t);
  events_.push_back({{reached_, crossing.part, crossing.unresolved}, kind});
}

void SolidWalk::become(bool inside, double t, int part) {
  if (inside != inside_) add({t, part, false}, Kind::crossing);
  inside_ = inside;
}

void SolidWalk::finish() {
  asks_ = Asks::nothing;
  roots_.reset();
  become(false, bounds_.out, bounds_.part_out);
}

/// Looks for the next root, and adds what it means.
void SolidWalk::go_on() {
  Root root;
  if (!roots_->next(root)) return finish();
  const bool inside = root.sign_after < 0;
  const bool touch = inside == inside_;
  inside_ = inside;
  if (root.kind == RootKind::jump) return add({root.t, 0, false}, Kind::jump);
  count_root_solved();
  const bool unresolved = root.kind == RootKind::unresolved;
  if (touch && unresolved && !keeps_touches_) return;
  add({root.t, 0, unresolved}, touch ? Kind::touch : Kind::crossing);
}

bool SolidWalk::next(Event& event) {
  while (next_ == events_.size()) {
    if (!roots_) return false;
    go_on();
  }
  event = events_[next_++];
  return true;
}

}  // namespace backlight
