// How the coordinates of a moving thing follow from those of what it is in, as formulas.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "backlight/expression/compose.h"
#include "backlight/surface/matter_motion.h"
#include "compile_parts.h"

namespace backlight {

/// A flight of constant acceleration that all points of a body share with their neighbours at rest (Rindler).
struct RocketFlight {
  double acceleration;  ///< of the origin, in units of c² by length; not 0
  Vec3 along;           ///< unit
  double c;             ///< lengths for a second
};

/// One step from the outside inwards: outer = position + rotation · scale · inner, as formulas of x, y, z and
/// t of which only t is used (Placement has the order of rotations); or a rocket's flight from there.
struct MotionLevel {
  std::array<Expression, 3> position, rotate, scale;
  std::optional<RocketFlight> rocket;

  [[nodiscard]] bool moves() const;
};

/// The level of a table with `position`, `rotate` and `scale`.
MotionLevel level_of(const TableView& table);

/// Adds the flight of the table's key `rocket`, if it is written. What is wrong with it is reported.
void take_rocket(const TableView& table, double c, MotionLevel& level);

/// The time of motions of the scene, and whether own times are asked for.
MatterMotion::Time clock_of(const Compilation& c);

/// What an element of a written vector says at each time: a formula of x, y, z and t.
Expression formula_of_time(const ImageValues& values, const Node& written);

/// Numbers that never change.
std::array<Expression, 3> constant_formulas(const Vec3& values);
/// Their values, if they never change.
std::optional<Vec3> constants_of(const std::array<Expression, 3>& formulas);

using MotionCoordinates = std::array<Composer::Node, 4>;  ///< x, y, z, t

/// The coordinates within a level of a point that is given outside, and the other way.
MotionCoordinates into(Composer& composer, const MotionLevel& level, MotionCoordinates outer);
MotionCoordinates out_of(Composer& composer, const MotionLevel& level, MotionCoordinates inner);

/// The maps of levels, outermost first.
MatterMotion::Body body_of(const std::vector<MotionLevel>& levels);

/// The same in the coordinates that the levels `within` make of the outermost ones, which never move.
MatterMotion::Body body_within(const std::vector<MotionLevel>& levels,
                               const std::vector<MotionLevel>& within);

/// A box of the innermost coordinates, told in those of the last level that moves. `of_whole`: the
/// coordinates within the first level, kept for others that move with it alone.
BodyBox moving_box(const std::vector<MotionLevel>& levels, const std::array<Interval, 3>& sides,
                   std::shared_ptr<const LineProgram>& of_whole);

/// The formula f of the innermost coordinates as one of the outermost.
Expression moved_formula(const Expression& f, const std::vector<MotionLevel>& levels);

}  // namespace backlight
