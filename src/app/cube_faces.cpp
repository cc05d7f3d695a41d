#include "cube_faces.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "backlight/camera/projection.h"
#include "backlight/render/image_identity.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

constexpr std::array face_names{"right", "left", "up", "down", "front", "back"};  // of CubeFace

fs::path face_path(const fs::path& file, std::size_t face) {
  return fs::path(file).replace_extension(face_names[face] + file.extension().string());
}

// Copies the rows of a face, each value of `components` samples.
template <class From, class To>
void copy_face(const From& from, int width, std::size_t face, int components, To& to) {
  const int edge = width / 3;
  const int row = static_cast<int>(face) / 3 * edge;
  const int column = static_cast<int>(face) % 3 * edge;
  auto end = to.begin();
  for (int y = row; y < row + edge; ++y) {
    const auto begin = from.begin() + std::ptrdiff_t{components} * (std::ptrdiff_t{y} * width + column);
    end = std::copy(begin, begin + std::ptrdiff_t{components} * edge, end);
  }
}

// A cubemap by the axes of its camera, which looks along -z: of pixels as large as a face.
Lens unit_cube() {
  Lens cube;
  cube.projection = Projection::cubemap;
  cube.width = 3;
  cube.height = 2;
  cube.forward = {0.0, 0.0, -1.0};
  cube.right = {1.0, 0.0, 0.0};
  return cube;
}

// Into the coordinates of a camera that looks through the face, from those of the cube's.
std::array<float, 16> turned(const std::array<float, 16>& to_camera, std::size_t face) {
  const double x = static_cast<double>(face % 3), y = static_cast<double>(face / 3);
  const auto direction = [&](double right, double down) {
    return *direction_at(unit_cube(), {x + 0.5 + right, y + 0.5 + down});
  };
  // Off the middle by a quarter of the face is by half of the distance.
  const Vec3 forward = direction(0.0, 0.0);
  const auto axis = [&](const Vec3& d) { return 2.0 * (d / glm::dot(d, forward) - forward); };
  const std::array<Vec3, 3> axes{axis(direction(0.25, 0.0)), axis(direction(0.0, -0.25)), -forward};
  std::array<float, 16> result = to_camera;
  for (std::size_t row = 0; row < 4; ++row) {
    const float* from = &to_camera[4 * row];
    const Vec3 by_camera{double(from[0]), double(from[1]), double(from[2])};
    for (std::size_t k = 0; k < 3; ++k)
      result[4 * row + k] = static_cast<float>(glm::dot(axes[k], by_camera));
  }
  return result;
}

ExrHeader face_header(const ExrHeader& cube, std::size_t face) {
  ExrHeader header = cube;
  if (header.world_to_camera) header.world_to_camera = turned(*header.world_to_camera, face);
  auto& list = header.attributes;
  std::erase_if(list, [](const ExrAttribute& one) {
    return one.name == identity_attribute || one.name == "backlight/projection";
  });
  list.push_back({"backlight/projection", std::string(name_of(Projection::perspective))});
  list.push_back({"backlight/fov", 90.0});
  list.push_back({"backlight/face", std::string(face_names[face])});
  return header;
}

}  // namespace

Result<void> require_cubemap(const fs::path& file, const ExrInfo& info) {
  const auto* projection = info.header.find<std::string>("backlight/projection");
  if (projection != nullptr && *projection != name_of(Projection::cubemap))
    return Failure{file.string() + ": its projection is " + *projection + ", not cubemap: it has no faces"};
  const PixelBox& whole = info.layout.display;
  if (!fits_cubemap(whole.width(), whole.height()))
    return Failure{file.string() + ": it is no cubemap of six faces, which is 3:2"};
  if (!(info.layout.data == whole)) return Failure{file.string() + ": it is a crop, not a whole cubemap"};
  return {};
}

Result<void> write_faces(const fs::path& png, const PixelBytes& cube) {
  const int edge = cube.width / 3;
  for (std::size_t face = 0; face < face_names.size(); ++face) {
    PixelBytes picture{edge, edge, 3, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * edge * edge))};
    copy_face(cube.samples, cube.width, face, 3, picture.samples);
    if (auto written = write_png(face_path(png, face), picture); !written.ok()) return written;
  }
  return {};
}

Result<void> write_faces(const fs::path& exr, const ExrPicture& cube) {
  const ImageLayout& whole = cube.image.layout();
  const int edge = whole.display.width() / 3;
  ImageLayout layout = whole;
  layout.display = layout.data = {0, 0, edge, edge};
  for (std::size_t face = 0; face < face_names.size(); ++face) {
    Image picture(layout);
    for (std::size_t channel = 0; channel < picture.channel_count(); ++channel) {
      std::span<float> plane = picture.plane(channel);
      copy_face(cube.image.plane(channel), whole.display.width(), face, 1, plane);
    }
    if (auto written = write_exr(face_path(exr, face), picture, face_header(cube.header, face));
        !written.ok())
      return written;
  }
  return {};
}

}  // namespace backlight
