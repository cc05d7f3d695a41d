// What the readers of the module fill, each from its formats. Errors are exceptions: std::runtime_error.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace backlight::models {

using Triple = std::array<double, 3>;

struct Material {
  std::string name;
  Triple color{0.8, 0.8, 0.8};
  Triple emission{0.0, 0.0, 0.0};
  std::string texture;
  std::string embedded;
};

struct Read {
  // By corner. Where not every corner has a normal, those there are are dropped in the end.
  std::vector<Triple> places, normals;
  std::vector<std::array<double, 2>> texture;  ///< v upwards; empty: of none
  bool has_normals = true;                     ///< of every corner so far
  std::vector<std::uint32_t> indices;          ///< three for each triangle
  std::vector<std::uint32_t> materials_of_triangles;
  std::vector<Material> materials;
  std::vector<std::string> files;
  std::string missing;
  std::size_t left_out = 0;

  /// Adds a corner and returns its number. Fails on what is not finite.
  std::uint32_t add_corner(const Triple& place);
  /// Gives the last corner texture coordinates; those before it that have none have zeros.
  void add_texture(double u, double v);
  /// Gives the last corner a normal. One that is not finite is none.
  void add_normal(const Triple& normal);
  /// Adds the triangles of a polygon, which may be concave; of less than three corners, none.
  void add_polygon(std::span<const std::uint32_t> corners, std::uint32_t material);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material);
  /// To be called when all is read.
  void finish();
};

/// More are not taken.
inline constexpr std::size_t most_triangles = 200'000'000;

Read read_obj(const std::string& path, bool normals);
Read read_ply(const std::string& path, bool normals);
Read read_stl(const std::string& path);
Read read_gltf(const std::string& path, bool normals);

/// Fails where a face names a corner that is not there; `what`: "the vertex" or the like, counted from 0 or
/// from 1.
[[noreturn]] void fail_of_index(const std::string& index, std::size_t count, const char* what);

/// A number of a file as an index below `count`; throws the same where it is none: negative, too large, not
/// whole, not a number.
std::uint32_t index_below(std::size_t count, double number, const char* what);

/// A file's bytes. Fails where it cannot be opened.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path);
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;
  ~FileBytes();
  [[nodiscard]] std::string_view view() const { return {data_, size_}; }

 private:
  const char* data_ = "";
  std::size_t size_ = 0;
};

/// Takes the next word off a text; what is before it is skipped. Empty: there is none.
std::string_view next_word(std::string_view& text, std::string_view space = " \t\r\n\v\f");

/// Whether the whole word is a finite number.
bool is_number(std::string_view word, double& value);

/// The ASCII letters in lower case.
std::string lower(std::string_view text);

}  // namespace backlight::models
