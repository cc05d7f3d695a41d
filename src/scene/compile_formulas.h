// The formulas of implicit surfaces, and blends of several.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backlight/surface/implicit_surface.h"
#include "compile_parts.h"

namespace backlight {

/// The surface of an object or a part with shape = "implicit"; nothing when something is wrong with it, which
/// has then been reported.
std::optional<Shape> compile_implicit(Compilation& c, const TableView& table);

/// One part of a blend, in its own coordinates.
struct BlendPart {
  Expression formula;  ///< of x, y, z, t
  Placement placement;
  int member = 0;
  std::optional<FormulaBounds> bounds;  ///< as written
};

/// The text as a formula of x, y, z and t, with numbers in the places of further names.
Expression formula_of_text(const std::string& text, const std::vector<std::string>& names,
                           const std::vector<double>& values);

/// The formula of a closed form that a blend may take: its signed distance (a quadric's own formula); nothing
/// for the others.
std::optional<Expression> formula_of(const Shape& shape);

/// The parts as one: their formulas in the coordinates of the whole, joined by smooth minima in their order
/// (docs/scene-reference.md, `blend`).
Expression blended(const std::vector<BlendPart>& parts, double blend);

/// The surface of a union with `blend`; nothing when something is wrong with it, which has then been
/// reported.
std::optional<Shape> compile_blend(Compilation& c, const TableView& table,
                                   const std::vector<BlendPart>& parts);

/// What the key `f` says, of x, y, z and its own t, with the rest of this image in its places; nothing when
/// it is wrong.
std::optional<Expression> bound_formula(Compilation& c, const TableView& table);

/// A bound on how fast matter flows within a shape, in lengths for a second; 0 where it does not.
double speed_of_flow(const Shape& shape, double c);

/// The written bounds; nothing when there are none or when they are wrong (and reported).
std::optional<FormulaBounds> written_bounds(const TableView& table);

}  // namespace backlight
