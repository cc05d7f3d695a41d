#include "csg_sweep.h"

#include <algorithm>
#include <cmath>

#include "backlight/surface/matter_motion.h"
#include "shape_table.h"

namespace backlight {
namespace {

/// Rounding of sums of a few terms, relative to the largest of them.
constexpr double rounding_room = 4e-15;

/// Of the angle between a line and coincident faces that are still seen as one.
constexpr double least_cosine = 1e-10;

/// Where the line is inside the bounding sphere of a part; empty: nowhere. Rounding makes it too long, never
/// too short.
Stretch inside_sphere(const LocalLine& line, const Vec3& centre, double radius) {
  Stretch stretch;
  if (std::isinf(radius)) return stretch;
  const Vec3 from = line.point - centre;
  const double middle = -glm::dot(from, line.direction);
  const Vec3 off = from + middle * line.direction;
  const double reach = radius + rounding_room * (std::abs(from.x) + std::abs(from.y) + std::abs(from.z));
  const double square = reach * reach - glm::dot(off, off);
  stretch.close();
  if (!(square >= 0.0)) return stretch;
  const double half = std::sqrt(square) + rounding_room * (std::abs(middle) + reach);
  stretch.in = middle - half;
  stretch.out = middle + half;
  return stretch;
}

double size_of(const PlacedSurface& part) {
  return std::isfinite(part.radius()) ? part.radius() + glm::length(part.position()) : 0.0;
}

}  // namespace

void Sweep::begin(const Solid& solid, const LocalLine& line, double lambda_min, const Moving& moving) {
  solid_ = &solid;
  line_ = line;
  lambda_min_ = lambda_min;
  from_ = parameter_of(line, lambda_min);
  count_ = 0;
  for (std::size_t i = 0; i < solid.leaves().size(); ++i) {
    const Solid::Leaf& leaf = solid.leaves()[i];
    const int index = static_cast<int>(i);
    if (leaf.surface.shape.motion && leaf.surface.shape.motion->box() != nullptr) {
      add_moving_part(index, moving);
      continue;
    }
    const Stretch inside = inside_sphere(line, leaf.surface.position(), leaf.reach);
    if (inside.in <= inside.out && !(inside.out < from_ - margin_at(index, from_)))
      add_part(index, inside.in);
  }
}

void Sweep::add_part(int leaf, double meets) {
  if (count_ == parts_.size()) parts_.emplace_back();
  Part& part = parts_[count_++];
  part.leaf = leaf;
  part.meets = meets;
  part.begun = false;
  part.within = {};
}

void Sweep::add_moving_part(int leaf, const Moving& moving) {
  const LineStretches& its = moving.of_leaf[leaf];
  Stretch within;
  within.in = its.in[moving.index];
  within.out = its.out[moving.index];
  if (!(within.in <= within.out)) return;
  const LocalLine own = local_line({line_.point, line_.direction, line_.clock}, surface(leaf));
  if (own.lambda(within.out) < from_ - margin_at(leaf, from_)) return;
  add_part(leaf, own.lambda(within.in));
  parts_[count_ - 1].within = within;
}

Sweep::Found Sweep::first(Event& crossing) {
  asked_ = nullptr;
  reached_ = from_;
  put_off_.clear();
  insides_.begin(*solid_);
  for (std::size_t i = 0; i < count_; ++i) {
    parts_[i].next = Part::Next::bounds;
    parts_[i].t = parts_[i].meets;
    parts_[i].walk.rewind();
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (parts_[i].meets < from_) reach(parts_[i]);
  }
  ask_what_matters();
  while (asked_ == nullptr && next(crossing)) {
    if (line_.lambda(crossing.t) > lambda_min_) return Found::crossing;
  }
  return asked_ == nullptr ? Found::nothing : Found::question;
}

const PlacedSurface& Sweep::surface(int leaf) const {
  return solid_->leaves()[static_cast<std::size_t>(leaf)].surface;
}

Sweep::Part& Sweep::part(int leaf) {
  return *std::lower_bound(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(count_), leaf,
                           [](const Part& one, int index) { return one.leaf < index; });
}

/// How far from t faces of this leaf may lie that coincide with others there.
double Sweep::margin_at(int leaf, double t) const {
  return rounding_room / least_cosine * (size_of(surface(leaf)) + std::abs(t) + glm::length(line_.point));
}

/// The part of which something comes next; of equals, the first leaf.
Sweep::Part* Sweep::nearest(int but_leaf) {
  Part* result = nullptr;
  for (std::size_t i = 0; i < count_; ++i) {
    Part& one = parts_[i];
    if (one.next == Part::Next::nothing || one.leaf == but_leaf) continue;
    if (result == nullptr || one.t < result->t) result = &one;
  }
  return result;
}

/// The part of the next event of all; null: there is none, or something is asked.
Sweep::Part* Sweep::nearest_event() {
  for (;;) {
    Part* const result = nearest();
    if (result == nullptr || result->next == Part::Next::event) return result;
    if (!look_at(*result)) return nullptr;
  }
}

/// Finds out what comes of a part that is next without an event. False: something is asked.
bool Sweep::look_at(Part& part) {
  if (part.next == Part::Next::unknown) {
    asked_ = &part;
    return false;
  }
  reached_ = part.t;
  reach(part);
  ask_what_matters();
  return asked_ == nullptr;
}

/// The line gets to a leaf's bounding sphere, or begins inside it.
void Sweep::reach(Part& part) {
  if (methods(surface(part.leaf).shape).begin_walk == nullptr) return ask(part);
  part.next = Part::Next::nothing;
  put_off_.push_back(part.leaf);
  insides_.set(part.leaf, Inside::unknown);
}

/// Begins the walk over a leaf's crossings, a little before the point that is reached: by as much as faces
/// that coincide may lie apart. What comes before is no event, but counts for who is inside what.
void Sweep::begin_walk(Part& part) {
  const Shape& shape = surface(part.leaf).shape;
  part.begun = true;
  part.line = local_line({line_.point, line_.direction, line_.clock}, surface(part.leaf));
  part.from = reached_ > -infinite ? reached_ - margin_at(part.leaf, reached_) : -infinite;
  if (const auto begin = methods(shape).begin_walk; begin != nullptr) {
    begin(shape, part.line, part.from > -infinite ? parameter_of(part.line, part.from) : -infinite,
          part.within, part.walk);
  } else {
    part.walk.begin(crossings(shape, part.line, -infinite, Wanted::all));
  }
}

void Sweep::ask(Part& part) {
  if (!part.begun) begin_walk(part);
  if (part.walk.asks() == SolidWalk::Asks::sign) {
    asked_ = &part;
    return;
  }
  if (part.walk.inside_before()) insides_.toggle(part.leaf);
  go_on(part);
}

/// Asks those formulas that were put off and now matter. False: none did.
bool Sweep::ask_what_matters() {
  bool asked = false;
  for (int leaf = 0; asked_ == nullptr && (leaf = insides_.decisive(put_off_)) >= 0; asked = true) {
    put_off_.erase(std::find(put_off_.begin(), put_off_.end(), leaf));
    insides_.set(leaf, Inside::no);
    ask(part(leaf));
  }
  return asked;
}

/// Finds what comes next of a leaf behind what it told last.
void Sweep::go_on(Part& part) {
  for (SolidWalk::Event found; part.walk.next(found);) {
    part.t = part.line.lambda(found.crossing.t);
    if (part.t >= part.from) {
      part.next = Part::Next::event;
      part.event = {part.t, part.leaf, found.kind, found.crossing};
      return;
    }
    if (found.kind != SolidWalk::Kind::touch) insides_.toggle(part.leaf);
  }
  part.next = Part::Next::nothing;
  if (part.walk.asks() == SolidWalk::Asks::nothing) return;
  part.next = Part::Next::unknown;
  part.t = part.line.lambda(part.walk.question().from);
}

/// Takes the next event of all; false: there are no more, or something is asked. Before that, what matters
/// behind it is asked, since it may have an event here too.
bool Sweep::take(Event& event) {
  for (;;) {
    Part* const next = nearest_event();
    if (next == nullptr) return false;
    event = next->event;
    bool asked = false;
    if (!put_off_.empty()) {
      reached_ = event.t;
      insides_.toggle(event.leaf);
      asked = ask_what_matters();
      insides_.toggle(event.leaf);
    }
    if (asked_ != nullptr) return false;
    if (asked) continue;
    go_on(*next);
    return true;
  }
}

/// The next crossing of the boundary of the whole.
bool Sweep::next(Event& crossing) {
  for (Event event; take(event);) {
    const Inside before = insides_.whole();
    insides_.toggle(event.leaf);
    crossing = event;
    if (event.kind == SolidWalk::Kind::jump) continue;
    if (event.kind == SolidWalk::Kind::touch) {
      const bool changes = insides_.whole() != before;
      insides_.toggle(event.leaf);
      if (changes) return true;
      continue;
    }
    if (!take_coincident(event, crossing)) return false;
    if (insides_.whole() == before) continue;
    const bool subtracted = solid_->leaves()[static_cast<std::size_t>(crossing.leaf)].subtracted;
    const bool inside_leaf = insides_.leaf(crossing.leaf) == Inside::yes;
    crossing.turned = (inside_leaf != subtracted) != (insides_.whole() == Inside::yes);
    return true;
  }
  return false;
}

/// Takes the events behind `event` that are the same crossing: of faces that coincide, the first leaf's is
/// that of the whole. False: something is asked.
bool Sweep::take_coincident(Event& event, Event& crossing) {
  for (;;) {
    Part* const other = nearest(event.leaf);
    if (other == nullptr || !are_close(event, *other)) return true;
    if (other->next != Part::Next::event) {
      if (!look_at(*other)) return false;
      continue;
    }
    if (!coincide(event, other->event)) return true;
    // Between the two there must be nothing else.
    Part& own = part(event.leaf);
    const bool is_before = own.t < other->t || (own.t == other->t && own.leaf < other->leaf);
    if (own.next == Part::Next::unknown && is_before) return look_at(own);
    if ((own.next == Part::Next::event && is_before) || !take(event)) return asked_ == nullptr;
    if (event.leaf < crossing.leaf) crossing = event;
    insides_.toggle(event.leaf);
  }
}

/// Whether a face of another part that comes next may be near enough to be the same one.
bool Sweep::are_close(const Event& event, const Part& other) const {
  const double size =
      size_of(surface(event.leaf)) + size_of(surface(other.leaf)) + glm::length(line_.at(event.t));
  return (other.t - event.t) * least_cosine <= rounding_room * size;
}

/// Whether two parts have a common face here: their points are as near to each other, across the face, as
/// their errors allow, and the normals are parallel.
bool Sweep::coincide(const Event& a, const Event& b) {
  constexpr double parallel = 1e-6;
  if (b.kind != SolidWalk::Kind::crossing) return false;
  const SurfacePoint one = point(a);
  const SurfacePoint other = point(b);
  const double across = (b.t - a.t) * std::min(std::abs(glm::dot(one.normal, line_.direction)),
                                               std::abs(glm::dot(other.normal, line_.direction)));
  return across <= one.error_bound + other.error_bound &&
         glm::length(glm::cross(one.normal, other.normal)) <= parallel;
}

/// The part's surface point of an event, in the coordinates of the whole.
SurfacePoint Sweep::point(const Event& event) {
  const PlacedSurface& leaf = surface(event.leaf);
  return placed_point(leaf, methods(leaf.shape).point(leaf.shape, part(event.leaf).line, event.crossing));
}

}  // namespace backlight
