#include "own_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace backlight {

double clock_rate(const Vec3& velocity) {
  return std::sqrt(1.0 - glm::dot(velocity, velocity));
}

namespace {

struct Rules {
  double kronrod;
  double gauss;
};

/// The nodes of the rules on [-1, 1], from the outermost one to the middle; every second is one of Gauss's.
constexpr std::array<double, 8> nodes{
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691692000, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kronrod{
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> gauss{
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

template <class F>
Rules rules(const F& f, double from, double to) {
  const double middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from);
  Rules sum{kronrod[7] * f(middle), 0.0};
  sum.gauss = sum.kronrod / kronrod[7] * gauss[3];
  for (std::size_t i = 0; i < 7; ++i) {
    const double both = f(middle - half * nodes[i]) + f(middle + half * nodes[i]);
    sum.kronrod += kronrod[i] * both;
    if (i % 2 == 1) sum.gauss += gauss[i / 2] * both;
  }
  return {half * sum.kronrod, half * sum.gauss};
}

template <class F>
double integral(const F& f, double from, double to, double tolerance, int depth) {
  const Rules sum = rules(f, from, to);
  // The better rule's own error is of a far higher order than the difference.
  if (!(std::abs(sum.kronrod - sum.gauss) > tolerance * std::abs(to - from)) || depth == 0)
    return sum.kronrod;
  const double middle = 0.5 * (from + to);
  return integral(f, from, middle, tolerance, depth - 1) + integral(f, middle, to, tolerance, depth - 1);
}

constexpr double tolerance = 1e-9;  // of Gauss's rule; Kronrod's is then good to 1e-13 and better
constexpr int deepest = 24;

}  // namespace

double own_time_along(const std::function<Vec3(double)>& velocity, double time,
                      std::optional<double> period) {
  const auto clock = [&](double t) { return clock_rate(velocity(t)); };
  if (!period) return integral(clock, 0.0, time, tolerance, deepest);
  // Whole periods, and what is left: in pieces on which the rules mostly agree at once.
  const auto in_pieces = [&](double length) {
    const double pieces = std::ceil(4.0 * std::abs(length) / *period);
    double sum = 0.0;
    for (double i = 0.0; i < pieces; i += 1.0) {
      sum += integral(clock, length * (i / pieces), length * ((i + 1.0) / pieces), tolerance, deepest);
    }
    return sum;
  };
  const double periods = std::trunc(time / *period);
  const double whole = periods != 0.0 ? in_pieces(*period) : 0.0;
  return periods * whole + in_pieces(time - periods * *period);
}

namespace {

/// A place and what its clock has counted, or their rates.
struct State {
  Vec3 place{0.0};
  double clock = 0.0;

  State& add(double factor, const State& other) {
    place += factor * other.place;
    clock += factor * other.clock;
    return *this;
  }
};

constexpr std::array<double, 7> step_times{0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
constexpr std::array<std::array<double, 6>, 7> step_weights{
    {{},
     {1.0 / 5},
     {3.0 / 40, 9.0 / 40},
     {44.0 / 45, -56.0 / 15, 32.0 / 9},
     {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
     {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
     {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}}};
constexpr std::array<double, 7> difference{71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                           -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

}  // namespace

double own_time_of_flow(const std::function<Vec3(const Vec3&, double)>& velocity, const Mat3& rest_from_local,
                        const Vec3& place, double time) {
  const auto rates = [&](const State& at, double t) {
    const Vec3 v = velocity(at.place, t);
    return State{v, clock_rate(rest_from_local * v)};
  };
  constexpr int most_steps = 100'000;
  constexpr double wanted = 1e-12;
  State state{place, 0.0};
  double t = time;
  double step = -time / 16.0;
  for (int i = 0; i < most_steps && t != 0.0; ++i) {
    if (std::abs(step) >= std::abs(t)) step = -t;
    std::array<State, 7> k;
    State end;
    for (std::size_t stage = 0; stage < k.size(); ++stage) {
      end = state;
      for (std::size_t j = 0; j < stage; ++j) end.add(step * step_weights[stage][j], k[j]);
      k[stage] = rates(end, t + step_times[stage] * step);
    }
    State off;
    for (std::size_t j = 0; j < k.size(); ++j) off.add(step * difference[j], k[j]);
    const double error = glm::length(off.place) + std::abs(off.clock);
    if (std::isnan(error)) return error;
    const double allowed = wanted * (1.0 + glm::length(end.place) + std::abs(end.clock));
    if (error <= allowed || std::abs(step) < 1e-12 * std::abs(time)) {
      t = std::abs(step) >= std::abs(t) ? 0.0 : t + step;
      state = end;
    }
    step *= std::clamp(0.9 * std::pow(allowed / std::max(error, 1e-300), 0.2), 0.2, 5.0);
  }
  return -state.clock;
}

}  // namespace backlight
