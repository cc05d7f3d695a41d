// Time and error of whole images as the tolerance, or a fixed number of samples, turns.
//   chart_dial [--quick] SCENE...     CSV on stdout; SCENE is a name in scenes/, such as first
//
// The error is that against a far finer picture: 144 samples a pixel, 80 wavelengths, another seed.
#include <cstdio>
#include <iostream>
#include <string>

#include "support/measure.h"

namespace backlight::bench {
namespace {

constexpr double busy_above = 0.01;

struct Reference {
  Image fine, centres;
};

void report(const std::string& scene, const char* method, double setting, const Reference& reference,
            const ImageRequest& request) {
  const Scene compiled = load("scenes/" + scene + ".toml", {}, request);
  const double start = cpu_seconds();
  const RenderedImage made = render(compiled);
  const double seconds = cpu_seconds() - start;
  const ImageError e = error_of(made.image, reference.fine, reference.centres, busy_above);
  std::printf("%s,%s,%g,%.4g,%.3f,%.4g,%.4g,%.4g,%.4g,%zu,%zu\n", scene.c_str(), method, setting, seconds,
              made.statistics.samples.mean(), e.rms, e.busy_rms, e.percentile99, e.worst,
              std::size_t(made.statistics.rays.primary), std::size_t(made.statistics.samples.at_limit));
  std::fflush(stdout);
}

void chart(const std::string& scene, bool quick) {
  const std::pair<int, int> size = quick ? std::pair{36, 26} : std::pair{64, 47};
  const int reference_samples = quick ? 64 : 144;
  ImageRequest request;
  request.resolution = size;
  request.aovs = std::vector<std::string>{"samples"};
  request.seed = 1;
  request.samples = reference_samples;
  request.wavelengths = 80;
  Reference reference;
  reference.fine = render(load("scenes/" + scene + ".toml", {}, request), 2).image;
  request.seed = 0;
  request.samples = 1;
  reference.centres = render(load("scenes/" + scene + ".toml", {}, request), 2).image;
  request.wavelengths.reset();
  for (const int samples : {1, 2, 4, 9, 16, 36}) {
    request.samples = samples;
    report(scene, "uniform", samples, reference, request);
  }
  request.samples.reset();
  for (const double tolerance : {0.1, 0.05, 0.02, 0.01, 0.005}) {
    request.tolerance = tolerance;
    report(scene, "tolerance", tolerance, reference, request);
  }
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  std::puts("scene,method,setting,cpu_seconds,samples,rms,busy_rms,percentile99,worst,camera_rays,at_limit");
  bool quick = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick") {
      quick = true;
    } else {
      backlight::bench::chart(argv[i], quick);
    }
  }
}
