// libFuzzer entry: the first byte chooses a format of meshes, the others are a file of it. It is read, or
// refused with a word; the corners of what is read are there and somewhere.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "read_model.h"

namespace {

using namespace backlight::models;

void require(bool fact, const char* what) {
  if (fact) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

Read read(int format, const std::string& path) {
  switch (format) {
    case 0:
      return read_obj(path, true);
    case 1:
      return read_ply(path, true);
    case 2:
      return read_stl(path);
    default:
      return read_gltf(path, true);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const int file = memfd_create("model", MFD_CLOEXEC);
  require(ftruncate(file, static_cast<off_t>(size - 1)) == 0, "no file");
  require(pwrite(file, data + 1, size - 1, 0) == static_cast<ssize_t>(size - 1), "no file");
  try {
    const Read made = read(data[0] % 4, "/proc/self/fd/" + std::to_string(file));
    const std::size_t triangles = made.materials_of_triangles.size();
    require(made.indices.size() == 3 * triangles, "half a triangle");
    for (const std::uint32_t corner : made.indices)
      require(corner < made.places.size(), "a corner of nothing");
    for (const std::uint32_t material : made.materials_of_triangles)
      require(material < made.materials.size(), "a material of nothing");
    for (const Triple& place : made.places)
      for (const double x : place) require(std::isfinite(x), "a place that is nowhere");
    require(made.normals.empty() || made.normals.size() == made.places.size(), "normals of other corners");
    require(made.texture.empty() || made.texture.size() == made.places.size(), "texture of other corners");
  } catch (const std::exception& exception) {
    require(*exception.what() != '\0', "no word about a file");
  }
  return 0;
}
