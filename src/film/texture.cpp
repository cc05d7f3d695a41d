#include "backlight/film/texture.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "backlight/film/display.h"
#include "image_module.h"

namespace backlight {
namespace {

bool half_is_exact(float value) {
  const auto back = static_cast<float>(half(value));
  return std::bit_cast<std::uint32_t>(back) == std::bit_cast<std::uint32_t>(value);
}

struct Neighbours {
  int first;
  int second;
  double weight;  ///< of the second, 0 <= weight < 1
};

/// The texels on both sides of `coordinate` (finite), of `count` texels.
Neighbours neighbours(double coordinate, int count, TextureEdge edge) {
  if (edge == TextureEdge::clamp) {
    coordinate = std::clamp(coordinate, 0.0, 1.0);
  } else if (!(coordinate >= 0.0 && coordinate < 1.0)) {
    coordinate -= std::floor(coordinate);
  }
  const double position = coordinate * count - 0.5;  // of texel centres: -0.5 ... count - 0.5
  int first = static_cast<int>(position);
  if (position < first) --first;
  const double weight = position - first;
  if (edge == TextureEdge::repeat) {
    return {first < 0 ? count - 1 : first, first + 1 >= count ? 0 : first + 1, weight};
  }
  return {std::max(first, 0), std::min(first + 1, count - 1), weight};
}

void linearise(StoredImage& image) {
  if (image.sample_bits != 8) {
    for (float& value : image.rgb) {
      value = static_cast<float>(srgb_to_linear(value));
    }
    return;
  }
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / 255.0));
  }
  for (float& value : image.rgb) {
    value = table[static_cast<std::size_t>(std::lround(255.0F * value))];
  }
}

}  // namespace

Texture::Texture(int width, int height, std::vector<float> rgb)
    : width_(width), height_(height), floats_(std::move(rgb)) {
  if (std::ranges::all_of(floats_, half_is_exact)) {
    halfs_.reserve(floats_.size());
    for (const float value : floats_) {
      halfs_.push_back(half(value).bits());
    }
    floats_ = {};
  }
}

Vec3 Texture::texel(int i, int j) const {
  const std::size_t at =
      3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i));
  if (floats_.empty()) {
    return {imath_half_to_float(halfs_[at]), imath_half_to_float(halfs_[at + 1]),
            imath_half_to_float(halfs_[at + 2])};
  }
  return {floats_[at], floats_[at + 1], floats_[at + 2]};
}

Vec3 Texture::sample(double u, double v, TextureEdge v_edge) const {
  if (!std::isfinite(u) || !std::isfinite(v)) {
    return Vec3{std::numeric_limits<double>::quiet_NaN()};
  }
  const Neighbours across = neighbours(u, width_, TextureEdge::repeat);
  const Neighbours down = neighbours(v, height_, v_edge);
  const auto row = [&](int j) {
    return (1.0 - across.weight) * texel(across.first, j) + across.weight * texel(across.second, j);
  };
  return (1.0 - down.weight) * row(down.first) + down.weight * row(down.second);
}

namespace {

template <class Read>
Result<Texture> texture_by(const Read& read_by) {
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) {
    return module.failure();
  }
  Result<StoredImage> read = read_by(module.value());
  if (!read.ok()) {
    return read.failure();
  }
  StoredImage& image = read.value();
  if (image.integer_samples && !image.declared_linear) {
    linearise(image);
  }
  return Texture(image.width, image.height, std::move(image.rgb));
}

}  // namespace

Result<Texture> load_texture(const std::filesystem::path& path) {
  return texture_by([&](const ImageModule& module) { return module.read(path); });
}

Result<Texture> decode_texture(const std::string& bytes) {
  return texture_by([&](const ImageModule& module) { return module.decode(bytes); });
}

}  // namespace backlight
