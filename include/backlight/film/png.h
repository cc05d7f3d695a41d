// PNG files, through the OpenImageIO module (loaded by the first call).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "backlight/base/result.h"

namespace backlight {

/// Pixels of 8 bits, sRGB: `channels` (1 grey, 3 RGB, 4 RGB and alpha not multiplied in) interleaved, row
/// after row from the top.
struct PixelBytes {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<std::uint8_t> samples;
};

/// The same with 16 bits.
struct PixelWords {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<std::uint16_t> samples;
};

/// Writes a whole PNG or nothing (base/files.h). The same pixels give the same bytes.
Result<void> write_png(const std::filesystem::path& path, const PixelBytes& pixels);
Result<void> write_png(const std::filesystem::path& path, const PixelWords& pixels);

/// The red, green and blue of a picture of 8-bit samples in any format the module reads; grey is repeated.
Result<PixelBytes> read_rgb_bytes(const std::filesystem::path& path);

}  // namespace backlight
