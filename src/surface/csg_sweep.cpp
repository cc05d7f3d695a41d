#include "csg_sweep.h"

#include <algorithm>
#include <cmath>

#include "shape_table.h"

namespace backlight {
namespace {

/// Rounding of sums of a few terms, relative to the largest of them.
constexpr double rounding_room = 4e-15;

/// Of the angle between a line and coincident faces that are still seen as one.
constexpr double least_cosine = 1e-10;

/// Where the line gets into the bounding sphere of a part; infinity: nowhere. Rounding makes it too early,
/// never too late.
double meets_at(const LocalLine& line, const PlacedSurface& part) {
  if (std::isinf(part.radius())) return -infinite;
  const Vec3 from = line.point - part.position();
  const double middle = -glm::dot(from, line.direction);
  const Vec3 off = from + middle * line.direction;
  const double reach = part.radius() + rounding_room * (std::abs(from.x) + std::abs(from.y) + std::abs(from.z));
  const double square = reach * reach - glm::dot(off, off);
  return square >= 0.0 ? middle - std::sqrt(square) - rounding_room * (std::abs(middle) + reach) : infinite;
}

double size_of(const PlacedSurface& part) {
  return std::isfinite(part.radius()) ? part.radius() + glm::length(part.position()) : 0.0;
}

bool later(const Sweep::Next& a, const Sweep::Next& b) {
  return a.event.t != b.event.t ? a.event.t > b.event.t : a.event.leaf > b.event.leaf;
}

}  // namespace

Sweep::Sweep(const Solid& solid, const LocalLine& line, double from, Scratch& scratch)
    : solid_(solid), line_(line), ray_{line.point, line.direction, line.clock}, reached_(from), s_(scratch) {
  s_.heap.clear();
  s_.put_off.clear();
  s_.insides.begin(solid);
  if (s_.walks.size() < solid.leaves().size()) s_.walks.resize(solid.leaves().size());
  for (std::size_t i = 0; i < solid.leaves().size(); ++i) {
    const double t = meets_at(line, solid.leaves()[i].surface);
    const int leaf = static_cast<int>(i);
    if (t < from) {
      reach(leaf);
    } else if (t < infinite) {
      push({{t, leaf, {}, {}}, false});
    }
  }
  ask_what_matters();
}

const PlacedSurface& Sweep::surface(int leaf) const {
  return solid_.leaves()[static_cast<std::size_t>(leaf)].surface;
}

void Sweep::push(const Next& next) {
  s_.heap.push_back(next);
  std::push_heap(s_.heap.begin(), s_.heap.end(), later);
}

void Sweep::pop() {
  std::pop_heap(s_.heap.begin(), s_.heap.end(), later);
  s_.heap.pop_back();
}

/// The line gets to a leaf's bounding sphere, or begins inside it.
void Sweep::reach(int leaf) {
  if (methods(surface(leaf).shape).begin_walk == nullptr) {
    ask(leaf);
  } else {
    s_.put_off.push_back(leaf);
    s_.insides.set_unknown(leaf, true);
  }
}

/// Begins the walk over a leaf's crossings, a little before the point that is reached: by as much as faces
/// that coincide may lie apart. What comes before is no event, but counts for who is inside what.
void Sweep::ask(int leaf) {
  const PlacedSurface& part = surface(leaf);
  const LocalLine line = local_line(ray_, part);
  const double margin =
      rounding_room / least_cosine * (size_of(part) + std::abs(reached_) + glm::length(line.point));
  const double from = reached_ > -infinite ? reached_ - margin : -infinite;
  SolidWalk& walk = s_.walks[static_cast<std::size_t>(leaf)];
  if (const auto begin_walk = methods(part.shape).begin_walk; begin_walk != nullptr) {
    begin_walk(part.shape, line, from > -infinite ? parameter_of(line, from) : -infinite, walk);
  } else {
    walk.begin(crossings(part.shape, line, -infinite, Wanted::all));
  }
  if (walk.inside_before()) s_.insides.toggle(leaf);
  push_next(leaf, line, from);
}

/// Asks those formulas that were put off and now matter. False: none did.
bool Sweep::ask_what_matters() {
  bool asked = false;
  for (int leaf = 0; (leaf = s_.insides.decisive(s_.put_off)) >= 0; asked = true) {
    s_.put_off.erase(std::find(s_.put_off.begin(), s_.put_off.end(), leaf));
    s_.insides.set_unknown(leaf, false);
    ask(leaf);
  }
  return asked;
}

/// Puts the next event of a leaf at or beyond `from` among the others.
void Sweep::push_next(int leaf, const LocalLine& line, double from) {
  SolidWalk& walk = s_.walks[static_cast<std::size_t>(leaf)];
  for (SolidWalk::Event found; walk.next(found);) {
    const double t = line.lambda(found.crossing.t);
    if (t >= from) {
      push({{t, leaf, found.kind, found.crossing}, true});
      return;
    }
    if (found.kind != SolidWalk::Kind::touch) s_.insides.toggle(leaf);
  }
}

/// The next event of all, which stays; null: there are no more.
const Sweep::Event* Sweep::peek() {
  while (!s_.heap.empty() && !s_.heap.front().asked) {
    const Event at = s_.heap.front().event;
    pop();
    reached_ = at.t;
    reach(at.leaf);
    ask_what_matters();
  }
  return s_.heap.empty() ? nullptr : &s_.heap.front().event;
}

/// Takes the next event of all. Before that, what matters behind it is asked, since it may have an event here
/// too.
bool Sweep::take(Event& event) {
  for (;;) {
    const Event* const next = peek();
    if (next == nullptr) return false;
    event = *next;
    if (s_.put_off.empty()) break;
    reached_ = event.t;
    s_.insides.toggle(event.leaf);
    const bool asked = ask_what_matters();
    s_.insides.toggle(event.leaf);
    if (!asked) break;
  }
  pop();
  push_next(event.leaf, local_line(ray_, surface(event.leaf)), -infinite);
  return true;
}

bool Sweep::next(Event& crossing) {
  for (Event event; take(event);) {
    const bool before = s_.insides.whole();
    s_.insides.toggle(event.leaf);
    crossing = event;
    if (event.kind == SolidWalk::Kind::jump) continue;
    if (event.kind == SolidWalk::Kind::touch) {
      const bool changes = s_.insides.whole() != before;
      s_.insides.toggle(event.leaf);
      if (changes) return true;
      continue;
    }
    for (const Event* other = peek(); other != nullptr && coincide(event, *other) && take(event);
         other = peek()) {
      if (event.leaf < crossing.leaf) crossing = event;
      s_.insides.toggle(event.leaf);
    }
    if (s_.insides.whole() == before) continue;
    const bool subtracted = solid_.leaves()[static_cast<std::size_t>(crossing.leaf)].subtracted;
    crossing.turned = (s_.insides.leaf(crossing.leaf) != subtracted) != s_.insides.whole();
    return true;
  }
  return false;
}

/// Whether two parts have a common face here: their points are as near to each other, across the face, as
/// their errors allow, and the normals are parallel.
bool Sweep::coincide(const Event& a, const Event& b) const {
  constexpr double parallel = 1e-6;
  if (a.leaf == b.leaf || b.kind != SolidWalk::Kind::crossing) return false;
  const double gap = b.t - a.t;
  const double size = size_of(surface(a.leaf)) + size_of(surface(b.leaf)) + glm::length(line_.at(a.t));
  if (gap * least_cosine > rounding_room * size) return false;
  const SurfacePoint one = point(a);
  const SurfacePoint other = point(b);
  const double across = gap * std::min(std::abs(glm::dot(one.normal, line_.direction)),
                                       std::abs(glm::dot(other.normal, line_.direction)));
  return across <= one.error_bound + other.error_bound &&
         glm::length(glm::cross(one.normal, other.normal)) <= parallel;
}

/// The part's surface point of an event, in the coordinates of the whole.
SurfacePoint Sweep::point(const Event& event) const {
  const PlacedSurface& part = surface(event.leaf);
  return surface_point(part, local_line(ray_, part), event.crossing);
}

}  // namespace backlight
