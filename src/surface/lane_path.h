// A path of waves over lanes of times, and what bounds it.
#pragma once

#include "backlight/base/lane_waves.h"
#include "backlight/base/lanes.h"
#include "backlight/surface/ray_sheet.h"
#include "backlight/surface/wave_path.h"
#include "lane_surface.h"

namespace backlight {

/// Where a path is, and its rates.
template <class V>
struct PathMoment {
  LaneVec3<V> place, velocity, acceleration;
};

/// Several paths, one to each lane.
template <class V>
struct LanePaths {
  static constexpr int most_turns = 4;
  struct Turn {
    V rate;
    LaneVec3<V> cosine, sine;
  };
  LaneVec3<V> start, velocity;
  Turn turns[most_turns];
  int count = 0;
  V speed, acceleration, doubt, doubt_rate;

  explicit LanePaths(const LanePath* const* paths) {
    for (int i = 0; i < V::width; ++i) count = paths[i]->count > count ? paths[i]->count : count;
    const auto lanes = [&](auto number) {
      double numbers[V::width];
      for (int i = 0; i < V::width; ++i) numbers[i] = number(*paths[i]);
      return V::load(numbers);
    };
    const auto lanes3 = [&](auto three) {
      return LaneVec3<V>{lanes([&](const LanePath& path) { return three(path)[0]; }),
                         lanes([&](const LanePath& path) { return three(path)[1]; }),
                         lanes([&](const LanePath& path) { return three(path)[2]; })};
    };
    start = lanes3([](const LanePath& path) { return path.start; });
    velocity = lanes3([](const LanePath& path) { return path.velocity; });
    for (int k = 0; k < count; ++k) {
      const auto turn = [k](const LanePath& path) -> const LanePath::Turn& {
        static constexpr LanePath::Turn none{};
        return k < path.count ? path.turns[k] : none;
      };
      turns[k].rate = lanes([&](const LanePath& path) { return turn(path).rate; });
      turns[k].cosine = lanes3([&](const LanePath& path) { return turn(path).cosine; });
      turns[k].sine = lanes3([&](const LanePath& path) { return turn(path).sine; });
    }
    speed = lanes([](const LanePath& path) { return path.speed; });
    acceleration = lanes([](const LanePath& path) { return path.acceleration; });
    doubt = lanes([](const LanePath& path) { return path.doubt; });
    doubt_rate = lanes([](const LanePath& path) { return path.doubt_rate; });
  }
};

/// Of a LanePath or of LanePaths.
template <class V, class Path>
BACKLIGHT_LANES PathMoment<V> moment_of(const Path& path, V time) {
  PathMoment<V> at{LaneVec3<V>(path.start) + time * LaneVec3<V>(path.velocity), LaneVec3<V>(path.velocity),
                   LaneVec3<V>(V(0.0), V(0.0), V(0.0))};
  for (int i = 0; i < path.count; ++i) {
    const auto& turn = path.turns[i];
    const LaneVec3<V> cosine(turn.cosine), sine(turn.sine);
    const V rate(turn.rate);
    const Waves<V> wave = waves(rate * time);
    const LaneVec3<V> out = wave.cosine * cosine + wave.sine * sine;
    at.place = at.place + out;
    at.velocity = at.velocity + rate * (wave.cosine * sine - wave.sine * cosine);
    at.acceleration = at.acceleration - (rate * rate) * out;
  }
  return at;
}

/// The same at one time.
inline WavePath::Motion moment_of(const LanePath& path, double time) {
  const PathMoment<Lanes<1>> at = moment_of(path, Lanes<1>(time));
  return {{at.place.x.v, at.place.y.v, at.place.z.v}, {at.velocity.x.v, at.velocity.y.v, at.velocity.z.v}};
}

/// How far what this says and the formulas may be apart for their rounding, that of the time among it.
template <class V, class Path>
BACKLIGHT_LANES V doubt_of(const Path& path, V time) {
  return V(path.doubt) + V(path.doubt_rate) * magnitude(time);
}

/// Rays in coordinates that go along with a surface that is carried straight on: there it is at rest.
template <class V>
BACKLIGHT_LANES void go_along(const LaneSurface& surface, const RaySheet& rays, RaySheet& along) {
  const LaneVec3<V> velocity(surface.path->velocity);
  along.padded = rays.padded;
  along.one_origin = rays.one_origin;
  along.instructions = rays.instructions;
  for (int i = 0; i < rays.padded; i += V::width) {
    const V start = V::load(rays.start_time + i), rate = V::load(rays.time_rate + i);
    start.store(along.start_time + i);
    rate.store(along.time_rate + i);
    const LaneVec3<V> direction = load3<V>(rays.direction, i) - rate * velocity;
    store3(direction, along.direction, i);
    length(direction).store(along.length + i);
    if (!rays.one_origin) store3(load3<V>(rays.origin, i) - start * velocity, along.origin, i);
  }
  for (int k = 0; k < 3 && rays.one_origin; ++k) {
    along.origin[k][0] = rays.origin[k][0] - rays.start_time[0] * surface.path->velocity[k];
  }
}

/// What is found in the coordinates of a surface that is carried straight on, in the frame.
template <class V>
struct CarriedPlace {
  LaneVec3<V> position;
  V error_bound;
  V own_time;  ///< equation (25), in the frame's units
};

template <class V>
BACKLIGHT_LANES CarriedPlace<V> carried(const LaneSurface& surface, const LanePoint<V>& point, V time) {
  const LaneVec3<V> velocity(surface.path->velocity);
  const LaneVec3<V> way = time * velocity;
  return {point.position + way, point.error_bound + V(0x1p-48) * largest_coordinate(way),
          time * sqrt(V(1.0) - dot(velocity, velocity))};
}

}  // namespace backlight
