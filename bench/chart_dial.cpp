// Time and error of whole images as the tolerance, or a fixed number of samples, turns.
//   chart_dial [--quick] SCENE...     CSV on stdout; SCENE is a name in scenes/, such as first
//
// The error is that against two far finer pictures of other seeds, with 80 wavelengths: the mean of the
// product of the differences from either is the square of the error, without theirs.
#include <cstdio>
#include <iostream>
#include <string>

#include "support/measure.h"

namespace backlight::bench {
namespace {

struct Size {
  int width, height, reference_samples;
};

void report(const std::string& scene, const char* method, double setting,
            const std::vector<Image>& references, const ImageRequest& request) {
  const Scene compiled = load("scenes/" + scene + ".toml", {}, request);
  const int wavelengths = needs_within_tolerance(compiled).wavelengths;
  const double start = cpu_seconds();
  const RenderedImage made = render(compiled);
  const double seconds = cpu_seconds() - start;
  const ImageError e = error_of(made.image, references[0], references[1]);
  std::printf("%s,%s,%g,%.4g,%.3f,%.4g,%.4g,%.4g,%zu,%zu,%d\n", scene.c_str(), method, setting, seconds,
              made.statistics.samples.mean(), e.rms, e.percentile99, e.worst,
              std::size_t(made.statistics.rays.primary), std::size_t(made.statistics.samples.at_limit),
              wavelengths);
  std::fflush(stdout);
}

void chart(const std::string& scene, const Size& size) {
  ImageRequest request;
  request.resolution = std::pair{size.width, size.height};
  request.samples = size.reference_samples;
  request.wavelengths = 80;
  std::vector<Image> references;
  for (const unsigned seed : {1U, 2U}) {
    request.seed = seed;
    references.push_back(render(load("scenes/" + scene + ".toml", {}, request), 2).image);
  }
  request.seed = 0;
  request.wavelengths.reset();
  for (const int samples : {1, 2, 4, 8, 16, 32, 64}) {
    request.samples = samples;
    report(scene, "uniform", samples, references, request);
  }
  request.samples.reset();
  for (const double tolerance : {0.1, 0.05, 0.02, 0.01, 0.005}) {
    request.tolerance = tolerance;
    report(scene, "tolerance", tolerance, references, request);
  }
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  std::puts(
      "scene,method,setting,cpu_seconds,samples,rms,percentile99,worst,camera_rays,at_limit,"
      "wavelengths");
  backlight::bench::Size size{128, 94, 256};
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick" || std::string(argv[i]) == "--smoke") {
      size = {36, 26, 64};
    } else {
      backlight::bench::chart(argv[i], size);
    }
  }
}
