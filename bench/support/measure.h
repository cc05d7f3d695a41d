// What the chart programs share: scenes rendered in the process, how far an image is off, and medians.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "backlight/render/render.h"
#include "backlight/render/wavelength_estimate.h"
#include "backlight/scene/compile.h"

namespace backlight::bench {

/// A scene of the project's folder, by its path from the root, with changes as of -D. Ends the program with
/// what is wrong with it on stderr.
Scene load(const std::string& path, const std::vector<std::string>& overrides = {},
           const ImageRequest& request = {});

/// The same of a scene given as text.
Scene load_text(const std::string& text, const ImageRequest& request = {});

/// The image, with the wavelengths that the scene needs.
RenderedImage render(const Scene& scene, int threads = 1);

/// Of an image against another, on the scale of shown_value(): 1 is from black to white. NaN counts as 1.
struct ImageError {
  double rms = 0.0;           ///< over all pixels and channels
  double percentile99 = 0.0;  ///< of the pixels' worst channel
  double worst = 0.0;         ///< of any pixel and channel
};
ImageError error_of(const Image& image, const Image& reference);

/// The same against two references whose own errors have nothing to do with one another: these are not in
/// `rms`, the square of which is the mean of the products of the differences from one and the other.
ImageError error_of(const Image& image, const Image& reference, const Image& other);

/// User CPU seconds of this process.
double cpu_seconds();

double median(std::vector<double> values);

/// Median of the CPU seconds of `run`, done `times` times after once to warm up.
double median_cpu_seconds(int times, const std::function<void()>& run);

}  // namespace backlight::bench
