// A ball of triangles that fills the view: Embree's nearest hits (single precision, nothing shaded, rays made
// beforehand) beside whole images of Backlight's (double precision, shaded, one shadow ray), on one thread.
//   embree_triangles [FREQUENCY [ROUNDS]]      20·FREQUENCY² triangles; default 100: 200,000
// "who,triangles,seconds,rays" on stdout: medians of rounds taken in turn; Backlight's rays are camera and
// shadow rays together, at rest and at 0.6 c, in red, green and blue.
#include <embree3/rtcore.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <utility>

#include "../tests/support/meshes.h"
#include "support/measure.h"

namespace backlight::bench {
namespace {

constexpr int width = 720, height = 528;  // whole tiles of 8
constexpr double distance = 2.2, half_view = 0.35;

/// The faces of an icosahedron cut into frequency² each, on the unit sphere.
MeshData ball(int frequency) {
  const MeshData base = test::icosphere(0, 1.0);
  MeshData mesh;
  for (const auto& [a, b, c] : base.triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.places.size());
    const auto row = [&](int i) { return first + static_cast<std::uint32_t>(i * (i + 1) / 2); };
    for (int i = 0; i <= frequency; ++i) {
      for (int j = 0; j <= i; ++j) {
        mesh.places.push_back(glm::normalize(double(frequency - i) * base.places[a] +
                                             double(i - j) * base.places[b] + double(j) * base.places[c]));
      }
    }
    for (int i = 0; i < frequency; ++i) {
      for (std::uint32_t j = 0; j <= static_cast<std::uint32_t>(i); ++j) {
        mesh.triangles.push_back({row(i) + j, row(i + 1) + j, row(i + 1) + j + 1});
        if (j < static_cast<std::uint32_t>(i))
          mesh.triangles.push_back({row(i) + j, row(i + 1) + j + 1, row(i) + j + 1});
      }
    }
  }
  return mesh;
}

std::string scene_of(const std::string& file, const std::string& motion) {
  return "[film]\nresolution = [720, 528]\n[camera]\nposition = [0, 0, -2.2]\nlook_at = [0, 0, 0]\nfov = " +
         std::to_string(2.0 * std::atan(half_view) * 180.0 / M_PI) +
         "\n[[light]]\nposition = [-4, 5, -6]\nintensity = 150\n[[object]]\nshape = \"mesh\"\nfile = \"" +
         file + "\"\n" + motion + "[effects]\ndoppler = false\n";
}

struct Rays {
  std::vector<RTCRayHit> single;
  std::vector<RTCRayHit16> packets;
};

Rays camera_rays() {
  Rays rays;
  for (int y0 = 0; y0 < height; y0 += 4) {
    for (int x0 = 0; x0 < width; x0 += 4) {
      RTCRayHit16 packet{};
      for (int i = 0; i < 16; ++i) {
        RTCRayHit ray{};
        ray.ray.org_z = float(-distance);
        ray.ray.dir_x = float(half_view * (2.0 * (x0 + i % 4 + 0.5) / width - 1.0));
        ray.ray.dir_y = float(half_view * (height - 2.0 * (y0 + i / 4 + 0.5)) / width);
        ray.ray.dir_z = 1.0F;
        ray.ray.mask = ~0U;
        rays.single.push_back(ray);
        packet.ray.org_z[i] = ray.ray.org_z;
        packet.ray.dir_x[i] = ray.ray.dir_x;
        packet.ray.dir_y[i] = ray.ray.dir_y;
        packet.ray.dir_z[i] = ray.ray.dir_z;
        packet.ray.mask[i] = ~0U;
      }
      rays.packets.push_back(packet);
    }
  }
  return rays;
}

void begin_again(Rays& rays) {
  for (RTCRayHit& ray : rays.single) {
    ray.ray.tfar = INFINITY;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  }
  for (RTCRayHit16& packet : rays.packets) {
    std::fill_n(packet.ray.tfar, 16, INFINITY);
    std::fill_n(packet.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
  }
}

RTCScene embree_scene(RTCDevice device, const MeshData& mesh) {
  RTCScene scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 12, mesh.places.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
  for (const Vec3& place : mesh.places)
    for (int k = 0; k < 3; ++k) *places++ = float(place[k]);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) *corners++ = corner;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(scene);
  return scene;
}

/// Of the processor: all is done by one thread, and other programs may run.
double seconds_of(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

int run(int frequency, int rounds) {
  const MeshData mesh = ball(frequency);
  const auto file = std::filesystem::temp_directory_path() / ("ball" + std::to_string(getpid()) + ".obj");
  test::write_obj(file, mesh);
  const Scene rest = load_text(scene_of(file, "")),
              moving = load_text(scene_of(file, "beta = [0.6, 0, 0]\nposition = [1.32, 0, 0]\n"));
  std::filesystem::remove(file);
  RTCDevice device = rtcNewDevice("threads=1,user_threads=1");
  if (device == nullptr) {
    std::fprintf(stderr, "embree_triangles: Embree makes no device\n");
    return 1;
  }
  const RTCScene scene = embree_scene(device, mesh);
  Rays rays = camera_rays();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int all[16];
  std::fill_n(all, 16, -1);
  std::size_t traced[2]{};
  const auto image = [&](const Scene& of, std::size_t which) {
    const RenderedImage made = render(of);
    traced[which] = made.statistics.rays.primary + made.statistics.rays.shadow;
  };
  struct Mode {
    const char* name;
    std::function<void()> work;
    std::vector<double> seconds{};
  };
  std::array<Mode, 5> modes{{
      {"embree single",
       [&] {
         for (RTCRayHit& ray : rays.single) rtcIntersect1(scene, &context, &ray);
       }},
      {"embree packets",
       [&] {
         for (RTCRayHit16& packet : rays.packets) rtcIntersect16(all, scene, &context, &packet);
       }},
      {"embree streams",
       [&] {
         for (std::size_t i = 0; i < rays.single.size(); i += 64)
           rtcIntersect1M(scene, &context, &rays.single[i], 64, sizeof(RTCRayHit));
       }},
      {"backlight at rest", [&] { image(rest, 0); }},
      {"backlight at 0.6 c", [&] { image(moving, 1); }},
  }};
  for (int round = 0; round <= rounds; ++round) {  // round 0 warms up
    for (Mode& mode : modes) {
      begin_again(rays);
      const double taken = seconds_of(mode.work);
      if (round > 0) mode.seconds.push_back(taken);
    }
  }
  std::puts("who,triangles,seconds,rays");
  for (std::size_t i = 0; i < modes.size(); ++i) {
    std::printf("%s,%zu,%.6g,%zu\n", modes[i].name, mesh.triangles.size(), median(modes[i].seconds),
                i < 3 ? rays.single.size() : traced[i - 3]);
  }
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return 0;
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  return backlight::bench::run(argc > 1 ? std::atoi(argv[1]) : 100, argc > 2 ? std::atoi(argv[2]) : 7);
}
