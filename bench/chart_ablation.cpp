// Each piece of the model left out of each figure's scene: what a frame then costs, and how far the image is
// off.
//   chart_ablation [--quick] SCENE...     CSV on stdout; SCENE is a name in scenes/, such as first, or a path
//
// "Everything" is nature: light delay, colours shifted, brightness by D⁴, shadows. The error is the root mean
// square of the difference from that, on the scale of shown_value(), where 1 is from black to white; both
// images have the same samples. The time is divided by that of everything; without retarded shadows, which
// one ray at a time has alone, by that of everything one ray at a time.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "support/measure.h"

namespace backlight::bench {
namespace {

struct Variant {
  std::string piece;  // what is left out
  Scene scene;
  RenderSettings settings;
  std::size_t beside = 0;  // the variant that is otherwise the same: whose time its own is divided by
};

constexpr const char* one_by_one = "sheets and cones: every ray asks every frame";

const std::vector<std::string> nature{"effects.light_delay=true", "effects.doppler=true",
                                      "effects.searchlight=\"exact\""};

class Ablation {
 public:
  Ablation(const std::string& scene, bool quick)
      : path_(scene.find('/') == std::string::npos ? "scenes/" + scene + ".toml" : scene),
        name_(std::filesystem::path(path_).stem()),
        rounds_(quick ? 2 : 4) {
    request_.resolution = quick ? std::pair{120, 88} : std::pair{240, 176};
    request_.samples = 1;
  }

  void run() {
    add("nothing", {});
    add("light delay", {"effects.light_delay=false"});
    add("colour shift", {"effects.doppler=false"});
    add("searchlight effect", {"effects.searchlight=\"off\""});
    add("searchlight: as in the paper", {"effects.searchlight=\"paper\""});
    add_without_shadows();
    request_.wavelengths = 16;
    add("40 of 56 wavelengths", {});
    request_.wavelengths.reset();
    add("SIMD: two lanes instead of the widest", {}).instructions = InstructionSet::baseline;
    add(one_by_one, {}).path = RayPath::one_by_one;
    add("robust arithmetic", {}).pieces.robust_arithmetic = false;
    // Only the law of one ray has it: beside that.
    add("retarded shadows: those of one moment", {}).pieces.retarded_shadows = false;
    variants_.back().beside = variants_.size() - 3;
    measure();
  }

 private:
  RenderSettings& add(const std::string& piece, const std::vector<std::string>& changes) {
    std::vector<std::string> overrides = nature;
    overrides.insert(overrides.end(), changes.begin(), changes.end());
    Variant variant{piece, load(path_, overrides, request_), {}, 0};
    variant.scene.regions.clear();
    variant.settings.wavelengths = needs_within_tolerance(variant.scene).wavelengths;
    variants_.push_back(std::move(variant));
    return variants_.back().settings;
  }

  void add_without_shadows() {
    std::vector<std::string> changes;
    for (std::size_t i = 0; i < variants_.front().scene.lights.size(); ++i)
      changes.push_back("light." + std::to_string(i + 1) + ".shadows=false");
    add("shadows", changes);
  }

  void measure() {
    std::vector<std::vector<double>> seconds(variants_.size());
    std::vector<Image> images;
    const std::atomic<bool> stop{false};
    for (int round = 0; round < rounds_; ++round) {
      for (std::size_t i = 0; i < variants_.size(); ++i) {
        const double start = cpu_seconds();
        auto made = render_image(variants_[i].scene, variants_[i].settings, stop, nullptr);
        if (round > 0) seconds[i].push_back(cpu_seconds() - start);
        if (round == 0) images.push_back(std::move(made->image));
      }
    }
    for (std::size_t i = 0; i < variants_.size(); ++i) {
      const ImageError error = error_of(images[i], images[0]);
      std::printf("%s,\"%s\",%.4g,%.4g,%.4g,%.4g,%.4g\n", name_.c_str(), variants_[i].piece.c_str(),
                  median(seconds[i]), median(seconds[i]) / median(seconds[variants_[i].beside]), error.rms,
                  error.percentile99, error.worst);
    }
    std::fflush(stdout);
  }

  std::string path_, name_;
  int rounds_;
  ImageRequest request_;
  std::vector<Variant> variants_;
};

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  bool quick = false;
  std::puts("scene,left_out,cpu_seconds,times_whole,rms,percentile99,worst");
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick" || std::string(argv[i]) == "--smoke") {
      quick = true;
    } else {
      backlight::bench::Ablation(argv[i], quick).run();
    }
  }
}
