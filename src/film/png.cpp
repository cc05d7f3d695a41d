#include "backlight/film/png.h"

#include <cmath>

#include "backlight/base/files.h"
#include "image_module.h"

namespace backlight {
namespace {

template <typename Pixels>
Result<void> write(const std::filesystem::path& path, const Pixels& pixels) {
  const bool fits = pixels.width > 0 && pixels.height > 0 &&
                    (pixels.channels == 1 || pixels.channels == 3 || pixels.channels == 4) &&
                    pixels.samples.size() == static_cast<std::size_t>(pixels.width) *
                                                 static_cast<std::size_t>(pixels.height) *
                                                 static_cast<std::size_t>(pixels.channels);
  if (!fits) {
    return Failure{"cannot write " + path.string() + ": the picture has no pixel, or not as many as it says"};
  }
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) {
    return module.failure();
  }
  constexpr int sample_bits = 8 * static_cast<int>(sizeof(pixels.samples[0]));
  const Result<std::string> png = module.value().encode_png(pixels.samples.data(), pixels.width,
                                                            pixels.height, pixels.channels, sample_bits);
  return png.ok() ? write_file(path, png.value()) : png.failure();
}

}  // namespace

Result<void> write_png(const std::filesystem::path& path, const PixelBytes& pixels) {
  return write(path, pixels);
}

Result<void> write_png(const std::filesystem::path& path, const PixelWords& pixels) {
  return write(path, pixels);
}

Result<PixelBytes> read_rgb_bytes(const std::filesystem::path& path) {
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) {
    return module.failure();
  }
  const Result<StoredImage> image = module.value().read(path);
  if (!image.ok()) {
    return image.failure();
  }
  const StoredImage& stored = image.value();
  if (!stored.integer_samples || stored.sample_bits != 8) {
    return Failure{"cannot read " + path.string() + ": its samples are not of 8 bits"};
  }
  PixelBytes pixels{stored.width, stored.height, 3, {}};
  pixels.samples.reserve(stored.rgb.size());
  for (const float sample : stored.rgb) {
    pixels.samples.push_back(static_cast<std::uint8_t>(std::lround(255.0F * sample)));
  }
  return pixels;
}

}  // namespace backlight
