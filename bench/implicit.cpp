// The nearest hit on implicit surfaces: build/bench/bench/implicit. items_per_second is rays a second.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "backlight/surface/implicit.h"
#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

struct Known {
  const char* name;
  const char* formula;
  double half;  ///< of the bounds
};

constexpr Known surfaces[] = {
    {"sphere", "x^2 + y^2 + z^2 - 1", 1.1},
    {"torus", "(x^2 + y^2 + z^2 + 0.91)^2 - 4*(x^2 + z^2)", 1.4},
    {"Barth sextic",
     "4*(2.618033988749895*x^2-y^2)*(2.618033988749895*y^2-z^2)*(2.618033988749895*z^2-x^2)"
     " - 4.23606797749979*(x^2+y^2+z^2-1)^2",
     1.9},
    {"Klein bottle", "(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2) + 16*x*z*(x^2+y^2+z^2-2*y-1)", 4.0},
    {"Chmutov octic", "2*(2*(2*x^2-1)^2-1)^2 + 2*(2*(2*y^2-1)^2-1)^2 + 2*(2*(2*z^2-1)^2-1)^2 - 2", 1.1},
    {"gyroid", "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)", 6.0}};

void nearest_on_implicit(benchmark::State& state) {
  const Known& known = surfaces[state.range(0)];
  state.SetLabel(known.name);
  const auto parsed = Expression::parse(known.formula, {"x", "y", "z", "t"});
  const auto f = std::make_shared<const ImplicitFormula>(std::get<Expression>(parsed));
  SurfaceSet set;
  set.add(implicit(f, Vec3(-known.half), Vec3(known.half)), Placement());
  set.build();
  const Vec3 eye = known.half * Vec3{0.3, 0.9, -3.0};
  std::vector<Vec3> rays;
  for (int i = 0; i < 1024; ++i) {  // points of the bounding cube's middle, spread by irrational steps
    const Vec3 spread{0.7548776662466927 * i, 0.5698402909980532 * i, 0.4301597090019468 * i};
    rays.push_back(known.half * (2.0 * (spread - glm::floor(spread)) - 1.0) - eye);
  }
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(set.nearest(eye, rays[i++ % rays.size()]));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(nearest_on_implicit)->DenseRange(0, 5);

}  // namespace
}  // namespace backlight
