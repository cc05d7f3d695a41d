#include "backlight/surface/implicit.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "backlight/expression/enclosure.h"

namespace backlight {

ImplicitFormula::ImplicitFormula(Expression f)
    : f_(std::move(f)),
      uses_time_(f_.uses(Variable::t)),
      program_(std::make_shared<const LineProgram>(f_.tape())) {
  if (f_.variables() > variables)
    throw std::invalid_argument("ImplicitFormula: variables besides x, y, z, t");
}

double ImplicitFormula::value(const Vec3& point, double time) const {
  const std::array<double, variables> at{point.x, point.y, point.z, time};
  return f_.evaluate(at);
}

Vec3 ImplicitFormula::gradient(const Vec3& point, double time) const {
  const std::array<Gradient, variables> at{Gradient(point.x, {1.0, 0.0, 0.0}),
                                           Gradient(point.y, {0.0, 1.0, 0.0}),
                                           Gradient(point.z, {0.0, 0.0, 1.0}), Gradient(time)};
  const Gradient result = f_.evaluate(at);
  return {result.partial[0], result.partial[1], result.partial[2]};
}

Interval ImplicitFormula::range(const Vec3& low, const Vec3& high, const Interval& time) const {
  const auto side = [&](int axis) { return Interval{low[axis], high[axis], Continuity::continuous}; };
  return enclose(f_.tape(), std::array<Interval, variables>{side(0), side(1), side(2), time});
}

int ImplicitFormula::sign(const Vec3& point, double time) const {
  const Interval value = range(point, point, {time, time, Continuity::continuous});
  if (value.continuity >= Continuity::partial) return 0;
  return value.lower > 0.0 ? 1 : value.upper < 0.0 ? -1 : 0;
}

}  // namespace backlight
