#include "image_module.h"

#include <array>

#include "backlight/base/files.h"
#include "backlight/base/module.h"

namespace backlight {

namespace fs = std::filesystem;

Result<ImageModule> ImageModule::load() {
  const auto loaded = Module::load("libbacklight_oiio.so", "textures and PNG");
  if (!loaded.ok()) return loaded.failure();
  const Module& library = loaded.value();
  ImageModule module;
  if (!library.find("backlight_oiio_load_v1", module.load_) ||
      !library.find("backlight_oiio_decode_v1", module.decode_) ||
      !library.find("backlight_oiio_encode_png_v1", module.encode_png_) ||
      !library.find("backlight_oiio_colour_map_v1", module.colour_map_) ||
      !library.find("backlight_oiio_base64_v1", module.base64_) ||
      !library.find("backlight_oiio_write_v1", module.write_) ||
      !library.find("backlight_oiio_free_v1", module.free_)) {
    return library.of_another_version();
  }
  return module;
}

StoredImage ImageModule::taken(const BacklightOiioImage& image) const {
  const std::size_t count =
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  StoredImage result{
      image.width, image.height, image.integer_samples != 0, image.sample_bits, image.declared_linear != 0,
      {}};
  result.rgb.assign(image.pixels, image.pixels + count);
  free_(image.pixels);
  return result;
}

Result<StoredImage> ImageModule::read(const fs::path& path) const {
  // OpenImageIO explains a missing file by the formats that it might have had.
  if (const Result<void> regular = require_regular_file(path); !regular.ok()) return regular.failure();
  const std::string what = "cannot read " + path.string() + ": ";
  BacklightOiioImage image{};
  std::array<char, 512> text{};
  if (load_(path.c_str(), &image, text.data(), text.size()) != 0) {
    return Failure{what + text.data()};
  }
  return taken(image);
}

Result<StoredImage> ImageModule::decode(const std::string& bytes) const {
  BacklightOiioImage image{};
  std::array<char, 512> text{};
  if (decode_(bytes.data(), bytes.size(), &image, text.data(), text.size()) != 0) {
    return Failure{std::string("cannot read a texture within a file: ") + text.data()};
  }
  return taken(image);
}

Result<std::string> ImageModule::encode_png(const void* samples, int width, int height, int channels,
                                            int sample_bits) const {
  BacklightOiioBytes png{};
  std::array<char, 512> text{};
  if (encode_png_(samples, width, height, channels, sample_bits, &png, text.data(), text.size()) != 0) {
    return Failure{std::string("cannot encode a PNG: ") + text.data()};
  }
  std::string bytes(reinterpret_cast<const char*>(png.data), png.size);
  free_(png.data);
  return bytes;
}

Result<void> ImageModule::colour_map(const float* values, int width, int height, const char* map,
                                     unsigned char* rgb) const {
  std::array<char, 512> text{};
  if (colour_map_(values, width, height, map, rgb, text.data(), text.size()) != 0) {
    return Failure{std::string("cannot colour a picture: ") + text.data()};
  }
  return {};
}

Result<void> ImageModule::write_text(unsigned char* rgb, int width, int height, int x, int y, int side,
                                     int size, const float* colour, const char* text) const {
  std::array<char, 512> error{};
  if (write_(rgb, width, height, x, y, side, size, colour, text, error.data(), error.size()) != 0)
    return Failure{std::string("cannot write a text into a picture: ") + error.data()};
  return {};
}

Result<std::string> ImageModule::base64(const std::string& bytes) const {
  BacklightOiioBytes encoded{};
  std::array<char, 512> text{};
  if (base64_(bytes.data(), bytes.size(), &encoded, text.data(), text.size()) != 0) {
    return Failure{std::string("cannot encode a picture: ") + text.data()};
  }
  std::string result(reinterpret_cast<const char*>(encoded.data), encoded.size);
  free_(encoded.data);
  return result;
}

}  // namespace backlight
