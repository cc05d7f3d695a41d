// The module that reads and writes picture formats other than our own EXR, loaded when first asked for.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "oiio_module.h"

namespace backlight {

/// Red, green, blue interleaved, row after row from the top, as stored: integers scaled to 0..1.
struct StoredImage {
  int width = 0;
  int height = 0;
  bool integer_samples = false;
  int sample_bits = 0;
  bool declared_linear = false;
  std::vector<float> rgb;
};

/// libbacklight_oiio.so. Loading takes 0.2 s the first time in a process and nothing later; the library stays
/// loaded.
class ImageModule {
 public:
  /// Looks in the folder BACKLIGHT_MODULE_PATH of the environment, or without it in the executable's folder,
  /// ../lib/backlight and ../../lib/backlight. The failure lists where it looked.
  static Result<ImageModule> load();

  [[nodiscard]] Result<StoredImage> read(const std::filesystem::path& path) const;

  /// Of the bytes of a PNG or JPEG file.
  [[nodiscard]] Result<StoredImage> decode(const std::string& bytes) const;

  /// `samples`: width * height * channels unsigned integers of 8 or 16 bits, sRGB; channels 1, 3 or 4.
  [[nodiscard]] Result<std::string> encode_png(const void* samples, int width, int height, int channels,
                                               int sample_bits) const;

  /// `values` (width * height of them, 0..1) as the colours of a map of OpenImageIO's, 3 bytes each.
  [[nodiscard]] Result<void> colour_map(const float* values, int width, int height, const char* map,
                                        unsigned char* rgb) const;

  /// Writes a line of text into 8-bit RGB: oiio_module.h.
  [[nodiscard]] Result<void> write_text(unsigned char* rgb, int width, int height, int x, int y, int side,
                                        int size, const float* colour, const char* text) const;

  [[nodiscard]] Result<std::string> base64(const std::string& bytes) const;

 private:
  ImageModule() = default;
  [[nodiscard]] StoredImage taken(const BacklightOiioImage& image) const;
  BacklightOiioLoad load_ = nullptr;
  BacklightOiioDecode decode_ = nullptr;
  BacklightOiioEncodePng encode_png_ = nullptr;
  BacklightOiioColourMap colour_map_ = nullptr;
  BacklightOiioBase64 base64_ = nullptr;
  BacklightOiioWrite write_ = nullptr;
  BacklightOiioFree free_ = nullptr;
};

}  // namespace backlight
