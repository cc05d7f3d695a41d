// What the steps of a ray cost by themselves, in nanoseconds: build/bench/bench/kernels
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"
#include "backlight/spacetime/transform.h"
#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

// Directions spread over the sphere by the golden angle: as unlike each other as the rays of an image.
std::vector<Vec3> directions(int count) {
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double angle = 2.399963229728653 * i;
    const double radius = std::sqrt(1.0 - z * z);
    all.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return all;
}

// One null direction into a frame of Lorentz factor state.range(0): below and above robust_gamma.
void boost_of_a_direction(benchmark::State& state) {
  const double gamma = static_cast<double>(state.range(0));
  const double celerity = std::sqrt((gamma - 1.0) * (gamma + 1.0));
  const auto boost = relative_transform<Rest, Camera>({celerity, 0.0, 0.0}, {0.0, 0.0, 0.0});
  std::vector<NullDirection<Camera>> rays;
  for (const Vec3& direction : directions(1024)) rays.push_back({direction, 1.0});
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(boost(rays[i++ % rays.size()]));
}
BENCHMARK(boost_of_a_direction)->Arg(2)->Arg(1000);

// The nearest of state.range(0)³ spheres, seen from their middle.
void nearest_sphere(benchmark::State& state) {
  const auto edge = static_cast<int>(state.range(0));
  SurfaceSet set;
  for (int i = 0; i < edge * edge * edge; ++i) {
    const Vec3 cell(i % edge, i / edge % edge, i / (edge * edge));
    set.add(sphere(0.2), Placement(cell - Vec3(0.5 * edge)));
  }
  set.build();
  const std::vector<Vec3> rays = directions(1024);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(set.nearest(Vec3{0.01, 0.02, 0.03}, rays[i++ % rays.size()]));
}
BENCHMARK(nearest_sphere)->Arg(2)->Arg(10)->Arg(40);

// One shape of each kind, hit and missed in turn.
void nearest_of_a_shape(benchmark::State& state) {
  const Shape shapes[] = {sphere(1.0),
                          box(Vec3(2.0)),
                          cylinder(1.0, 2.0),
                          cone(1.0, 0.0, 2.0),
                          torus(1.0, 0.3),
                          disk(1.0),
                          plane(),
                          quadric({1, 1, 1, 0, 0, 0, 0, 0, 0, -1})};
  const char* const names[] = {"sphere", "box", "cylinder", "cone", "torus", "disk", "plane", "quadric"};
  const auto kind = static_cast<std::size_t>(state.range(0));
  state.SetLabel(names[kind]);
  SurfaceSet set;
  set.add(shapes[kind], Placement(Vec3(0.0), Vec3(20.0, 30.0, 40.0)));
  set.build();
  const std::vector<Vec3> targets = directions(1024);
  const Vec3 eye{0.0, 0.5, -4.0};
  std::size_t i = 0;
  for (auto _ : state) {
    const Vec3 direction = glm::normalize(1.4 * targets[i++ % targets.size()] - eye);
    benchmark::DoNotOptimize(set.nearest(eye, direction));
  }
}
BENCHMARK(nearest_of_a_shape)->DenseRange(0, 7);

// A shifted reflectance under daylight to a film colour, at the default number of wavelengths.
void film_colour_of_a_spectrum(benchmark::State& state) {
  const WavelengthSet set;
  const Spectrum light = Spectrum::d65();
  const Spectrum surface = Spectrum::reflectance(LinearRgb{0.6, 0.25, 0.2});
  const int count = set.size();
  std::vector<double> nm(static_cast<std::size_t>(count));
  std::vector<double> radiance(nm.size());
  std::vector<double> reflectance(nm.size());
  for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = 1.3 * set.nm()[i];
  for (auto _ : state) {
    light.evaluate(nm.data(), count, radiance.data());
    surface.evaluate(nm.data(), count, reflectance.data());
    for (std::size_t i = 0; i < nm.size(); ++i) radiance[i] *= reflectance[i];
    benchmark::DoNotOptimize(set.film(radiance.data()));
  }
}
BENCHMARK(film_colour_of_a_spectrum);

}  // namespace
}  // namespace backlight
