#include "measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>

#include "backlight/film/display.h"
#include "backlight/render/wavelength_estimate.h"
#include "backlight/scene/reader.h"

namespace backlight::bench {
namespace {

[[noreturn]] void give_up(const Diagnostics& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics.all()) std::cerr << format(diagnostic) << '\n';
  std::exit(1);
}

Scene compiled(ReadResult read, const ImageRequest& request) {
  if (!read.description || read.diagnostics.has_errors()) give_up(read.diagnostics);
  ResourceCache resources;
  Diagnostics diagnostics;
  std::optional<Scene> scene = compile(*read.description, request, resources, diagnostics);
  if (!scene) give_up(diagnostics);
  return std::move(*scene);
}

double channel_error(double value, double reference) {
  const double error = shown_value(value) - shown_value(reference);
  return std::isfinite(error) ? error : 1.0;
}

}  // namespace

Scene load(const std::string& path, const std::vector<std::string>& overrides, const ImageRequest& request) {
  return compiled(read_scene(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / path, overrides), request);
}

Scene load_text(const std::string& text, const ImageRequest& request) {
  return compiled(read_scene_text(text, "scene.toml", {}, BACKLIGHT_SOURCE_DIR), request);
}

RenderedImage render(const Scene& scene, int threads) {
  RenderSettings settings;
  settings.threads = threads;
  settings.wavelengths = needs_within_tolerance(scene).wavelengths;
  const std::atomic<bool> stop{false};
  return *render_image(scene, settings, stop, nullptr);
}

ImageError error_of(const Image& image, const Image& reference, const Image& other) {
  ImageError error;
  double products = 0.0;
  std::vector<double> pixels;
  const std::size_t count = image.plane(0).size();
  for (std::size_t i = 0; i < count; ++i) {
    double greatest = 0.0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double off = channel_error(image.plane(channel)[i], reference.plane(channel)[i]);
      const double other_off = channel_error(image.plane(channel)[i], other.plane(channel)[i]);
      products += off * other_off;
      greatest = std::max(greatest, 0.5 * std::abs(off + other_off));
    }
    pixels.push_back(greatest);
  }
  std::ranges::sort(pixels);
  error.rms = std::sqrt(std::max(0.0, products) / (3.0 * double(count)));
  error.percentile99 = pixels[(pixels.size() - 1) * 99 / 100];
  error.worst = pixels.back();
  return error;
}

ImageError error_of(const Image& image, const Image& reference) {
  return error_of(image, reference, reference);
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

double median_cpu_seconds(int times, const std::function<void()>& run) {
  run();
  std::vector<double> seconds;
  for (int i = 0; i < times; ++i) {
    const double start = cpu_seconds();
    run();
    seconds.push_back(cpu_seconds() - start);
  }
  return median(seconds);
}

}  // namespace backlight::bench
