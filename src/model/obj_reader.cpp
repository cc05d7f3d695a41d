// Wavefront OBJ; its .mtl files by tinyobjloader.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

constexpr std::string_view space = " \t\v\f";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && space.find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && space.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  return text;
}

/// Lines as they are meant: those that end in a backslash go on in the next one.
class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {
    if (left_.starts_with("\xef\xbb\xbf")) left_.remove_prefix(3);
  }

  bool next(std::string_view& line) {
    if (left_.empty()) return false;
    line = take();
    if (!line.ends_with('\\')) return true;
    joined_.clear();
    while (line.ends_with('\\')) {
      joined_.append(line.substr(0, line.size() - 1)).append(" ");
      line = left_.empty() ? std::string_view() : take();
    }
    joined_.append(line);
    line = joined_;
    return true;
  }
  /// Of the line, or of the last one of those that it was made of.
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view take() {
    ++number_;
    const std::size_t end = std::min(left_.find_first_of("\r\n"), left_.size());
    const std::string_view line = left_.substr(0, end);
    left_.remove_prefix(std::min(end + (left_.substr(end, 2) == "\r\n" ? 2 : 1), left_.size()));
    return line;
  }

  std::string_view left_;
  std::size_t number_ = 0;
  std::string joined_;
};

class Reader {
 public:
  Reader(const std::string& path, bool normals, Read& read)
      : folder_(std::filesystem::path(path).parent_path()), normals_(normals), read_(read) {}

  void read(std::string_view text) {
    Lines lines(text);
    for (std::string_view line; lines.next(line);) {
      number_ = lines.number();
      read_line(line);
    }
    make_corners();
    name_materials();
  }

 private:
  /// A face's corner: what it names, from 0 on; -1: nothing.
  struct Named {
    std::int32_t place, texture, normal;
  };
  struct Face {
    std::uint32_t corners;
    std::uint32_t material;  // its name's number
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("line " + std::to_string(number_) + ": " + what);
  }

  void read_line(std::string_view line) {
    if (line.find('\0') != std::string_view::npos)
      throw std::runtime_error("line " + std::to_string(number_) + " is no text");
    const std::string_view what = next_word(line, space);
    if (what == "v") {
      places_.push_back(numbers(line, 3));
    } else if (what == "vt") {
      const Triple at = numbers(line, 1);
      texture_.push_back({at[0], at[1]});
    } else if (what == "vn") {
      given_normals_.push_back(numbers(line, 3));
    } else if (what == "f") {
      read_face(line);
    } else if (what == "l" || what == "p") {
      ++read_.left_out;
    } else if (what == "curv" || what == "curv2" || what == "surf") {
      fail("free-form curves and surfaces are not supported: save it as polygons");
    } else if (what == "usemtl") {
      material_ = number_of_name(std::string(trimmed(line)));
    } else if (what == "mtllib") {
      read_libraries(trimmed(line));
    }
  }

  /// The first three of the line's numbers, of which there must be so many.
  Triple numbers(std::string_view line, std::size_t least) const {
    Triple its{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line, space); !word.empty() && word.front() != '#';
         word = next_word(line, space), ++count) {
      double value = 0.0;
      if (!is_number(word, value)) fail("expected finite numbers");
      if (count < 3) its[count] = value;
    }
    if (count < least) fail("expected more numbers");
    return its;
  }

  /// Of `count` so far, counted from 1 or, negative, backwards.
  std::int32_t index(std::string_view& word, std::size_t count, const char* what) const {
    std::int64_t value = 0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    if (read.ec != std::errc()) fail("expected a number of " + std::string(what).substr(4));
    word.remove_prefix(static_cast<std::size_t>(read.ptr - word.data()));
    const std::int64_t at = value > 0 ? value - 1 : value + static_cast<std::int64_t>(count);
    if (value == 0) fail("a face names " + std::string(what) + " 0; they are counted from 1");
    if (at < 0 || at > 0x7ffffffe) fail_of_index(std::to_string(value), count, what);
    return static_cast<std::int32_t>(at);
  }

  void read_face(std::string_view line) {
    Face face{0, material_};
    for (std::string_view word = next_word(line, space); !word.empty() && word.front() != '#';
         word = next_word(line, space), ++face.corners) {
      Named corner{-1, -1, -1};
      corner.place = index(word, places_.size(), "the vertex");
      if (word.starts_with('/')) {
        word.remove_prefix(1);
        if (!word.empty() && word.front() != '/')
          corner.texture = index(word, texture_.size(), "the texture vertex");
        if (word.starts_with('/')) {
          word.remove_prefix(1);
          if (!word.empty()) corner.normal = index(word, given_normals_.size(), "the normal");
        }
      }
      if (!word.empty()) fail("expected numbers of vertices, as in 1/2/3");
      named_.push_back(corner);
    }
    faces_.push_back(face);
  }

  /// Each that is different becomes a corner once.
  void make_corners() {
    struct Known {
      std::int32_t texture, normal;
      std::uint32_t corner, next;
    };
    constexpr std::uint32_t nobody = ~std::uint32_t{0};
    std::vector<std::uint32_t> first(places_.size(), nobody);
    std::vector<Known> known;
    const auto corner_of = [&](Named named) {
      if (!normals_) named.normal = -1;
      std::uint32_t& head = first[static_cast<std::size_t>(named.place)];
      for (std::uint32_t i = head; i != nobody; i = known[i].next)
        if (known[i].texture == named.texture && known[i].normal == named.normal) return known[i].corner;
      const std::uint32_t corner = read_.add_corner(places_[static_cast<std::size_t>(named.place)]);
      if (named.texture >= 0) {
        const auto& at = texture_[static_cast<std::size_t>(named.texture)];
        read_.add_texture(at[0], at[1]);
      }
      if (named.normal >= 0) read_.add_normal(given_normals_[static_cast<std::size_t>(named.normal)]);
      read_.has_normals = read_.has_normals && named.normal >= 0;
      known.push_back({named.texture, named.normal, corner, head});
      head = static_cast<std::uint32_t>(known.size() - 1);
      return corner;
    };
    const auto check = [](std::int32_t index, std::size_t count, const char* what) {
      if (index >= 0 && static_cast<std::size_t>(index) >= count)
        fail_of_index(std::to_string(std::int64_t{index} + 1), count, what);
    };
    std::vector<std::uint32_t> polygon;
    const Named* next = named_.data();
    for (const Face& face : faces_) {
      polygon.clear();
      for (std::uint32_t i = 0; i < face.corners; ++i, ++next) {
        check(next->place, places_.size(), "the vertex");
        check(next->texture, texture_.size(), "the texture vertex");
        check(next->normal, given_normals_.size(), "the normal");
        polygon.push_back(corner_of(*next));
      }
      read_.add_polygon(polygon, face.material);
    }
    if (read_.places.empty()) read_.has_normals = false;
  }

  std::uint32_t number_of_name(const std::string& name) {
    return names_.emplace(name, static_cast<std::uint32_t>(names_.size() + 1)).first->second;
  }

  /// One name, which may have spaces in it, or several.
  void read_libraries(std::string_view line) {
    if (!std::filesystem::is_regular_file(folder_ / line)) {
      for (std::string_view name = next_word(line, space); !name.empty(); name = next_word(line, space))
        read_library(std::string(name));
    } else {
      read_library(std::string(line));
    }
  }

  void read_library(const std::string& name) {
    const std::filesystem::path path = folder_ / name;
    std::ifstream file(path);
    if (!file || !std::filesystem::is_regular_file(path)) {
      if (read_.missing.empty())
        read_.missing = name;  // whether it matters is known when its materials are wanted
      return;
    }
    if (std::ranges::find(read_.files, path.string()) != read_.files.end()) return;
    std::string warnings, errors;
    tinyobj::LoadMtl(&numbers_in_files_, &given_materials_, &file, &warnings, &errors);
    read_.files.push_back(path.string());
  }

  static Material material_of(const tinyobj::material_t& given) {
    Material material;
    material.name = given.name;
    material.texture = given.diffuse_texname;
    std::ranges::replace(material.texture, '\\', '/');
    for (std::size_t k = 0; k < 3; ++k) {
      material.color[k] = given.diffuse[k];
      material.emission[k] = given.emission[k];
    }
    // Many exporters write black beside a texture.
    if (!material.texture.empty() && material.color == Triple{}) material.color = {1.0, 1.0, 1.0};
    return material;
  }

  /// The materials of the files, and after them the one of faces that have none.
  void name_materials() {
    for (const tinyobj::material_t& its : given_materials_) read_.materials.push_back(material_of(its));
    const auto none = static_cast<std::uint32_t>(read_.materials.size());
    read_.materials.emplace_back();
    std::vector<std::uint32_t> number_of(names_.size() + 1, none);
    for (const auto& [name, number] : names_) {
      const auto found = numbers_in_files_.find(name);
      if (found != numbers_in_files_.end()) number_of[number] = static_cast<std::uint32_t>(found->second);
    }
    for (std::uint32_t& material : read_.materials_of_triangles) material = number_of[material];
  }

  std::filesystem::path folder_;
  bool normals_;
  Read& read_;
  std::size_t number_ = 0;  // of the line
  std::vector<Triple> places_, given_normals_;
  std::vector<std::array<double, 2>> texture_;
  std::vector<Named> named_;
  std::vector<Face> faces_;
  std::map<std::string, std::uint32_t> names_;  // of materials, as faces use them: from 1 on
  std::uint32_t material_ = 0;
  std::map<std::string, int> numbers_in_files_;
  std::vector<tinyobj::material_t> given_materials_;
};

}  // namespace

Read read_obj(const std::string& path, bool normals) {
  const FileBytes file(path);
  Read read;
  Reader(path, normals, read).read(file.view());
  read.finish();
  return read;
}

}  // namespace backlight::models
