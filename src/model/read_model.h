// What the readers of the module fill, each from its formats. Errors are exceptions: std::runtime_error.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace backlight::models {

struct Material {
  std::string name;
  std::array<double, 3> color{0.8, 0.8, 0.8};
  std::array<double, 3> emission{0.0, 0.0, 0.0};
  std::string texture;
  std::string embedded;
};

struct Corner {
  std::array<double, 3> place{};
  std::array<double, 3> normal{};
  std::array<double, 2> texture{};
  friend bool operator==(const Corner&, const Corner&) = default;
};

/// Corners by their numbers, each kept once.
class CornerTable {
 public:
  /// The number of a corner that is equal to this one in every bit.
  std::uint32_t add(const Corner& corner);

  bool has_normals = true;   ///< of every corner so far
  bool has_texture = false;  ///< of any
  std::vector<double> places, normals, texture;

 private:
  [[nodiscard]] std::size_t size() const { return places.size() / 3; }
  [[nodiscard]] bool is(std::uint32_t number, const Corner& corner) const;
  void grow();
  std::vector<std::uint32_t> slots_;
};

struct Read {
  CornerTable corners;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> materials_of_triangles;
  std::vector<Material> materials;
  std::vector<std::string> files;
  std::string missing;
  std::size_t left_out = 0;
};

/// More are not taken.
inline constexpr std::size_t most_triangles = 200'000'000;

Read read_obj(const std::string& path, bool normals);
Read read_by_assimp(const std::string& path, bool normals);

/// Fails where a line of an OBJ file has something else than finite numbers where they belong: tinyobjloader
/// reads that as 0.
void check_obj_text(const std::string& path);

/// Fails where the header of a PLY file announces more than the file can have.
void check_ply_header(const std::string& path);

/// Fails on a place, normal or texture coordinate that is not finite.
void check_finite(const Corner& corner);

}  // namespace backlight::models
