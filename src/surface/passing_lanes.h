// Where light of an event meets what goes along a path of waves, over lanes: docs/physics.md equations (28a)
// and (29).
#pragma once

#include "backlight/surface/surface_set.h"
#include "lane_path.h"

namespace backlight {

/// Light of an event, and of others no farther than `apart` from it in place and time together.
template <class V>
struct EventLight {
  LaneVec3<V> place;
  V time, apart;
  double sign;  ///< 1 for light that leaves there, -1 for light that arrives
};

/// What it meets of a ball about the path: no farther than `radius` from centre + velocity (t - time), for as
/// long as half_time before and after. Infinite: that is for others to find out.
template <class V>
struct LanePassing {
  V time, half_time;
  LaneVec3<V> centre, velocity;
  V radius;
};

/// The centre at a time, beside light of an event.
template <class V>
struct Encounter {
  PathMoment<V> moment;
  V rate;   ///< of `ahead`, by the time: > 0
  V bend;   ///< of `rate`
  V ahead;  ///< how much later it is than when light that is there was at the event, or is to be: h of (29)
};

template <class V, class Path>
BACKLIGHT_LANES Encounter<V> encounter(const Path& path, const EventLight<V>& light, V time) {
  const PathMoment<V> moment = moment_of(path, time);
  const V sign(light.sign);
  const LaneVec3<V> to = moment.place - light.place;
  const V size = length(to), toward = dot(to, moment.velocity) / size;
  const V turn = dot(to, moment.acceleration) + (dot(moment.velocity, moment.velocity) - toward * toward);
  return {moment, V(1.0) - sign * toward, -sign * turn / size, (time - light.time) - sign * size};
}

/// Of a LanePath or of LanePaths. What is met within r of the centre has |h(t)| <= r + apart, and h only
/// grows: from a time at which it is below that to one at which it is above.
template <class V, class Path>
BACKLIGHT_LANES LanePassing<V> passing_of(const Path& path, V radius, const EventLight<V>& light) {
  using Mask = typename V::Mask;
  const V within = radius + light.apart;
  const V reach = V(1.01) * within + V(2.0) * doubt_of(path, light.time) + V(1e-12) * magnitude(light.time);
  // Newton's method, from where the waves are about.
  const LaneVec3<V> about = LaneVec3<V>(path.start) + light.time * LaneVec3<V>(path.velocity) - light.place;
  V time = light.time + V(light.sign) * length(about);
  Encounter<V> at = encounter(path, light, time);
  constexpr int most_steps = 12;
  for (int i = 0; i < most_steps; ++i) {
    const Mask far = magnitude(at.ahead) > V(0.1) * within;
    if (bits(far) == 0) break;
    time = select(far, time - at.ahead / at.rate, time);
    at = encounter(path, light, time);
  }
  // How long it takes by its bend there, and a little more; whether that is enough is looked at.
  const auto way = [&](V left, V bend) {
    const V square = at.rate * at.rate + V(2.0) * bend * left;
    return V(2.0) * left / (at.rate + sqrt(larger(square, V(0.0))));
  };
  const V more = V(1.04) * reach;
  const V before = way(more + at.ahead, -at.bend), behind = way(more - at.ahead, at.bend);
  const Mask known = (encounter(path, light, time - before).ahead <= -reach) &
                     (encounter(path, light, time + behind).ahead >= reach);
  const V middle = time + V(0.5) * (behind - before);
  const V half_time = V(0.5) * (behind + before) * V(1.0 + 1e-9) + V(1e-12) * magnitude(middle);
  const V strays = half_time * smaller(V(0.5) * V(path.acceleration) * half_time, V(2.0) * V(path.speed));
  const PathMoment<V> moment = moment_of(path, middle);
  return {middle, select(known, half_time, V(__builtin_inf())), moment.place, moment.velocity,
          radius + strays + doubt_of(path, magnitude(middle) + half_time)};
}

/// Balls on paths, and light that leaves at an event, by row; and what it meets.
struct PassingSheet {
  static constexpr int most = static_cast<int>(SurfaceSet::most_lit);
  int count = 0;
  const LanePath* path[most];  ///< no more turns than LanePaths holds
  double radius[most];
  double place[3][most], start[most], apart[most];
  // What is found: as LanePassing.
  double time[most], half_time[most], centre[3][most], velocity[3][most], reach[most];
};

template <class V>
void find_passings(PassingSheet& sheet) {
  static_assert(PassingSheet::most % V::width == 0);
  for (int i = sheet.count; i % V::width != 0; ++i) {
    sheet.path[i] = sheet.path[i - 1];
    sheet.radius[i] = sheet.radius[i - 1];
    for (int k = 0; k < 3; ++k) sheet.place[k][i] = sheet.place[k][i - 1];
    sheet.start[i] = sheet.start[i - 1];
    sheet.apart[i] = sheet.apart[i - 1];
  }
  for (int i = 0; i < sheet.count; i += V::width) {
    const LanePaths<V> paths(sheet.path + i);
    const EventLight<V> light{load3<V>(sheet.place, i), V::load(sheet.start + i), V::load(sheet.apart + i),
                              1.0};
    const LanePassing<V> found = passing_of(paths, V::load(sheet.radius + i), light);
    found.time.store(sheet.time + i);
    found.half_time.store(sheet.half_time + i);
    store3(found.centre, sheet.centre, i);
    store3(found.velocity, sheet.velocity, i);
    found.radius.store(sheet.reach + i);
  }
}

}  // namespace backlight
