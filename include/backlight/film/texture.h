// Pictures on surfaces and skies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/base/vector.h"

namespace backlight {

/// What lies beyond the edge of a texture.
enum class TextureEdge {
  repeat,  ///< the texture again
  clamp    ///< the outermost texels
};

/// Linear Rec.709 values on a grid of texels, row 0 at v = 0. Texel (i, j) has its centre at
/// u = (i + 1/2) / width, v = (j + 1/2) / height. Immutable: any number of threads may look things up.
class Texture {
 public:
  /// `rgb`: red, green, blue interleaved, linear, row after row; width * height * 3 values. Kept as half
  /// where half holds all of them exactly.
  Texture(int width, int height, std::vector<float> rgb);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// Texel (i, j), 0 <= i < width, 0 <= j < height.
  [[nodiscard]] Vec3 texel(int i, int j) const;

  /// Bilinear between the four texels whose centres are nearest: a texel's value at its centre. u repeats
  /// (around an equirectangular sky there is no seam); `v_edge` says what v does. A coordinate that is not
  /// finite gives NaN.
  [[nodiscard]] Vec3 sample(double u, double v, TextureEdge v_edge = TextureEdge::clamp) const;

 private:
  int width_;
  int height_;
  std::vector<float> floats_;         ///< empty if the texels are kept as half
  std::vector<std::uint16_t> halfs_;  ///< the bits of half values
};

/// Reads a texture in any format of the OpenImageIO module (PNG, JPEG, TIFF, EXR, HDR...), which the first
/// call loads. Integer samples are taken as sRGB and linearised, unless the file says that it is linear;
/// floats are taken as linear Rec.709. Grey is repeated, alpha ignored (colours are taken as stored). Fails
/// with path and reason on a file that is missing, unreadable, damaged or cut short.
Result<Texture> load_texture(const std::filesystem::path& path);

/// The same of the bytes of such a file, PNG or JPEG.
Result<Texture> decode_texture(const std::string& bytes);

}  // namespace backlight
