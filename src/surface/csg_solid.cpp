#include "csg_solid.h"

#include <algorithm>
#include <cmath>

#include "backlight/surface/matter_motion.h"
#include "shape_table.h"

namespace backlight {
namespace {

// Whether a closed form is solid outside of its surface: a line comes from inside, as none of a ball does,
// but every one of a quadric whose formula is negative far away.
bool is_solid_beyond(const Shape& shape) {
  const LocalLine line{Vec3{0.0}, Vec3{1.0, 0.0, 0.0}, 0.0, 0.0, 1.0, {}};
  return methods(shape).begin_walk == nullptr && crossings(shape, line, -infinite, Wanted::all).inside_before;
}

AxisBox box_of(const Solid::Leaf& leaf) {
  if (std::isfinite(leaf.reach)) return axis_box(leaf.surface);
  AxisBox everything;
  everything.lo = Vec3{-infinite};
  everything.hi = Vec3{infinite};
  return everything;
}

AxisBox common(const AxisBox& a, const AxisBox& b) {
  AxisBox box;
  box.lo = glm::max(a.lo, b.lo);
  box.hi = glm::min(a.hi, b.hi);
  return box;
}

std::string problem_at(const SolidTree& tree, int depth) {
  if (depth > deepest_solid) {
    return "solids are nested deeper than " + std::to_string(deepest_solid) + " operations";
  }
  if (const std::string wrong = problem(tree.placement); !wrong.empty()) return wrong;
  for (const SolidTree& part : tree.parts) {
    const std::string wrong = part.parts.empty() ? problem(part) : problem_at(part, depth + 1);
    if (!wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace

std::string problem(const SolidTree& tree) {
  if (!tree.parts.empty()) return problem_at(tree, 1);
  if (tree.shape.kind == ShapeKind::csg) return "an operation on solids needs at least one part";
  if (!is_solid(tree.shape)) {
    return std::string("a ") + methods(tree.shape).name + " encloses nothing, and cannot be part of a solid";
  }
  return first_of(problem(tree.shape), problem(tree.placement));
}

Solid::Solid(const SolidTree& tree) {
  box_ = add(tree, Placement{}, -1, true, false);
  find_moving_groups();
}

void Solid::find_moving_groups() {
  const auto box_of = [](const Leaf& leaf) {
    return leaf.surface.shape.motion ? leaf.surface.shape.motion->box() : nullptr;
  };
  const auto move_as_one = [&](const Leaf& a, const Leaf& b) {
    return box_of(a)->common == box_of(b)->common && a.surface.lanes.aligned && b.surface.lanes.aligned &&
           a.surface.position() == b.surface.position();
  };
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (box_of(leaves_[i]) == nullptr) continue;
    const auto group = std::ranges::find_if(moving_groups_, [&](const std::vector<int>& of) {
      return move_as_one(leaves_[i], leaves_[static_cast<std::size_t>(of.front())]);
    });
    if (group == moving_groups_.end()) {
      moving_groups_.push_back({static_cast<int>(i)});
    } else {
      group->push_back(static_cast<int>(i));
    }
  }
}

AxisBox Solid::add(const SolidTree& tree, const Placement& outer, int parent, bool first, bool subtracted) {
  const Placement placement = outer.around(tree.placement);
  if (tree.parts.empty()) {
    const PlacedSurface surface = place(tree.shape, placement);
    const double reach = is_solid_beyond(tree.shape) ? infinite : surface.radius();
    leaves_.push_back({surface, reach, parent, first, subtracted, tree.member});
    return box_of(leaves_.back());
  }
  const int node = static_cast<int>(nodes_.size());
  nodes_.push_back({tree.operation, parent, first, static_cast<int>(tree.parts.size())});
  AxisBox box;
  for (std::size_t i = 0; i < tree.parts.size(); ++i) {
    const bool taken_away = tree.operation == SolidOperation::difference && i > 0;
    const AxisBox part = add(tree.parts[i], placement, node, i == 0, subtracted != taken_away);
    if (i == 0) {
      box = part;
    } else if (tree.operation == SolidOperation::unite) {
      box.include(part);
    } else if (tree.operation == SolidOperation::intersect) {
      box = common(box, part);
    }
  }
  return box;
}

}  // namespace backlight
