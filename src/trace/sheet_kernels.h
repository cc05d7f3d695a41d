// The kernels over sheets, for any number of lanes. Included by one file for each instruction set.
// Longer than 400 lines: one table of kernels, which share their lanes.
#pragma once

#include "backlight/base/lane_power.h"
#include "sheet.h"

namespace backlight {

template <class V>
BACKLIGHT_LANES LaneVec3<V> load3(const double* const (&from)[3], int at) {
  return {V::load(from[0] + at), V::load(from[1] + at), V::load(from[2] + at)};
}

/// A vector with its time component (negative length of a past-directed null vector, or the rate of time).
template <class V>
struct LaneNull {
  LaneVec3<V> x;
  V length;
};

/// LorentzTransform's standard form of a null vector.
template <class V>
BACKLIGHT_LANES LaneNull<V> boosted(const LaneMotion& motion, LaneVec3<V> x, V length) {
  if (motion.identity) return {x, length};
  const LaneVec3<V> w(motion.celerity);
  const V along = dot(w, x);
  LaneVec3<V> y = x + (along * V(motion.inverse_gamma_plus_one) + length) * w;
  if (motion.rotated) y = motion.rotation.times(y);
  return {y, V(motion.gamma) * length + along};
}

/// in_frame() of trace/ray.h: direction, and minus the rate of time (1/D on the light cone). `size`: |d|.
template <class V>
BACKLIGHT_LANES LaneNull<V> looking(const LaneFrame& frame, LaneVec3<V> d, V size, bool light_delay) {
  const LaneMotion& motion = frame.from_camera;
  if (light_delay) return boosted(motion, d, size);
  if (motion.identity) return {d, V(0.0)};
  const LaneVec3<V> w(motion.celerity);
  const V along = dot(w, d);
  LaneVec3<V> y = d + (along * V(motion.inverse_gamma_plus_one)) * w;
  if (motion.rotated) y = motion.rotation.times(y);
  return {y, along};
}

/// Where and when rays start in a frame, and how long their directions are in the camera's.
template <class V>
struct LaneStart {
  LaneVec3<V> place;
  V time, size;
};
/// `starts`: of rays that have their own; else null.
template <class V>
BACKLIGHT_LANES LaneStart<V> start_of(const LaneFrame& frame, const RayStarts* starts, int i) {
  const LaneVec3<V> place(frame.origin);
  const V time(frame.time);
  if (starts == nullptr) return {place, time, V(1.0)};
  // A displacement (t; x) is boosted as a null vector of the length -t is.
  const LaneNull<V> moved =
      boosted(frame.from_camera, load3<V>(starts->place, i), -V::load(starts->time + i));
  return {place + moved.x, time + -moved.length, V::load(starts->length + i)};
}

template <class V>
BACKLIGHT_LANES V brightness_factor(const LaneBrightness& on, V d, V gamma, bool with_solid_angle) {
  const V energy = on.photon_energy ? d : V(1.0);
  const V rate = on.arrival_rate == 0 ? d : on.arrival_rate == 1 ? gamma : V(1.0);
  const V flux = energy * rate;
  if (!with_solid_angle) return flux;
  return flux * (on.solid_angle ? d * d : V(1.0));
}

template <int N>
struct KernelsOf {
  using V = Lanes<N>;
  using V3 = LaneVec3<V>;
  using Mask = LaneMask<N>;

  static void sample(const SampleRow& row, const int* column, const int* line, double* x, double* y) {
    for (int i = 0; i < sheet_size; i += N) sample_points<N>(row, column + i, line + i, x + i, y + i);
  }

  static void look(const LaneLens& lens, const double* across, const double* down, SheetRays& rays) {
    const V3 forward(lens.forward), right(lens.right), up(lens.up);
    const V foot_x(lens.foot_x), foot_y(lens.foot_y), step_x(lens.step_x), step_y(lens.step_y);
    for (int i = 0; i < rays.padded; i += N) {
      const V x = (V::load(across + i) - foot_x) * step_x;
      const V y = (foot_y - V::load(down + i)) * step_y;
      const V3 d = forward + x * right + y * up;
      store3((V(1.0) / length(d)) * d, rays.direction, i);
    }
  }

  static double sum_of(V a) {
    double sum = 0.0;
    for (int i = 0; i < N; ++i) sum += a.v[i];
    return sum;
  }
  static void set_angle(Bundle& bundle, double cosine) {
    // Room for the rounding of the dot products, and of the axis's length.
    const double c = cosine - 1e-14 < -1.0 ? -1.0 : cosine - 1e-14;
    bundle.cosine = c;
    const double square = 1.0 - c * c;
    bundle.sine = (square > 0.0 ? __builtin_sqrt(square) : 0.0) + 1e-14;
  }

  static Bundle bundle(const SheetRays& rays) {
    V3 sum{V(0.0), V(0.0), V(0.0)};
    for (int i = 0; i < rays.padded; i += N) sum = sum + load3<V>(rays.direction, i);
    const double s[3] = {sum_of(sum.x), sum_of(sum.y), sum_of(sum.z)};
    const double size = __builtin_sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    Bundle result;
    if (!(size > 0.0)) return result;
    for (int k = 0; k < 3; ++k) result.axis[k] = s[k] / size;
    V least = 2.0;
    for (int i = 0; i < rays.padded; i += N) {
      const V c = dot(load3<V>(rays.direction, i), V3(result.axis));
      least = select(c < least, c, least);
    }
    set_angle(result, least_of(least));
    return result;
  }

  static BACKLIGHT_LANES void keep(const ConeTable& from, int i, unsigned hit, ConeTable& to) {
    const int j = to.count;
    for (int a = 0; a < 3; ++a) store_kept(V::load(from.axis[a] + i), hit, to.axis[a] + j);
    store_kept(V::load(from.level + i), hit, to.level + j);
    store_kept(V::load(from.radius + i), hit, to.radius + j);
    store_kept(V::load(from.who + i), hit, to.who + j);
    to.count += __builtin_popcount(hit);
  }

  static BACKLIGHT_LANES void keep(const LampTable& from, int i, unsigned hit, LampTable& to) {
    const int j = to.count;
    for (int a = 0; a < 3; ++a) {
      store_kept(V::load(from.celerity[a] + i), hit, to.celerity[a] + j);
      store_kept(V::load(from.place[a] + i), hit, to.place[a] + j);
    }
    store_kept(V::load(from.gamma + i), hit, to.gamma + j);
    store_kept(V::load(from.inverse_gamma_plus_one + i), hit, to.inverse_gamma_plus_one + j);
    store_kept(V::load(from.speed + i), hit, to.speed + j);
    store_kept(V::load(from.radius + i), hit, to.radius + j);
    store_kept(V::load(from.core + i), hit, to.core + j);
    store_kept(V::load(from.who + i), hit, to.who + j);
    to.count += __builtin_popcount(hit);
  }

  static void overlapping(const ConeTable& from, const Bundle& b, ConeTable& to) {
    to.count = 0;
    for (int i = 0; i < from.count; i += N) {  // the arrays are longer by a register
      const V level = V::load(from.level + i);
      const V radius = V::load(from.radius + i);
      const V along = V::load(from.axis[0] + i) * V(b.axis[0]) + V::load(from.axis[1] + i) * V(b.axis[1]) +
                      V::load(from.axis[2] + i) * V(b.axis[2]);
      const Mask meets = (along >= level * V(b.cosine) - radius * V(b.sine)) |
                         (level * V(b.sine) + radius * V(b.cosine) <= V(0.0));
      const unsigned hit = bits(meets) & (from.count - i < N ? (1U << (from.count - i)) - 1U : ~0U);
      if (hit == 0) continue;
      keep(from, i, hit, to);
    }
  }

  // The bundle as an occluder has it: docs/physics.md equations (17) to (17b).
  struct LampBundle {
    V3 axis;
    V cosine, sine, time, half_time, reach, angle;

    explicit BACKLIGHT_LANES LampBundle(const Bundle& b)
        : axis(b.axis),
          cosine(b.cosine),
          sine(b.sine),
          time(b.time),
          half_time(b.half_time),
          reach(b.reach * (1.0 + 1e-9)),
          // An upper bound of the arc sine up to 30 degrees; beyond, no bound is used.
          angle(b.cosine > 0.87 ? b.sine * (1.0 + 0.19 * b.sine * b.sine) : 10.0) {}
  };

  // Equation (17) for a lamp that moves by up to |w|τ in any direction.
  static BACKLIGHT_LANES Mask may_shade_at_all(const LampBundle& b, V3 w, V3 x, V gamma, V turn, V radius) {
    const V p = dot(x, w);
    const V square = dot(x, x) - radius * radius;
    const Mask outside = square > V(0.0);
    const V q = sqrt(select(outside, square, V(0.0)));
    const V3 m = (q - p * turn) * w - x;
    const V level = q * gamma - p - V(1e-13) * gamma * (q + radius);
    const V along = dot(m, b.axis);
    return ~outside | (along >= level * b.cosine - radius * b.sine) |
           (level * b.sine + radius * b.cosine <= V(0.0));
  }

  // Equations (17a) and (17b).
  template <bool moving>
  static BACKLIGHT_LANES Mask may_shade(const LampTable& table, const LampBundle& b, int i) {
    const V one = V(1.0), zero = V(0.0), tau = b.half_time;
    V3 x{V::load(table.place[0] + i), V::load(table.place[1] + i), V::load(table.place[2] + i)}, w;
    const V radius = V::load(table.radius + i);
    V gamma = one, turn = V(0.5), speed = zero, d = one, spread = zero, inverse = one, inverse_least = one,
      xk = zero;
    if (moving) {
      w = {V::load(table.celerity[0] + i), V::load(table.celerity[1] + i), V::load(table.celerity[2] + i)};
      gamma = V::load(table.gamma + i);
      turn = V::load(table.inverse_gamma_plus_one + i);
      speed = V::load(table.speed + i);
      x = x - b.time * w;
      const V wa = dot(w, b.axis);
      d = gamma - wa;
      spread = speed * b.angle;
      const V slowest = V(0.5) * turn;  // 1/2(γ+1) <= 1/(γ+|w|)
      inverse_least = one / select(d - spread > slowest, d - spread, slowest);
      inverse = one / d;
      xk = wa * turn - one;
    }
    // What rounding makes of lengths in the occluder's frame.
    const V extent = magnitude(x.x) + magnitude(x.y) + magnitude(x.z) + (moving ? tau * gamma : zero);
    const V noise = V(4e-15) * (moving ? gamma * inverse_least : one) * extent;
    // Where the occluder is along the axis and across it, how the lamp moves, and the least of the quadratic
    // function of its moment that is negative where they meet.
    const V xw = moving ? dot(x, w) : zero, square = dot(x, x);
    const V ahead = -(dot(x, b.axis) + (moving ? xk * xw : zero)) * inverse;
    const V angle = moving ? b.angle * inverse_least : b.angle;
    const V cosine = one - V(0.5) * angle * angle, cosine_square = cosine * cosine;
    const V reach = radius * (one + angle) + noise + angle * ahead;
    V miss = cosine_square * (square - ahead * ahead) - reach * reach, shift = zero;
    V room = V(10.0) * noise * (extent + radius);
    if (moving) {
      const V moved = inverse - gamma, turned = angle * moved;
      const V curve = cosine_square * (speed * speed - moved * moved) - turned * turned;
      const V slope = magnitude(cosine_square * (xw + ahead * moved) + turned * reach);
      // Within the moments at -slope/curve, of which no quotient is made, or else at one end.
      const Mask within = slope < tau * curve;
      miss = select(within, miss * curve - slope * slope, miss - tau * (V(2.0) * slope - tau * curve));
      room = select(within, room * curve, room);
      shift = tau * magnitude(moved);
    }
    const V farthest = ahead + shift + noise;
    const Mask aside = miss > room;
    const Mask behind = farthest < -radius;
    const Mask beyond = ahead - shift - noise - radius > b.reach * (d + spread);
    const Mask narrow = angle < V(0.5);
    const Mask meets = ~(narrow & (aside | behind | beyond));
    const V loose = radius + speed * tau;
    if (bits(~narrow & (square > loose * loose)) == 0) return meets;
    if (!moving) w = {zero, zero, zero};
    return meets & (narrow | may_shade_at_all(b, w, x, gamma, turn, loose));
  }

  static void overlapping_lamps(const LampTable& from, const Bundle& bundle, LampTable& to) {
    to.count = 0;
    to.moving = from.moving;
    const LampBundle b(bundle);
    for (int i = 0; i < from.count; i += N) {
      const unsigned all = from.count - i < N ? (1U << (from.count - i)) - 1U : ~0U;
      const unsigned hit =
          bits(from.moving ? may_shade<true>(from, b, i) : may_shade<false>(from, b, i)) & all;
      if (hit == 0) continue;
      keep(from, i, hit, to);
    }
  }

  // The light goes from x₀ - t w, the lamp relative to the occluder's centre at the moment t of emission,
  // along n' = n + (w·n/(γ+1) - R) w with n = -way: docs/physics.md equation (17c). Whether that way meets a
  // ball is a question of signs; the margins are some hundred times the rounding at γ = 30, here and where
  // the law asks the same: what lies within them is left to the law.
  static std::uint64_t sift(const LampTable& table, int which, double time, int first, int last,
                            const LightRays& p) {
    const double w0 = table.celerity[0][which], w1 = table.celerity[1][which], w2 = table.celerity[2][which];
    const double x0 = table.place[0][which] - time * w0, x1 = table.place[1][which] - time * w1,
                 x2 = table.place[2][which] - time * w2;
    const double gamma = table.gamma[which];
    const V3 w{V(w0), V(w1), V(w2)}, x{V(x0), V(x1), V(x2)};
    const V along = x0 * w0 + x1 * w1 + x2 * w2, speed_square = w0 * w0 + w1 * w1 + w2 * w2;
    const V from_square = x0 * x0 + x1 * x1 + x2 * x2, turn = table.inverse_gamma_plus_one[which];
    std::uint64_t unclear = 0;
    for (int i = first; i < last; i += N) {
      const V lit = V::load(p.lit + i);
      const Mask open = lit > V(0.0);
      if (bits(open) == 0) continue;
      const V3 way = load3<V>(p.way, i);
      const V size = V::load(p.way_length + i);
      const V later = V::load(p.time + i) - V(time);
      const V s = -dot(w, way);
      const V d = V(gamma) * size - s;
      const V square = d * d;
      const V moved = later * speed_square;
      const V distance = from_square - later * (V(2.0) * along - moved);
      const V terms = from_square + later * moved;  // of which rays may leave little
      const V b = (later * -s - dot(x, way)) + (s * turn - size) * (along - moved);
      const V room = V(1e-12 * gamma) * size;
      const V outer = V(table.radius[which]) + room, core = V(table.core[which]) - room;
      const V noise = V(1e-11) * (terms + square);
      const V miss = square * distance - b * b;  // of the centre, squared, times the squared length
      const V loose = V(1e-11) * square * terms;
      const Mask aside = miss > square * outer * outer + loose;
      const Mask lamp_outside = distance > outer * outer + noise;
      const V end = distance + V(2.0) * b + square;
      const Mask behind = lamp_outside & (b >= V(0.0));
      const Mask beyond = (end > outer * outer + noise) & (-b >= square);
      const Mask shaded = lamp_outside & (core > V(0.0)) & (miss < square * core * core - loose) &
                          (b < V(0.0)) & ((-b < square) | (end < core * core - noise));
      select(open & shaded, V(0.0), lit).store(p.lit + i);
      unclear |= static_cast<std::uint64_t>(bits(open & ~(aside | behind | beyond | shaded))) << i;
    }
    return unclear;
  }

  static std::uint64_t turned(const PointSheet& p) {
    std::uint64_t all = 0;
    for (int i = 0; i < p.padded; i += N) {
      const Mask lit = V::load(p.lit + i) > V(0.0);
      all |= static_cast<std::uint64_t>(bits(lit & (V::load(p.own + i) < V(0.0)))) << i;
    }
    return all;
  }

  static void gather(const LaneLamp& lamp, const SheetRays& rays, const SheetHits& hits, const double* axis,
                     LightSpan& span) {
    const int step = axis == nullptr ? 4 * N : N;
    V3 sum{V(0.0), V(0.0), V(0.0)};
    V least = span.least_cosine, first = span.begin, last = span.end, reach = span.reach;
    const V3 a = axis == nullptr ? sum : V3{V(axis[0]), V(axis[1]), V(axis[2])};
    for (int i = 0; i < rays.padded; i += step) {
      const Mask hit = V::load(hits.who + i) >= V(0.0);
      if (bits(hit) == 0) continue;
      const LaneStart<V> start = start_of<V>(lamp.frame, rays.own_starts(), i);
      const LaneNull<V> n = looking(lamp.frame, load3<V>(rays.direction, i), start.size, rays.light_delay);
      const V lambda = select(hit, V::load(hits.lambda + i), V(0.0));
      const V3 out = start.place + lambda * n.x - V3(lamp.position);
      const V size = length(out);
      if (axis == nullptr) {
        const Mask far = hit & (size > V(0.0));
        const V3 none{V(0.0), V(0.0), V(0.0)};
        sum = sum + select(far, (V(1.0) / size) * out, none);
        continue;
      }
      const V time = V(lamp.time_offset) + (start.time - V(lamp.frame.time)) + lambda * -n.length - size;
      const V cosine = dot(out, a) / size;
      // Not a number (a point at the lamp itself) counts as every direction.
      least = select(hit, select(cosine >= least, least, select(cosine < least, cosine, V(-1.0))), least);
      first = select(hit & (time < first), time, first);
      last = select(hit & (time > last), time, last);
      reach = select(hit & ~(size <= reach), size, reach);
    }
    span.sum[0] += sum_of(sum.x);
    span.sum[1] += sum_of(sum.y);
    span.sum[2] += sum_of(sum.z);
    span.least_cosine = least_of(least);
    span.begin = least_of(first);
    span.end = most_of(last);
    span.reach = most_of(reach);
  }

  static std::uint64_t same(const double* numbers, int count, double which) {
    std::uint64_t all = 0;
    for (int i = 0; i < count; i += N)
      all |= static_cast<std::uint64_t>(bits(V::load(numbers + i) == V(which))) << i;
    return all & first_bits(count);
  }

  static std::uint64_t odd_squares(double size, const PointSheet& p) {
    std::uint64_t all = 0;
    for (int i = 0; i < p.padded; i += N) {
      const Mask odd = is_odd_square(V(size), V::load(p.points.u + i), V::load(p.points.v + i));
      all |= static_cast<std::uint64_t>(bits(odd)) << i;
    }
    return all;
  }

  static void begin_rays(const LaneFrame& frame, int padded, RaySheet& to) {
    to.padded = padded;
    to.one_origin = true;
    for (int k = 0; k < 3; ++k) to.origin[k][0] = frame.origin[k];
    to.start_time[0] = frame.time;
  }

  static BACKLIGHT_LANES void put_direction(LaneNull<V> n, bool light_delay, RaySheet& to, int i) {
    store3(n.x, to.direction, i);
    (-n.length).store(to.time_rate + i);
    (light_delay ? n.length : length(n.x)).store(to.length + i);
  }

  static std::uint64_t enter(const LaneFrame& frame, const LaneCone& cone, const SheetRays& rays,
                             RaySheet& to) {
    std::uint64_t all = 0;
    begin_rays(frame, rays.padded, to);
    for (int i = 0; i < rays.padded; i += N) {
      const V3 d = load3<V>(rays.direction, i);
      const unsigned inside = bits(dot(d, V3(cone.axis)) >= V(cone.level));
      if (inside == 0) continue;
      all |= static_cast<std::uint64_t>(inside) << i;
      put_direction(looking(frame, d, V(1.0), rays.light_delay), rays.light_delay, to, i);
    }
    return all & first_bits(rays.count);
  }

  static BACKLIGHT_LANES void put_start(const LaneStart<V>& start, RaySheet& to, int i) {
    store3(start.place, to.origin, i);
    start.time.store(to.start_time + i);
  }

  static std::uint64_t enter_near(const LaneFrame& frame, const LaneBall& ball, const SheetRays& rays,
                                  RaySheet& to) {
    std::uint64_t all = 0;
    to.padded = rays.padded;
    to.one_origin = false;
    const V3 centre(ball.centre);
    for (int i = 0; i < rays.padded; i += N) {
      const LaneStart<V> start = start_of<V>(frame, &rays.starts, i);
      const LaneNull<V> n = looking(frame, load3<V>(rays.direction, i), start.size, true);
      const V3 way = centre - start.place;
      const V along = dot(way, n.x) / n.length;
      const V square = dot(way, way);
      // With room for the rounding of all of these, some thousand times.
      const V room = V(1.001 * ball.radius) + V(1e-11) * (sqrt(square) + length(start.place));
      const Mask near = (square - along * along <= room * room + V(1e-11) * square) & (along >= -room);
      const unsigned inside = bits(near);
      put_start(start, to, i);
      put_direction(n, true, to, i);
      all |= static_cast<std::uint64_t>(inside) << i;
    }
    return all & first_bits(rays.count);
  }

  static void in_frame(const LaneFrame& frame, PointSheet& p) {
    begin_rays(frame, p.padded, p.rays);
    p.rays.one_origin = p.starts == nullptr;
    for (int i = 0; i < p.padded; i += N) {
      const LaneStart<V> start = start_of<V>(frame, p.starts, i);
      if (p.starts != nullptr) put_start(start, p.rays, i);
      put_direction(looking(frame, load3<V>(p.direction, i), start.size, p.light_delay), p.light_delay,
                    p.rays, i);
    }
  }

  /// Into the frame of the matter that goes along at i: boost_by() of spacetime/transform.h.
  static BACKLIGHT_LANES LaneNull<V> with_matter(const PointSheet& p, int i, V3 x, V length) {
    const V3 w = load3<V>(p.celerity, i);
    const V gamma = V::load(p.gamma + i);
    const V along = dot(w, x);
    return {x + (along * (V(1.0) / (V(1.0) + gamma)) + length) * w, gamma * length + along};
  }

  /// γ of the matter relative to what goes by at `way` in its frame; `gamma` is that of the frame.
  static BACKLIGHT_LANES V gamma_between(const PointSheet& p, int i, double gamma, const double (&way)[3]) {
    if (!p.moves) return gamma;
    return V(gamma) * V::load(p.gamma + i) + dot(V3(way), load3<V>(p.celerity, i));
  }

  /// Equation (24): what a normal in the base is for the matter that moves at i.
  static BACKLIGHT_LANES V3 normal_of_matter(const PointSheet& p, int i, V3 normal) {
    const V one = V(1.0);
    const V3 w = load3<V>(p.celerity, i);
    const V gamma = V::load(p.gamma + i);
    const V3 g = normal - dot(normal, w) / (gamma * (gamma + one)) * w;
    return (one / sqrt(dot(g, g))) * g;
  }

  /// Equations (23) and (24): a unit normal, where the ray came from, and D on the way, of matter that moves.
  static BACKLIGHT_LANES void go_along(const PointSheet& p, int i, V3& normal, V3& to_camera, V& doppler) {
    const V one = V(1.0);
    normal = normal_of_matter(p, i, normal);
    if (p.light_delay) {
      const LaneNull<V> n = with_matter(p, i, -to_camera, one);
      const V matter = one / n.length;
      to_camera = matter * -n.x;
      doppler = doppler * matter;
    } else {
      const LaneNull<V> n = with_matter(p, i, load3<V>(p.rays.direction, i), -V::load(p.rays.time_rate + i));
      to_camera = (one / sqrt(dot(n.x, n.x))) * -n.x;
    }
  }

  static void face(PointSheet& p) {
    p.shadow.padded = p.padded;
    p.shadow.one_origin = false;
    p.unresolved = 0;
    for (int i = 0; i < p.padded; i += N) {
      p.unresolved |= static_cast<std::uint64_t>(bits(V::load(p.hits->part + i) < V(0.0))) << i;
      const V inverse_length = V(1.0) / V::load(p.rays.length + i);
      V3 to_camera = inverse_length * -load3<V>(p.rays.direction, i);
      const V3 surface = load3<V>(p.points.normal, i);
      V3 normal = surface;
      V doppler = p.light_delay ? inverse_length : V(1.0);
      if (p.moves) go_along(p, i, normal, to_camera, doppler);
      const Mask outside = dot(normal, to_camera) >= V(0.0);
      const V3 seen = select(outside, surface, -surface);
      if (p.smooth) {
        normal = load3<V>(p.points.shading_normal, i);
        if (p.moves) normal = normal_of_matter(p, i, normal);
      }
      const V begin = p.starts == nullptr ? V(p.rays.start_time[0]) : V::load(p.rays.start_time + i);
      const V time = begin + V::load(p.hits->lambda + i) * V::load(p.rays.time_rate + i);
      store3(select(outside, normal, -normal), p.points.normal, i);
      store3(to_camera, p.to_camera, i);
      store3(load3<V>(p.points.position, i) + V::load(p.points.error_bound + i) * seen, p.shadow.origin, i);
      (p.moves ? V::load(p.points.own_time + i) : time).store(p.proper_time + i);
      time.store(p.shadow.start_time + i);
      doppler.store(p.doppler + i);
      select(outside, V::load(p.own + i), V::load(p.own_inside + i)).store(p.own + i);
    }
  }

  static void face_sky(PointSheet& p) {
    for (int i = 0; i < p.padded; i += N) {
      (p.light_delay ? V(1.0) / V::load(p.rays.length + i) : V(1.0)).store(p.doppler + i);
      const LaneSkyPlace<V> place(load3<V>(p.rays.direction, i));
      place.u.store(p.points.u + i);
      place.v.store(p.points.v + i);
    }
  }

  // Equations (10) and (12).
  static std::uint64_t arrive(const LaneLamp& lamp, PointSheet& p) {
    std::uint64_t all_lit = 0;
    for (int i = 0; i < p.padded; i += N) {
      const V lambda = V::load(p.hits->lambda + i);
      V relative, time;
      V3 place;
      const LaneStart<V> start = start_of<V>(lamp.frame, p.starts, i);
      if (lamp.own_frame) {
        relative = lambda * V::load(p.rays.time_rate + i);
        time = V::load(p.shadow.start_time + i);
        place = load3<V>(p.points.position, i);
      } else {
        const LaneNull<V> n = looking(lamp.frame, load3<V>(p.direction, i), start.size, p.light_delay);
        relative = lambda * -n.length;
        time = start.time + relative;
        place = start.place + lambda * n.x;
      }
      if (p.starts != nullptr) relative = relative + (start.time - V(lamp.frame.time));
      V3 way;
      V way_length, own_length;
      if (lamp.meet != nullptr) {
        LampMeeting meeting;
        double places[3][8], times[8];
        store3(place, places, 0);
        time.store(times);
        lamp.meet(*lamp.light, N, places, times, meeting);
        way = load3<V>(meeting.way, 0);
        way_length = V::load(meeting.length);
        own_length = V::load(meeting.own_length);
        V::load(meeting.time).store(p.emission_time + i);
        V::load(meeting.share).store(p.spot_share + i);
        (V(lamp.time_offset) + relative - way_length).store(p.relative_emission_time + i);
      } else if (lamp.distant) {
        way = -V3(lamp.direction);
        way_length = V(1.0);
        (time - dot(V3(lamp.direction), place)).store(p.emission_time + i);
        (V(lamp.time_offset) + relative).store(p.relative_emission_time + i);
      } else {
        way = V3(lamp.position) - place;
        way_length = length(way);
        (time - way_length).store(p.emission_time + i);
        (V(lamp.time_offset) + relative - way_length).store(p.relative_emission_time + i);
      }
      if (lamp.meet == nullptr) own_length = way_length;
      const LaneNull<V> in_frame = boosted(lamp.to_surface, way, way_length);
      const LaneNull<V> k = p.moves ? with_matter(p, i, in_frame.x, in_frame.length) : in_frame;
      const V inverse_length = V(1.0) / k.length;
      const V3 to_light = inverse_length * k.x;
      const V cosine = dot(load3<V>(p.points.normal, i), to_light);
      const Mask lit = (k.length > V(0.0)) & (cosine > V(0.0));
      select(lit, V(1.0), V(0.0)).store(p.lit + i);
      all_lit |= static_cast<std::uint64_t>(bits(lit)) << i;
      if (lamp.distant) store3(place, p.place, i);
      store3(way, p.way, i);
      way_length.store(p.way_length + i);
      store3(in_frame.x, p.shadow.direction, i);
      in_frame.length.store(p.shadow.length + i);
      (-in_frame.length).store(p.shadow.time_rate + i);
      store3(to_light, p.to_light, i);
      cosine.store(p.cosine + i);
      (k.length / own_length).store(p.lamp_doppler + i);
      (lamp.distant ? V(1.0) : inverse_length * inverse_length).store(p.inverse_square + i);
    }
    for (int i = p.count; i < p.padded; ++i) p.lit[i] = 0.0;
    return all_lit & first_bits(p.count);
  }

  static bool light_bundle(const LightRays& p, int begin_at, int end_at, Bundle& bundle) {
    V3 sum{V(0.0), V(0.0), V(0.0)};
    V first = __builtin_inf(), last = -__builtin_inf(), reach = 0.0;
    bool any = false;
    for (int i = begin_at; i < end_at; i += N) {
      const Mask lit = V::load(p.lit + i) > V(0.0);
      if (bits(lit) == 0) continue;
      any = true;
      const V size = V::load(p.way_length + i);
      const V share = select(lit, V(-1.0) / size, V(0.0));
      reach = select(lit & ~(size <= reach), size, reach);
      sum = sum + share * load3<V>(p.way, i);
      const V time = V::load(p.time + i);
      first = select(lit & (time < first), time, first);
      last = select(lit & (time > last), time, last);
    }
    if (!any) return false;
    const double s[3] = {sum_of(sum.x), sum_of(sum.y), sum_of(sum.z)};
    const double size = __builtin_sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    const double begin = least_of(first), end = most_of(last);
    bundle = Bundle{};
    bundle.reach = most_of(reach);
    bundle.time = 0.5 * (begin + end);
    const double larger = end > -begin ? end : -begin;
    bundle.half_time = 0.5 * (end - begin) + 1e-14 * (larger > 0.0 ? larger : -larger);
    if (!(size > 0.0)) return true;
    for (int k = 0; k < 3; ++k) bundle.axis[k] = s[k] / size;
    V least = 2.0;
    for (int i = begin_at; i < end_at; i += N) {
      const Mask lit = V::load(p.lit + i) > V(0.0);
      const V c = -dot(load3<V>(p.way, i), V3(bundle.axis)) / V::load(p.way_length + i);
      least = select(lit & (c < least), c, least);
    }
    set_angle(bundle, least_of(least));
    return true;
  }

  static std::uint64_t cast(const LaneFrame& frame, const LaneMotion& from_light, std::uint64_t candidates,
                            const PointSheet& p, RaySheet& to) {
    std::uint64_t all = 0;
    to.padded = p.padded;
    to.one_origin = false;
    for (int i = 0; i < p.padded; i += N) {
      const unsigned open = bits(V::load(p.lit + i) > V(0.0)) & static_cast<unsigned>(candidates >> i);
      if (open == 0) continue;
      all |= static_cast<std::uint64_t>(open) << i;
      const LaneStart<V> start = start_of<V>(frame, p.starts, i);
      const LaneNull<V> n = looking(frame, load3<V>(p.direction, i), start.size, p.light_delay);
      const LaneNull<V> k = boosted(from_light, load3<V>(p.way, i), V::load(p.way_length + i));
      const V lambda = V::load(p.hits->lambda + i);
      store3(start.place + lambda * n.x, to.origin, i);
      store3(k.x, to.direction, i);
      k.length.store(to.length + i);
      (-k.length).store(to.time_rate + i);
      (start.time + lambda * -n.length).store(to.start_time + i);
    }
    return all;
  }

  static void reflect(const LaneReflection& r, PointSheet& p) {
    for (int i = 0; i < p.padded; i += N) {
      if (bits(V::load(p.lit + i) > V(0.0)) == 0) continue;
      const V cosine = V::load(p.cosine + i);
      const V factor = brightness_factor(r.brightness, V::load(p.lamp_doppler + i),
                                         gamma_between(p, i, r.gamma, r.way), !r.distant);
      const V strength = r.same_strength ? V(r.strength) : V::load(p.strength + i);
      (factor * strength * cosine * V::load(p.inverse_square + i)).store(p.irradiance + i);
      V lobe = 0.0;
      if (r.specular != 0.0) {
        const V3 mirrored = V(2.0) * cosine * load3<V>(p.points.normal, i) - load3<V>(p.to_light, i);
        const V alpha = dot(mirrored, load3<V>(p.to_camera, i));
        const Mask shines = alpha > V(0.0);
        if (bits(shines) != 0) {
          const V power_of = power(select(shines, alpha, V(1.0)), V(r.shininess));
          lobe = select(shines, V(r.specular) * power_of, V(0.0));
        }
      }
      lobe.store(p.specular + i);
    }
  }

  static void add_light(const LaneReflection& r, PointSheet& p) {
    const V inverse_pi = 0.31830988618379067;
    for (int i = 0; i < p.padded; i += N) {
      const Mask lit = V::load(p.lit + i) > V(0.0);
      const V3 before = r.own != nullptr ? V3{V(r.own[0]), V(r.own[1]), V(r.own[2])} : load3<V>(p.rgb, i);
      const V3 diffuse = inverse_pi * (r.same_diffuse ? V3(r.diffuse) : load3<V>(p.diffuse, i));
      const V3 lamp = r.same_lamp
                          ? V3(r.lamp)
                          : V3{V::load(p.lamp[0] + i), V::load(p.lamp[1] + i), V::load(p.lamp[2] + i)};
      V density = V::load(p.irradiance + i);
      if (r.shifted) density = density * V::load(p.lamp_doppler + i);
      const V3 sum = diffuse + V::load(p.specular + i) * lamp;
      store3(select(lit, before + density * sum, before), p.rgb, i);
    }
  }

  static void carry(const LaneCarriage& c, PointSheet& p) {
    for (int i = 0; i < p.padded; i += N) {
      const V doppler = V::load(p.doppler + i);
      V factor = brightness_factor(c.brightness, doppler, gamma_between(p, i, c.gamma, c.way), true);
      if (c.shifted) factor = factor * doppler;
      store3(factor * load3<V>(p.rgb, i), p.rgb, i);
    }
  }

  static constexpr SheetKernels table(const char* name) {
    return {.name = name,
            .sample = sample,
            .look = look,
            .bundle = bundle,
            .overlapping = overlapping,
            .overlapping_lamps = overlapping_lamps,
            .gather = gather,
            .same = same,
            .enter = enter,
            .enter_near = enter_near,
            .in_frame = in_frame,
            .face = face,
            .face_sky = face_sky,
            .arrive = arrive,
            .light_bundle = light_bundle,
            .sift = sift,
            .turned = turned,
            .cast = cast,
            .reflect = reflect,
            .add_light = add_light,
            .odd_squares = odd_squares,
            .carry = carry};
  }
};

}  // namespace backlight
