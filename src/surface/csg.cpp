// Constructive solid geometry: the crossings of all parts in their order along the line, and who is inside
// what between them. (S. D. Roth, "Ray casting for modeling solids", 1982.)
//
// The line comes re-origined at its closest approach to the whole; each part re-origins it once more, at its
// own centre, and so solves the same well-conditioned problem as if it stood alone.
#include <algorithm>
#include <cmath>

#include "csg_solid.h"
#include "shape_table.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// Rounding of sums of a few terms, relative to the largest of them.
constexpr double rounding_room = 4e-15;

/// A crossing of one part, at t along the line of the whole.
struct Event {
  double t;
  int leaf;
  int sequence;
  bool touch;
  Crossing crossing;  ///< along the part's own line
};

/// What a thread needs for one line; used again for the next.
struct Scratch {
  SolidProfile profile;
  std::vector<Event> events;
  std::vector<char> leaf_inside;
  std::vector<int> count;  ///< of each operation: how many of the parts that count together are inside
  std::vector<char> first_inside;  ///< of a difference: whether its first part is
};

/// Who is inside what, as the line goes on.
class Insides {
 public:
  Insides(const Solid& solid, Scratch& scratch) : solid_(solid), s_(scratch) {
    s_.leaf_inside.assign(solid.leaves().size(), 0);
    s_.count.assign(solid.nodes().size(), 0);
    s_.first_inside.assign(solid.nodes().size(), 0);
  }

  [[nodiscard]] bool whole() const { return whole_; }

  void toggle(int leaf) {
    const Solid::Leaf& part = solid_.leaves()[static_cast<std::size_t>(leaf)];
    char& inside = s_.leaf_inside[static_cast<std::size_t>(leaf)];
    inside = inside == 0 ? 1 : 0;
    bool now = inside != 0;
    bool first = part.first;
    for (int node = part.parent; node >= 0;) {
      const bool before = value(node);
      set_part(node, first, now);
      const bool after = value(node);
      if (before == after) return;
      const Solid::Node& operation = solid_.nodes()[static_cast<std::size_t>(node)];
      now = after;
      first = operation.first;
      node = operation.parent;
    }
    whole_ = now;
  }

 private:
  [[nodiscard]] bool value(int node) const {
    const auto i = static_cast<std::size_t>(node);
    switch (solid_.nodes()[i].operation) {
      case SolidOperation::unite:
        return s_.count[i] > 0;
      case SolidOperation::intersect:
        return s_.count[i] == solid_.nodes()[i].parts;
      case SolidOperation::difference:
        break;
    }
    return s_.first_inside[i] != 0 && s_.count[i] == 0;
  }

  void set_part(int node, bool first, bool inside) {
    const auto i = static_cast<std::size_t>(node);
    if (first && solid_.nodes()[i].operation == SolidOperation::difference) {
      s_.first_inside[i] = inside ? 1 : 0;
    } else {
      s_.count[i] += inside ? 1 : -1;
    }
  }

  const Solid& solid_;
  Scratch& s_;
  bool whole_ = false;
};

/// Whether the line can meet the bounding sphere of a part. Rounding never makes it say no where the answer
/// is yes.
bool may_meet(const LocalLine& line, const PlacedSurface& part) {
  if (std::isinf(part.radius)) return true;
  const Vec3 from = line.point - part.placement.position();
  const Vec3 off = from - glm::dot(from, line.direction) * line.direction;
  const double reach = part.radius + rounding_room * (std::abs(from.x) + std::abs(from.y) + std::abs(from.z));
  return glm::dot(off, off) <= reach * reach;
}

class Sweep {
 public:
  Sweep(const Solid& solid, const LocalLine& line, Scratch& scratch)
      : solid_(solid),
        line_(line),
        ray_(line.point, line.direction, line.clock),
        s_(scratch),
        insides_(solid, scratch) {
    s_.events.clear();
    for (std::size_t i = 0; i < solid.leaves().size(); ++i) add_part(static_cast<int>(i));
    std::sort(s_.events.begin(), s_.events.end(), [](const Event& a, const Event& b) {
      return a.t != b.t ? a.t < b.t : a.leaf != b.leaf ? a.leaf < b.leaf : a.sequence < b.sequence;
    });
  }

  /// Calls visit(event) for every crossing of the boundary of the whole, in order; true: stop.
  template <class Visit>
  void boundary(const Visit& visit) {
    const std::vector<Event>& events = s_.events;
    for (std::size_t i = 0; i < events.size();) {
      const bool before = insides_.whole();
      std::size_t chosen = i;
      std::size_t next = i + 1;
      insides_.toggle(events[i].leaf);
      if (events[i].touch) {
        const bool changes = insides_.whole() != before;
        insides_.toggle(events[i].leaf);
        if (changes && visit(events[i])) return;
        i = next;
        continue;
      }
      while (next < events.size() && coincide(events[next - 1], events[next])) {
        if (events[next].leaf < events[chosen].leaf) chosen = next;
        insides_.toggle(events[next++].leaf);
      }
      if (insides_.whole() != before && visit(events[chosen])) return;
      i = next;
    }
  }

  /// The part's surface point of an event, in the coordinates of the whole.
  [[nodiscard]] SurfacePoint point(const Event& event) const {
    const PlacedSurface& part = solid_.leaves()[static_cast<std::size_t>(event.leaf)].surface;
    return surface_point(part, local_line(ray_, part), event.crossing);
  }

 private:
  void add_part(int leaf) {
    const PlacedSurface& part = solid_.leaves()[static_cast<std::size_t>(leaf)].surface;
    if (!may_meet(line_, part)) return;
    const LocalLine line = local_line(ray_, part);
    const auto add = [&](const Crossing& crossing, bool touch) {
      s_.events.push_back(
          {line.lambda(crossing.t), leaf, static_cast<int>(s_.events.size()), touch, crossing});
    };
    const auto profile = methods(part.shape).profile;
    if (profile != nullptr) {
      s_.profile.clear();
      profile(part.shape, line, s_.profile);
      if (s_.profile.inside_before) insides_.toggle(leaf);
      for (const SolidProfile::Event& event : s_.profile.events) add(event.crossing, event.touch);
      return;
    }
    const Crossings found = crossings(part.shape, line, -infinite, Wanted::all);
    if (found.inside_before) insides_.toggle(leaf);
    for (int i = 0; i < found.count; ++i) add(found.list[i], false);
  }

  /// Whether two parts have a common face here: their points are as near to each other, across the face, as
  /// their errors allow, and the normals are parallel.
  [[nodiscard]] bool coincide(const Event& a, const Event& b) const {
    constexpr double least_cosine = 1e-10;  // of rays that still see both faces as one
    constexpr double parallel = 1e-6;
    if (a.leaf == b.leaf || b.touch) return false;
    const double gap = b.t - a.t;
    const double size = size_of(a.leaf) + size_of(b.leaf) + glm::length(line_.at(a.t));
    if (gap * least_cosine > rounding_room * size) return false;
    const SurfacePoint one = point(a);
    const SurfacePoint other = point(b);
    const double across = gap * std::min(std::abs(glm::dot(one.normal, line_.direction)),
                                         std::abs(glm::dot(other.normal, line_.direction)));
    return across <= one.error_bound + other.error_bound &&
           glm::length(glm::cross(one.normal, other.normal)) <= parallel;
  }

  [[nodiscard]] double size_of(int leaf) const {
    const PlacedSurface& part = solid_.leaves()[static_cast<std::size_t>(leaf)].surface;
    return std::isfinite(part.radius) ? part.radius + glm::length(part.placement.position()) : 0.0;
  }

  const Solid& solid_;
  const LocalLine& line_;
  RestRay ray_;
  Scratch& s_;
  Insides insides_;
};

// Sizes settle after the first few lines; from then on nothing is allocated.
Scratch& scratch_of_thread() {
  thread_local Scratch scratch;
  return scratch;
}

std::string problem_of(const Shape& shape) {
  return shape.solid ? std::string{} : std::string("an operation on solids needs at least one part");
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const AxisBox& box = shape.solid->box();
  if (!(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z)) return 0.0;
  return glm::length(glm::max(glm::abs(box.lo), glm::abs(box.hi)) * factor);
}

double half_extent(const Shape& shape, const Extent& e) {
  const AxisBox& box = shape.solid->box();
  if (!(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z)) return 0.0;
  return glm::dot(glm::max(glm::abs(box.lo), glm::abs(box.hi)), Vec3{e.x, e.y, e.z});
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double lambda_min, Wanted /*wanted*/) {
  Crossings result;
  Sweep(*shape.solid, line, scratch_of_thread()).boundary([&](const Event& event) {
    if (!(line.lambda(event.t) > lambda_min)) return false;
    result.list[result.count++] = {event.t, 0, event.crossing.unresolved};
    return true;
  });
  return result;
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  Sweep sweep(*shape.solid, line, scratch_of_thread());
  LocalPoint result;
  double nearest = infinite;
  sweep.boundary([&](const Event& event) {
    const double off = std::abs(event.t - crossing.t);
    if (!(off < nearest)) return false;
    nearest = off;
    const SurfacePoint point = sweep.point(event);
    const Solid::Leaf& leaf = shape.solid->leaves()[static_cast<std::size_t>(event.leaf)];
    result.position = point.position;
    result.gradient = leaf.subtracted ? -point.normal : point.normal;
    result.u = point.u;
    result.v = point.v;
    result.error = point.error_bound;
    result.member = leaf.surface.shape.blend ? point.member : leaf.member;
    return off == 0.0;
  });
  return result;
}

RootFinder finder_of(const Shape& /*shape*/) {
  return RootFinder::solid;
}

}  // namespace

const ShapeMethods csg_methods{ShapeKind::csg, "csg",    true,    problem_of, bounding_radius, half_extent,
                               crossings_of,   point_of, nullptr, nullptr,    finder_of};

Shape csg(const SolidTree& tree) {
  Shape shape;
  shape.kind = ShapeKind::csg;
  shape.solid = std::make_shared<const Solid>(tree);
  return shape;
}

}  // namespace backlight
