#include "turning.h"

#include <algorithm>
#include <cmath>

namespace backlight {

std::vector<MotionLevel> at_rest(std::vector<MotionLevel> levels) {
  for (MotionLevel& level : levels) {
    for (Expression& angle : level.rotate) {
      if (!angle.constant()) angle = constant_formulas(Vec3{0.0})[0];
    }
  }
  return levels;
}

std::optional<Placement> placement_at_rest(const std::vector<MotionLevel>& levels) {
  Placement placement;
  for (const MotionLevel& level : at_rest(levels)) {
    const auto position = constants_of(level.position), rotate = constants_of(level.rotate),
               scale = constants_of(level.scale);
    if (level.rocket || !position || !scale) return std::nullopt;
    placement = placement.around(Placement(*position, *rotate, *scale));
  }
  return placement;
}

bool turns_in_itself(const Shape& shape, const std::vector<MotionLevel>& levels) {
  const auto moving = std::ranges::find_if(levels, &MotionLevel::moves);
  if (moving == levels.end() ||
      std::any_of(moving + 1, levels.end(), [](const auto& l) { return l.moves(); })) {
    return false;
  }
  std::vector<int> angles;
  for (int i = 0; i < 3; ++i) {
    if (!moving->rotate[static_cast<std::size_t>(i)].constant()) angles.push_back(i);
  }
  const auto scale = constants_of(moving->scale);
  if (angles.size() != 1 || !scale || !constants_of(moving->position) || moving->rocket) return false;
  Vec3 before{0.0};  // the angles of rotations that come before
  for (int i = 0; i < angles.front(); ++i)
    before[i] = *moving->rotate[static_cast<std::size_t>(i)].constant();
  const auto inner = placement_at_rest({moving + 1, levels.end()});
  if (!inner) return false;
  const Placement within = Placement(Vec3{0.0}, before, *scale).around(*inner);
  const auto is_small = [](double x) { return std::abs(x) <= 1e-14; };
  Vec3 axis{0.0};
  axis[angles.front()] = 1.0;
  if (!is_small(glm::length(glm::cross(axis, within.position())))) return false;
  const Mat3& m = within.rest_from_local();
  const double x = glm::length(m[0]), y = glm::length(m[1]), z = glm::length(m[2]);
  const bool square = is_small(glm::dot(m[0], m[1]) / (x * y)) && is_small(glm::dot(m[1], m[2]) / (y * z)) &&
                      is_small(glm::dot(m[2], m[0]) / (z * x));
  if (!square || !is_small(x / z - 1.0)) return false;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return is_small(x / y - 1.0) || is_small(glm::length(glm::cross(axis, m[1])) / y);
    case ShapeKind::cylinder:
    case ShapeKind::cone:
    case ShapeKind::torus:
    case ShapeKind::disk:
      return is_small(glm::length(glm::cross(axis, m[1])) / y);
    default:
      return false;
  }
}

}  // namespace backlight
