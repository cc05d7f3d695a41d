// Time of a whole frame by the number of objects, of pixels and of threads: fields of spheres, one shadowing
// lamp, RGB; and the pictures that people make, with all effects that they have.
//   chart_scaling objects|pixels|scenes|threads [--quick]      CSV on stdout; CPU seconds, but for threads
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "support/field.h"
#include "support/measure.h"

namespace backlight::bench {
namespace {

constexpr const char* plain =
    "\n[effects]\ndoppler = false\n";  // red, green and blue; the searchlight effect stays

Scene field(int spheres, FieldMotion motion, int frames, int width, int height) {
  FieldRequest request{spheres, motion, frames};
  ImageRequest image;
  image.resolution = {width, height};
  return load_text(field_for_backlight(request) + plain, image);
}

double seconds_of(const Scene& scene, RayPath path) {
  RenderSettings settings;
  settings.path = path;
  settings.wavelengths = needs_within_tolerance(scene).wavelengths;
  const std::atomic<bool> stop{false};
  const double start = cpu_seconds();
  (void)render_image(scene, settings, stop, nullptr);
  return cpu_seconds() - start;
}

// Median of several where one is quick.
double typical_seconds(const Scene& scene, RayPath path) {
  std::vector<double> seconds{seconds_of(scene, path)};
  const int more = seconds[0] < 0.1 ? 4 : seconds[0] < 1.0 ? 2 : 0;
  for (int i = 0; i < more; ++i) seconds.push_back(seconds_of(scene, path));
  return median(seconds);
}

void objects(int most_spheres) {
  struct Kind {
    const char* name;
    FieldMotion motion;
    int frames;
  };
  const Kind kinds[] = {{"at rest", FieldMotion::at_rest, 1},
                        {"1 moving frame", FieldMotion::shared, 1},
                        {"8 moving frames", FieldMotion::shared, 8},
                        {"64 moving frames", FieldMotion::shared, 64},
                        {"every one its own", FieldMotion::distinct, 1}};
  std::puts("motion,path,spheres,cpu_seconds");
  for (const int spheres : {10, 30, 100, 300, 1000, 3000, 10000, 30000, 100000}) {
    if (spheres > most_spheres) break;
    for (const Kind& kind : kinds) {
      const Scene scene = field(spheres, kind.motion, kind.frames, 360, 263);
      std::printf("%s,sheets,%d,%.4g\n", kind.name, spheres, typical_seconds(scene, RayPath::sheets));
      std::fflush(stdout);
      if (kind.motion != FieldMotion::distinct || spheres > 1000) continue;
      std::printf("%s,one by one,%d,%.4g\n", kind.name, spheres, typical_seconds(scene, RayPath::one_by_one));
    }
  }
}

void pixels(bool quick) {
  std::puts("motion,width,height,pixels,cpu_seconds");
  for (const int width : {90, 180, 360, 720, 1440, 2880}) {
    if (quick && width > 720) break;
    const int height = width * 526 / 720;
    for (const bool moving : {false, true}) {
      const Scene scene = field(200, moving ? FieldMotion::distinct : FieldMotion::at_rest, 1, width, height);
      std::printf("%s,%d,%d,%d,%.4g\n", moving ? "moving" : "at rest", width, height, width * height,
                  typical_seconds(scene, RayPath::sheets));
      std::fflush(stdout);
    }
  }
}

void scenes(bool quick, bool smoke) {
  std::puts("scene,surfaces,frames,colours,width,height,pixels,cpu_seconds");
  for (const char* name : {"fig2a-tram-rest", "fig2b-tram-terrell", "fig7-tram-shadow", "fig1-tram-interior",
                           "default", "street-lamp-flicker"}) {
    for (const int width : {180, 360, 720, 1440}) {
      if (quick && width > (smoke ? 180 : 720)) break;
      ImageRequest image;
      image.resolution = {width, width * 526 / 720};
      const Scene scene = load(std::string("scenes/") + name + ".toml", {"film.samples=1"}, image);
      const Needs needs = needs_within_tolerance(scene);
      std::printf("%s,%zu,%zu,%s,%d,%d,%d,%.4g\n", name, needs.surfaces, needs.frames,
                  needs.spectral ? "spectra" : "RGB", width, width * 526 / 720, width * (width * 526 / 720),
                  typical_seconds(scene, RayPath::sheets));
      std::fflush(stdout);
    }
  }
}

double wall_seconds(const Scene& scene, int threads) {
  const auto start = std::chrono::steady_clock::now();
  render(scene, threads);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void threads_of(const char* name, const Scene& scene) {
  const int most = int(std::thread::hardware_concurrency());
  std::vector<std::vector<double>> seconds(std::size_t(most) + 1);
  for (int round = 0; round < 8; ++round) {
    for (int count = 1; count <= most; ++count) {
      const double taken = wall_seconds(scene, count);
      if (round > 0) seconds[std::size_t(count)].push_back(taken);
    }
  }
  for (int count = 1; count <= most; ++count) {
    const double typical = median(seconds[std::size_t(count)]);
    std::printf("%s,%d,%.4g,%.4g\n", name, count, typical, median(seconds[1]) / typical);
  }
}

void threads(bool quick) {
  const int width = quick ? 720 : 1440;
  ImageRequest image;
  image.resolution = {width, width * 526 / 720};
  std::puts("scene,threads,wall_seconds,speed_up");
  threads_of("200 moving spheres", field(200, FieldMotion::distinct, 1, width, width * 526 / 720));
  threads_of("fig7-tram-shadow", load("scenes/fig7-tram-shadow.toml", {"film.samples=1"}, image));
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  using namespace backlight::bench;
  const std::string what = argc > 1 ? argv[1] : "";
  const std::string flag = argc > 2 ? argv[2] : "";
  const bool smoke = flag == "--smoke", quick = smoke || flag == "--quick";
  if (what == "objects") {
    objects(smoke ? 30 : quick ? 3000 : 100000);
  } else if (what == "pixels") {
    pixels(quick);
  } else if (what == "scenes") {
    scenes(quick, smoke);
  } else if (what == "threads") {
    threads(quick);
  } else {
    std::cerr << "chart_scaling objects|pixels|scenes|threads [--quick]\n";
    return 2;
  }
}
