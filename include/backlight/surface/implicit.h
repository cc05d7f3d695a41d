// A surface given by a formula: { x : f(x, y, z, t) = 0 }.
#pragma once

#include <array>
#include <memory>

#include "backlight/base/vector.h"
#include "backlight/expression/expression.h"
#include "backlight/expression/interval.h"
#include "backlight/expression/line_program.h"

namespace backlight {

/// A formula in x, y, z (local coordinates) and t (the object's proper time). Where f < 0 is inside.
/// Immutable; safe to use from many threads.
class ImplicitFormula {
 public:
  /// The variables of `f`, in this order; parameters of the scene's must have been bound (Expression::bind).
  enum Variable : std::size_t { x, y, z, t };
  static constexpr std::size_t variables = 4;

  /// Throws std::invalid_argument when `f` has other than four variables or fewer.
  explicit ImplicitFormula(Expression f);

  [[nodiscard]] const Expression& expression() const { return f_; }
  [[nodiscard]] bool uses_time() const { return uses_time_; }
  /// For many lines at once.
  [[nodiscard]] const LineProgram& program() const { return *program_; }

  /// The value in double precision. NaN where f is undefined.
  [[nodiscard]] double value(const Vec3& point, double time = 0.0) const;
  /// The gradient in space, pointing outward: away from where f < 0. Not normalised.
  [[nodiscard]] Vec3 gradient(const Vec3& point, double time = 0.0) const;
  /// Certain bounds on the values in a box of space and time (backlight/expression/interval.h).
  [[nodiscard]] Interval range(const Vec3& low, const Vec3& high, const Interval& time = {}) const;
  /// The sign of f at a point: -1 inside, 1 outside; 0 when rounding cannot tell or f is undefined there.
  [[nodiscard]] int sign(const Vec3& point, double time = 0.0) const;

 private:
  Expression f_;
  bool uses_time_;
  std::shared_ptr<const LineProgram> program_;
};

}  // namespace backlight
