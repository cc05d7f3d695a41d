// The formula of a shape's surface in its own coordinates.
#pragma once

#include <optional>

#include "compile_parts.h"

namespace backlight {

/// A formula that is 0 on the surface of the shape alone, and negative inside. Of an implicit surface within
/// bounds the bounds are a part of it: where they cut it, it is open or, if `closed`, has a flat face.
/// Nothing for what has no bounds, which has then been reported; nor for a solid of several parts.
std::optional<Expression> body_formula(Compilation& c, const TableView& table, const Shape& shape,
                                       bool closed);

}  // namespace backlight
