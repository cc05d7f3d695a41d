// The field of spheres at rest by Embree 3: nearest hit and one shadow ray, single precision, nothing shaded.
//   embree_spheres [N [ROUNDS]]     "mode,spheres,seconds,camera_rays,shadow_rays" on stdout, medians
//
// Spheres and plane are user geometry, intersected by the same closed form as Backlight's. Rays are made and
// traced a tile of 64 at a time (streams), 8 at a time (packets), or one by one, on one thread.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include "support/field.h"

namespace backlight::bench {
namespace {

constexpr int width = 720, height = 526;
constexpr int tile = 8;  // edge: a stream is a tile's 64 rays

struct Ball {
  float x, y, z, r;
};

struct Field {
  std::vector<Ball> balls;  // the last stands for the plane
};

struct V {
  float x, y, z;
};
V operator-(V a, V b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
float dot(V a, V b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The smallest distance in (near, far), or -1.
float root_of(const Field& field, unsigned primitive, V origin, V direction, float near, float far) {
  const Ball& ball = field.balls[primitive];
  if (primitive + 1 == field.balls.size()) {
    const float t = (-1.0f - origin.y) / direction.y;
    return t > near && t < far ? t : -1.0f;
  }
  const V to = V{ball.x, ball.y, ball.z} - origin;
  const float along = dot(to, direction), size = dot(direction, direction);
  const V off = {to.x - along / size * direction.x, to.y - along / size * direction.y,
                 to.z - along / size * direction.z};
  const float rest = ball.r * ball.r - dot(off, off);
  if (!(rest >= 0.0f)) return -1.0f;
  const float half = std::sqrt(rest / size), first = along / size - half, second = along / size + half;
  if (first > near && first < far) return first;
  return second > near && second < far ? second : -1.0f;
}

void bounds_of(const RTCBoundsFunctionArguments* a) {
  const auto& field = *static_cast<const Field*>(a->geometryUserPtr);
  const Ball& b = field.balls[a->primID];
  RTCBounds& o = *a->bounds_o;
  if (a->primID + 1 == field.balls.size()) {
    o.lower_x = o.lower_z = -1e4f;
    o.upper_x = o.upper_z = 1e4f;
    o.lower_y = o.upper_y = -1.0f;
    return;
  }
  o.lower_x = b.x - b.r, o.lower_y = b.y - b.r, o.lower_z = b.z - b.r;
  o.upper_x = b.x + b.r, o.upper_y = b.y + b.r, o.upper_z = b.z + b.r;
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] != -1) continue;
    const V origin{RTCRayN_org_x(rays, a->N, i), RTCRayN_org_y(rays, a->N, i), RTCRayN_org_z(rays, a->N, i)};
    const V direction{RTCRayN_dir_x(rays, a->N, i), RTCRayN_dir_y(rays, a->N, i),
                      RTCRayN_dir_z(rays, a->N, i)};
    const float t = root_of(*static_cast<const Field*>(a->geometryUserPtr), a->primID, origin, direction,
                            RTCRayN_tnear(rays, a->N, i), RTCRayN_tfar(rays, a->N, i));
    if (t < 0.0f) continue;
    RTCRayN_tfar(rays, a->N, i) = t;
    RTCHitN_geomID(hits, a->N, i) = a->geomID;
    RTCHitN_primID(hits, a->N, i) = a->primID;
  }
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] != -1) continue;
    const V origin{RTCRayN_org_x(a->ray, a->N, i), RTCRayN_org_y(a->ray, a->N, i),
                   RTCRayN_org_z(a->ray, a->N, i)};
    const V direction{RTCRayN_dir_x(a->ray, a->N, i), RTCRayN_dir_y(a->ray, a->N, i),
                      RTCRayN_dir_z(a->ray, a->N, i)};
    const float t = root_of(*static_cast<const Field*>(a->geometryUserPtr), a->primID, origin, direction,
                            RTCRayN_tnear(a->ray, a->N, i), RTCRayN_tfar(a->ray, a->N, i));
    if (t >= 0.0f) RTCRayN_tfar(a->ray, a->N, i) = -INFINITY;
  }
}

struct Frame {
  RTCScene scene;
  std::array<RTCRayHit, 64> hits;
  std::array<RTCRay, 64> shadows;
  std::array<RTCRayHit8, 8> packets;
  std::size_t camera_rays = 0, shadow_rays = 0;
  float nothing = 0.0f;  // so that nothing is left out as unused
};

// The same camera as of the field's scenes.
RTCRayHit camera_ray(int x, int y) {
  static const Vec3 forward = glm::normalize(-field_eye);
  static const Vec3 right = glm::normalize(glm::cross(forward, Vec3(0, 1, 0)));
  static const Vec3 up = glm::cross(right, forward);
  static const double half = std::tan(M_PI / 6.0);
  const double u = half * (2.0 * (x + 0.5) / width - 1.0), v = half * (height - 2.0 * (y + 0.5)) / width;
  const Vec3 d = forward + u * right + v * up;
  RTCRayHit r{};
  r.ray.org_x = float(field_eye.x), r.ray.org_y = float(field_eye.y), r.ray.org_z = float(field_eye.z);
  r.ray.dir_x = float(d.x), r.ray.dir_y = float(d.y), r.ray.dir_z = float(d.z);
  r.ray.tfar = INFINITY;
  r.ray.mask = ~0u;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return r;
}

// From the hit to the lamp; a hit's start is moved towards the eye by what single precision needs.
bool shadow_ray(const RTCRayHit& hit, RTCRay& shadow) {
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const float t = hit.ray.tfar * (1.0f - 1e-4f);
  shadow = {};
  shadow.org_x = hit.ray.org_x + t * hit.ray.dir_x;
  shadow.org_y = hit.ray.org_y + t * hit.ray.dir_y;
  shadow.org_z = hit.ray.org_z + t * hit.ray.dir_z;
  shadow.dir_x = float(field_lamp.x) - shadow.org_x;
  shadow.dir_y = float(field_lamp.y) - shadow.org_y;
  shadow.dir_z = float(field_lamp.z) - shadow.org_z;
  shadow.tnear = 1e-4f;
  shadow.tfar = 1.0f;
  shadow.mask = ~0u;
  return true;
}

using TraceTile = std::function<void(Frame&, unsigned count)>;

void one_by_one(Frame& frame, unsigned count) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (unsigned i = 0; i < count; ++i) {
    rtcIntersect1(frame.scene, &context, &frame.hits[i]);
    RTCRay shadow;
    if (!shadow_ray(frame.hits[i], shadow)) continue;
    ++frame.shadow_rays;
    rtcOccluded1(frame.scene, &context, &shadow);
    frame.nothing += shadow.tfar < 0.0f;
  }
}

unsigned shadows_of(Frame& frame, unsigned count) {
  unsigned lit = 0;
  for (unsigned i = 0; i < count; ++i) lit += shadow_ray(frame.hits[i], frame.shadows[lit]);
  frame.shadow_rays += lit;
  return lit;
}

void by_streams(Frame& frame, unsigned count) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect1M(frame.scene, &context, frame.hits.data(), count, sizeof(RTCRayHit));
  const unsigned lit = shadows_of(frame, count);
  rtcOccluded1M(frame.scene, &context, frame.shadows.data(), lit, sizeof(RTCRay));
  for (unsigned i = 0; i < lit; ++i) frame.nothing += frame.shadows[i].tfar < 0.0f;
}

void put(const RTCRay& ray, RTCRay8& packet, unsigned lane) {
  packet.org_x[lane] = ray.org_x, packet.org_y[lane] = ray.org_y, packet.org_z[lane] = ray.org_z;
  packet.dir_x[lane] = ray.dir_x, packet.dir_y[lane] = ray.dir_y, packet.dir_z[lane] = ray.dir_z;
  packet.tnear[lane] = ray.tnear, packet.tfar[lane] = ray.tfar;
  packet.mask[lane] = ray.mask, packet.flags[lane] = 0, packet.time[lane] = 0.0f;
}

void by_packets(Frame& frame, unsigned count) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (unsigned first = 0; first < count; first += 8) {
    alignas(32) int valid[8];
    RTCRayHit8& packet = frame.packets[first / 8];
    for (unsigned lane = 0; lane < 8; ++lane) {
      valid[lane] = first + lane < count ? -1 : 0;
      if (valid[lane] == 0) continue;
      put(frame.hits[first + lane].ray, packet.ray, lane);
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, frame.scene, &context, &packet);
    for (unsigned lane = 0; lane < 8 && first + lane < count; ++lane) {
      frame.hits[first + lane].ray.tfar = packet.ray.tfar[lane];
      frame.hits[first + lane].hit.geomID = packet.hit.geomID[lane];
    }
  }
  const unsigned lit = shadows_of(frame, count);
  for (unsigned first = 0; first < lit; first += 8) {
    alignas(32) int valid[8];
    RTCRay8 packet{};
    for (unsigned lane = 0; lane < 8; ++lane) {
      valid[lane] = first + lane < lit ? -1 : 0;
      if (valid[lane] != 0) put(frame.shadows[first + lane], packet, lane);
    }
    rtcOccluded8(valid, frame.scene, &context, &packet);
    for (unsigned lane = 0; lane < 8; ++lane) frame.nothing += valid[lane] != 0 && packet.tfar[lane] < 0.0f;
  }
}

double seconds_of(Frame& frame, const TraceTile& trace) {
  const auto begin = std::chrono::steady_clock::now();
  frame.camera_rays = frame.shadow_rays = 0;
  for (int y0 = 0; y0 < height; y0 += tile) {
    for (int x0 = 0; x0 < width; x0 += tile) {
      unsigned count = 0;
      for (int y = y0; y < std::min(y0 + tile, height); ++y)
        for (int x = x0; x < std::min(x0 + tile, width); ++x) frame.hits[count++] = camera_ray(x, y);
      frame.camera_rays += count;
      trace(frame, count);
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

RTCScene scene_of(RTCDevice device, Field& field) {
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(field.balls.size()));
  rtcSetGeometryUserData(geometry, &field);
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

int run(int spheres, int rounds) {
  FieldRequest request;
  request.spheres = spheres;
  Field field;
  for (const FieldSphere& s : sphere_field(request))
    field.balls.push_back({float(s.seen_at.x), float(s.seen_at.y), float(s.seen_at.z), float(s.radius)});
  field.balls.push_back({});
  RTCDevice device = rtcNewDevice("threads=1,user_threads=1");
  if (device == nullptr) {
    std::fprintf(stderr, "embree_spheres: Embree makes no device\n");
    return 1;
  }
  Frame frame;
  frame.scene = scene_of(device, field);
  const std::array<std::pair<const char*, TraceTile>, 3> modes{
      {{"stream", by_streams}, {"packet", by_packets}, {"single", one_by_one}}};
  std::array<std::vector<double>, 3> seconds;
  for (int round = 0; round <= rounds; ++round) {  // round 0 warms up
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const double taken = seconds_of(frame, modes[m].second);
      if (round > 0) seconds[m].push_back(taken);
    }
  }
  std::puts("mode,spheres,seconds,camera_rays,shadow_rays");
  for (std::size_t m = 0; m < modes.size(); ++m) {
    std::ranges::sort(seconds[m]);
    std::printf("%s,%d,%.6g,%zu,%zu\n", modes[m].first, spheres, seconds[m][seconds[m].size() / 2],
                frame.camera_rays, frame.shadow_rays);
  }
  rtcReleaseScene(frame.scene);
  rtcReleaseDevice(device);
  return std::isfinite(frame.nothing) ? 0 : 1;
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  return backlight::bench::run(argc > 1 ? std::atoi(argv[1]) : 200, argc > 2 ? std::atoi(argv[2]) : 7);
}
