// What a boost loses at each Lorentz factor, by the arithmetic it is done in, and what it costs.
//   chart_arithmetic [DIRECTIONS]      CSV on stdout: worst errors of D, of the direction and of the hit
//
// Every input (celerity of the frame, direction of the ray) is a number that single precision holds, and is
// taken as exact; the truth has 77 digits. The hit is that of a sphere of radius 1 about the frame's origin,
// 10 radii from the camera's event in that frame.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "backlight/trace/visibility.h"
#include "support/measure.h"
#include "support/precise.h"

namespace backlight::bench {
namespace {

template <class T>
using Triple = std::array<T, 3>;

template <class T>
T dot(const Triple<T>& a, const Triple<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Triple<T> scaled_sum(const Triple<T>& a, const T& s, const Triple<T>& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

template <class To, class From>
Triple<To> as(const Triple<From>& a) {
  return {To(a[0]), To(a[1]), To(a[2])};
}

template <class T>
struct Boosted {
  Triple<T> direction;
  T length;  // 1/D
};

// Equation (4) of docs/physics.md as it stands, from the celerity u: the textbook's boost.
template <class T>
struct Textbook {
  Triple<T> u;
  T gamma;

  explicit Textbook(const Triple<T>& celerity) : u(celerity), gamma(one_plus(dot(celerity, celerity))) {}
  Boosted<T> operator()(const Triple<T>& n) const {
    using std::sqrt;
    const T along = dot(u, n), length = sqrt(dot(n, n));
    return {scaled_sum(n, T(along / (T(1.0) + gamma) + length), u), gamma * length + along};
  }

 private:
  static T one_plus(const T& square) {
    using std::sqrt;
    return sqrt(T(1.0) + square);
  }
};

// The same from the velocity, as a program that stores β has it.
struct FromVelocity {
  Triple<double> beta;
  double gamma;

  explicit FromVelocity(const Triple<double>& u) {
    const double g = std::sqrt(1.0 + dot(u, u));
    beta = {u[0] / g, u[1] / g, u[2] / g};
    gamma = 1.0 / std::sqrt(1.0 - dot(beta, beta));
  }
  Boosted<double> operator()(const Triple<double>& n) const {
    const double along = gamma * dot(beta, n), length = std::sqrt(dot(n, n));
    return {scaled_sum(n, gamma * (along / (1.0 + gamma) + length), beta), gamma * (length + dot(beta, n))};
  }
};

// Where the line from 10 radii off meets the unit sphere first; not a number if it passes it.
template <class T>
Triple<T> hit_of_sphere(const Triple<T>& from, const Triple<T>& direction) {
  using std::sqrt;
  const T a = dot(direction, direction), b = dot(from, direction), c = dot(from, from) - T(1.0);
  const T lambda = c / (sqrt(b * b - a * c) - b);
  return scaled_sum(from, lambda, direction);
}

// One ray, with the truth of it.
struct Case {
  Triple<double> u, n, from;
  Boosted<Precise> true_boost;
  Triple<Precise> true_hit;
  Triple<double> unit;  // n made a unit vector, as the tracer wants it, with the hit of exactly that
  Triple<Precise> true_hit_of_unit;
  bool hits = false;
};

struct Worst {
  double doppler = 0.0, direction = 0.0, hit = 0.0;
  std::size_t lost = 0;  // hits that were missed
};

double raised(double worst, double error) {
  return std::isfinite(error) ? std::max(worst, error) : HUGE_VAL;
}

template <class T>
void take_boost(Worst& worst, const Case& c, const Boosted<T>& b) {
  const double length = double(abs((Precise(double(b.length)) - c.true_boost.length) / c.true_boost.length));
  worst.doppler = raised(worst.doppler, length);
  const Triple<Precise> d = as<Precise>(as<double>(b.direction));
  const Triple<Precise>& e = c.true_boost.direction;
  const Precise size = sqrt(dot(d, d)) * sqrt(dot(e, e));
  Triple<Precise> cross;
  for (std::size_t i = 0; i < 3; ++i)
    cross[i] = d[(i + 1) % 3] * e[(i + 2) % 3] - d[(i + 2) % 3] * e[(i + 1) % 3];
  worst.direction =
      raised(worst.direction, std::atan2(double(sqrt(dot(cross, cross)) / size), double(dot(d, e) / size)));
}

void take_hit(Worst& worst, const Case& c, const Triple<double>& hit, const Triple<Precise>& truth) {
  if (!c.hits) return;
  if (!std::isfinite(hit[0] + hit[1] + hit[2])) {
    ++worst.lost;
    return;
  }
  const Triple<Precise> off = scaled_sum(as<Precise>(hit), Precise(-1.0), truth);
  worst.hit = raised(worst.hit, double(sqrt(dot(off, off))));
}

class Rays {
 public:
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(-M_PI, M_PI), ring = std::sqrt(1.0 - z * z);
    return {ring * std::cos(angle), ring * std::sin(angle), z};
  }
  double uniform(double low, double high) { return low + (high - low) * (double(engine_() >> 11) * 0x1p-53); }

 private:
  std::mt19937_64 engine_{4};
};

Triple<double> in_single(const Vec3& v) {
  return {double(float(v.x)), double(float(v.y)), double(float(v.z))};
}

// From 10 radii off towards a point within 0.9 radii of the middle, carried to the camera's frame: two rays
// in three are thus of every direction in the frame, which are beamed for the camera; the third is of any
// direction for the camera.
std::vector<Case> cases_at(double gamma, int count) {
  Rays rays;
  std::vector<Case> cases;
  const double celerity = std::sqrt((gamma - 1.0) * (gamma + 1.0));
  for (int i = 0; i < count; ++i) {
    Case c;
    c.u = in_single(celerity * rays.direction());
    const Vec3 off = 10.0 * rays.direction();
    c.from = in_single(off);
    Triple<Precise> back = as<Precise>(c.u);
    for (Precise& x : back) x = -x;
    const Vec3 aim = 0.9 * rays.uniform(0.0, 1.0) * rays.direction() - off;
    const Boosted<Precise> seen = Textbook<Precise>(back)(as<Precise>(Triple<double>{aim.x, aim.y, aim.z}));
    const Vec3 beamed{double(seen.direction[0] / seen.length), double(seen.direction[1] / seen.length),
                      double(seen.direction[2] / seen.length)};
    c.n = in_single(i % 3 == 2 ? rays.direction() : beamed);
    c.true_boost = Textbook<Precise>(as<Precise>(c.u))(as<Precise>(c.n));
    c.true_hit = hit_of_sphere(as<Precise>(c.from), c.true_boost.direction);
    const Vec3 unit = glm::normalize(Vec3(c.n[0], c.n[1], c.n[2]));
    c.unit = {unit.x, unit.y, unit.z};
    c.true_hit_of_unit = hit_of_sphere(as<Precise>(c.from),
                                       Textbook<Precise>(as<Precise>(c.u))(as<Precise>(c.unit)).direction);
    const double where = double(dot(c.true_hit, c.true_hit));
    c.hits = std::isfinite(where) && double(dot(as<Precise>(c.from), c.true_boost.direction)) < 0.0;
    cases.push_back(c);
  }
  return cases;
}

// Backlight's own: the hub, the boost that it chooses, and the hit.
Triple<double> hit_of_backlight(const Case& c) {
  Scene scene;
  scene.frames.resize(2);
  SceneFrame& frame = scene.frames[1];
  const ExtendedVec3 u{Vec3(c.u[0], c.u[1], c.u[2])};
  const ExtendedEvent origin =
      boost(Extended(-1.0) * u, {Extended(0.0), ExtendedVec3{-Vec3(c.from[0], c.from[1], c.from[2])}});
  frame.motion = {u, origin};
  SurfaceSet surfaces;
  surfaces.add(sphere(1.0), Placement{});
  surfaces.build();
  frame.surfaces = std::make_shared<const SurfaceSet>(std::move(surfaces));
  frame.object_of_surface = std::vector<int>{0};
  const Hub hub = make_hub(scene);
  RayInFrames rays(hub);
  CameraRay ray;
  ray.direction = {c.unit[0], c.unit[1], c.unit[2]};
  rays.start(ray);
  const FirstHit hit = first_hit(hub, rays);
  if (!hit.found()) return {NAN, NAN, NAN};
  const RestRayEvents& line = rays.in(1);
  const Vec3 p = frame.surfaces->resolve(hit.hit, line.origin, line.direction, line.clock()).position;
  return {p.x, p.y, p.z};
}

ExtendedVec3 extended(const Triple<double>& a) {
  return ExtendedVec3{Vec3(a[0], a[1], a[2])};
}

struct ByExtended {
  ExtendedTransform transform;
  explicit ByExtended(const Triple<double>& u) : transform(extended(u), ExtendedVec3{}) {}
  Boosted<double> operator()(const Triple<double>& n) const {
    const ExtendedVec3 x = extended(n);
    const ExtendedEvent b = transform({-sqrt(dot(x, x)), x});
    const Vec3 d = b.x.rounded();
    return {{d.x, d.y, d.z}, -double(b.t)};
  }
};

struct ByBacklight {
  LorentzTransform<Rest, Camera> transform;
  explicit ByBacklight(const Triple<double>& u)
      : transform(relative_transform<Rest, Camera>(extended(u), ExtendedVec3{})) {}
  Boosted<double> operator()(const Triple<double>& n) const {
    const NullDirection<Rest> k = transform(null_direction<Camera>({n[0], n[1], n[2]}));
    return {{k.x.x, k.x.y, k.x.z}, k.length};
  }
};

// Of one boost, among many into one frame.
template <class T, class Frame>
double nanoseconds(const std::vector<Case>& cases, const Frame& frame) {
  constexpr int times = 40;
  std::vector<Triple<T>> rays;
  for (const Case& c : cases) rays.push_back(as<T>(c.n));
  volatile T sum = 0.0;
  const double seconds = median_cpu_seconds(9, [&] {
    T own = 0.0;
    for (int i = 0; i < times; ++i) {
      for (const Triple<T>& n : rays) {
        const Boosted<T> b = frame(n);
        own += b.length + b.direction[0] + b.direction[1] + b.direction[2];
      }
    }
    sum = own;
  });
  return 1e9 * seconds / (times * double(rays.size()));
}

template <class T, class Frame>
Triple<double> hit_by(const Case& c) {
  return as<double>(hit_of_sphere<T>(as<T>(c.from), Frame(as<T>(c.u))(as<T>(c.n)).direction));
}

template <class T, class Frame>
void method(const char* name, double gamma, const std::vector<Case>& cases,
            Triple<double> (*hit)(const Case&) = hit_by<T, Frame>) {
  Worst worst;
  std::size_t hits = 0;
  for (const Case& c : cases) {
    take_boost(worst, c, Frame(as<T>(c.u))(as<T>(c.n)));
    take_hit(worst, c, hit(c), hit == hit_of_backlight ? c.true_hit_of_unit : c.true_hit);
    hits += c.hits ? 1 : 0;
  }
  std::printf("%s,%g,%.3g,%.3g,%.3g,%zu,%zu,%.3g\n", name, gamma, worst.doppler, worst.direction, worst.hit,
              worst.lost, hits, nanoseconds<T>(cases, Frame(as<T>(cases.front().u))));
  std::fflush(stdout);
}

void chart(double gamma, int count) {
  const std::vector<Case> cases = cases_at(gamma, count);
  method<float, Textbook<float>>("float", gamma, cases);
  method<double, FromVelocity>("double from velocity", gamma, cases);
  method<double, Textbook<double>>("double", gamma, cases);
  method<double, ByBacklight>("Backlight", gamma, cases, hit_of_backlight);
  method<double, ByExtended>("double-double", gamma, cases);
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 600;
  std::puts("method,gamma,doppler_error,direction_error,hit_error,lost,hits,nanoseconds");
  for (const double gamma : {1.2, 3.0, 10.0, 29.0, 31.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
    backlight::bench::chart(gamma, count);
}
