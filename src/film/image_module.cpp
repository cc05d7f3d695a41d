#include "image_module.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <system_error>

#include "backlight/base/files.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

constexpr const char* module_name = "libbacklight_oiio.so";

std::vector<fs::path> places() {
  if (const char* folder = std::getenv("BACKLIGHT_MODULE_PATH"); folder != nullptr && *folder != '\0') {
    return {fs::path(folder) / module_name};
  }
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path up = folder.parent_path();
  return {folder / module_name, up / "lib" / "backlight" / module_name,
          up.parent_path() / "lib" / "backlight" / module_name};
}

template <typename Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  return function != nullptr;
}

}  // namespace

Result<ImageModule> ImageModule::load() {
  std::string looked;
  for (const fs::path& place : places()) {
    std::error_code error;
    if (!fs::exists(place, error)) {
      looked += "\n  not at " + place.string();
      continue;
    }
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) {
      return Failure{"cannot load the module for textures and PNG: " + std::string(::dlerror())};
    }
    ImageModule module;
    if (!find(library, "backlight_oiio_load_v1", module.load_) ||
        !find(library, "backlight_oiio_encode_png_v1", module.encode_png_) ||
        !find(library, "backlight_oiio_colour_map_v1", module.colour_map_) ||
        !find(library, "backlight_oiio_base64_v1", module.base64_) ||
        !find(library, "backlight_oiio_free_v1", module.free_)) {
      return Failure{"the module for textures and PNG, " + place.string() + ", is of another version"};
    }
    return module;
  }
  return Failure{"cannot find the module for textures and PNG (BACKLIGHT_MODULE_PATH names its folder):" +
                 looked};
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
  const std::size_t count =
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  StoredImage result{
      image.width, image.height, image.integer_samples != 0, image.sample_bits, image.declared_linear != 0,
      {}};
  result.rgb.assign(image.pixels, image.pixels + count);
  free_(image.pixels);
  return result;
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
