// PLY, ascii and binary.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr TypeName type_names[] = {
    {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
    {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
    {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
    {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
    {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
    {"float64", Type::float64}};
constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};  // by type

struct Property {
  std::string name;
  Type type;                      ///< of its number, or of each in its list
  std::optional<Type> list_size;  ///< of a list: the type of how many there are
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

enum class Format { ascii, little, big };

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;
};

[[noreturn]] void fail_of_line(std::string_view line) {
  throw std::runtime_error("its header is damaged: " + std::string(line.substr(0, 80)));
}

Type type_of(std::string_view word, std::string_view line) {
  const auto* const found = std::ranges::find(type_names, word, &TypeName::name);
  if (found == std::end(type_names)) fail_of_line(line);
  return found->type;
}

void read_format(std::string_view words, std::string_view line, Header& header) {
  const std::string_view name = next_word(words);
  if (name != "ascii" && name != "binary_little_endian" && name != "binary_big_endian") fail_of_line(line);
  header.format = name == "ascii"               ? Format::ascii
                  : name == "binary_big_endian" ? Format::big
                                                : Format::little;
}

void read_element(std::string_view words, std::string_view line, std::uint64_t bytes, Header& header) {
  Element element{std::string(next_word(words)), 0, {}};
  double count = 0.0;
  if (!is_number(next_word(words), count) || !(count >= 0.0) || count != std::floor(count))
    fail_of_line(line);
  std::uint64_t announced = 0;
  for (const Element& other : header.elements) announced += other.count;
  // No element takes less than a byte.
  if (count + static_cast<double>(announced) > static_cast<double>(bytes)) {
    throw std::runtime_error("it says that it has " +
                             std::to_string(static_cast<std::int64_t>(std::min(count, 9e18))) + " of '" +
                             element.name + "', and has " + std::to_string(bytes) + " bytes");
  }
  element.count = static_cast<std::uint64_t>(count);
  header.elements.push_back(element);
}

void read_property(std::string_view words, std::string_view line, Header& header) {
  if (header.elements.empty()) fail_of_line(line);
  std::string_view type = next_word(words);
  Property property{};
  if (type == "list") {
    property.list_size = type_of(next_word(words), line);
    type = next_word(words);
  }
  property.type = type_of(type, line);
  property.name = next_word(words);
  header.elements.back().properties.push_back(property);
}

Header header_of(std::string_view bytes) {
  constexpr std::size_t longest_header = 1 << 16;
  Header header;
  std::string_view left = bytes.substr(0, longest_header);
  bool first = true;
  while (true) {
    // Lines end as those of the first one: binary data may follow the last one at once.
    const std::size_t end = left.find_first_of("\r\n");
    if (end == std::string_view::npos || (first && left.substr(0, end) != "ply"))
      throw std::runtime_error("it has no header of a PLY file");
    const std::string_view line = left.substr(0, end);
    const bool pair = left.substr(end, 2) == "\r\n";
    left.remove_prefix(end + (pair ? 2 : 1));
    first = false;
    std::string_view words = line;
    const std::string_view what = next_word(words);
    if (what == "format") read_format(words, line, header);
    if (what == "element") read_element(words, line, bytes.size(), header);
    if (what == "property") read_property(words, line, header);
    if (what == "end_header") break;
  }
  header.size = static_cast<std::size_t>(left.data() - bytes.data());
  return header;
}

/// The numbers of a file, one after the other.
class Numbers {
 public:
  Numbers(std::string_view bytes, Format format) : left_(bytes), format_(format) {}

  /// Fails where they end.
  double next(Type type, const Element& element) {
    if (format_ == Format::ascii) {
      double value = 0.0;
      const std::string_view word = next_word(left_);
      if (word.empty()) fail_of_end(element);
      if (!is_number(word, value))
        throw std::runtime_error("among its '" + element.name + "' is '" + std::string(word.substr(0, 40)) +
                                 "', which is no finite number");
      return value;
    }
    const std::size_t size = sizes[static_cast<std::size_t>(type)];
    if (left_.size() < size) fail_of_end(element);
    char bytes[8];
    std::memcpy(bytes, left_.data(), sizeof bytes < left_.size() ? sizeof bytes : left_.size());
    left_.remove_prefix(size);
    if ((format_ == Format::big) == (std::endian::native == std::endian::little))
      std::reverse(bytes, bytes + size);
    return number_of(type, bytes);
  }

  /// How many there are in a list.
  std::size_t next_count(const Property& list, const Element& element) {
    const double count = next(*list.list_size, element);
    if (!(count >= 0.0) || count != std::floor(count)) {
      throw std::runtime_error("a list '" + list.name + "' of its '" + element.name + "' has " +
                               std::to_string(count) + " numbers");
    }
    if (count > static_cast<double>(left_.size())) fail_of_end(element);
    return static_cast<std::size_t>(count);
  }

 private:
  template <class T>
  static double as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }
  static double number_of(Type type, const char* bytes) {
    switch (type) {
      case Type::int8:
        return as<std::int8_t>(bytes);
      case Type::uint8:
        return as<std::uint8_t>(bytes);
      case Type::int16:
        return as<std::int16_t>(bytes);
      case Type::uint16:
        return as<std::uint16_t>(bytes);
      case Type::int32:
        return as<std::int32_t>(bytes);
      case Type::uint32:
        return as<std::uint32_t>(bytes);
      case Type::float32:
        return as<float>(bytes);
      case Type::float64:
        break;
    }
    return as<double>(bytes);
  }

  [[noreturn]] static void fail_of_end(const Element& element) {
    throw std::runtime_error("it is cut short: it ends within its " + std::to_string(element.count) +
                             " of '" + element.name + "'");
  }

  std::string_view left_;
  Format format_;
};

class Reader {
 public:
  Reader(Numbers numbers, bool normals, Read& read) : numbers_(numbers), normals_(normals), read_(read) {}

  void read(const Element& element) {
    if (element.name == "vertex") {
      read_vertices(element);
      return;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      corners_.clear();
      texture_.clear();
      for (const Property& property : element.properties) read_property(element, property);
      if (element.name == "face") add_face();
      if (element.name == "tristrips") add_strips();
    }
  }

 private:
  /// Where a property of a vertex belongs, or 8: nowhere.
  static std::size_t slot_of(const std::string& name) {
    constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
    constexpr std::string_view others[] = {"s", "t", "texture_u", "texture_v"};
    const auto* const found = std::ranges::find(names, name);
    if (found != std::end(names)) return static_cast<std::size_t>(found - names);
    const auto* const other = std::ranges::find(others, name);
    return other == std::end(others) ? 8 : 6 + static_cast<std::size_t>(other - others) % 2;
  }

  void read_vertices(const Element& element) {
    std::vector<std::size_t> slots;
    bool has[9]{};
    for (const Property& property : element.properties) {
      slots.push_back(property.list_size ? 8 : slot_of(property.name));
      has[slots.back()] = true;
    }
    if (!has[0] || !has[1] || !has[2]) throw std::runtime_error("its vertices have no x, y and z");
    const bool has_normals = normals_ && has[3] && has[4] && has[5], has_texture = has[6] && has[7];
    read_.has_normals = has_normals;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      double at[9]{};
      for (std::size_t k = 0; k < slots.size(); ++k) {
        const Property& property = element.properties[k];
        std::size_t count = property.list_size ? numbers_.next_count(property, element) : 1;
        for (; count > 0; --count) at[slots[k]] = numbers_.next(property.type, element);
      }
      read_.add_corner({at[0], at[1], at[2]});
      if (has_normals) read_.add_normal({at[3], at[4], at[5]});
      if (has_texture) read_.add_texture(at[6], at[7]);
    }
    vertices_ = read_.places.size();
  }

  void read_property(const Element& element, const Property& property) {
    std::size_t count = property.list_size ? numbers_.next_count(property, element) : 1;
    const bool is_corners =
        property.list_size && (property.name == "vertex_indices" || property.name == "vertex_index");
    const bool is_texture = property.list_size && property.name == "texcoord";
    for (; count > 0; --count) {
      const double number = numbers_.next(property.type, element);
      if (is_corners) corners_.push_back(number);
      if (is_texture) texture_.push_back(number);
    }
  }

  std::uint32_t corner(double number) const {
    if (vertices_ == 0) throw std::runtime_error("it has faces before its vertices, or no vertices");
    return index_below(vertices_, number, "the vertex");
  }

  void add_face() {
    polygon_.clear();
    for (const double number : corners_) polygon_.push_back(corner(number));
    if (!texture_.empty() && texture_.size() == 2 * corners_.size()) {
      // Corners of its own for each face.
      for (std::size_t i = 0; i < polygon_.size(); ++i) {
        const std::uint32_t shared = polygon_[i];
        polygon_[i] = read_.add_corner(Triple(read_.places[shared]));
        if (read_.has_normals) read_.add_normal(Triple(read_.normals[shared]));
        read_.add_texture(texture_[2 * i], texture_[2 * i + 1]);
      }
    }
    read_.add_polygon(polygon_, 0);
  }

  /// Each corner with the two before it, every other triangle turned; -1 begins anew.
  void add_strips() {
    std::size_t in_strip = 0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      in_strip = corners_[i] == -1.0 ? 0 : in_strip + 1;
      if (in_strip < 3) continue;
      const bool turned = in_strip % 2 == 0;
      read_.add_triangle(corner(corners_[i - (turned ? 1 : 2)]), corner(corners_[i - (turned ? 2 : 1)]),
                         corner(corners_[i]), 0);
    }
  }

  Numbers numbers_;
  bool normals_;
  Read& read_;
  std::size_t vertices_ = 0;
  std::vector<double> corners_, texture_;  // of the face that is being read
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Read read_ply(const std::string& path, bool normals) {
  const FileBytes file(path);
  const Header header = header_of(file.view());
  Read read;
  read.has_normals = false;
  read.materials.emplace_back();
  Reader reader(Numbers(file.view().substr(header.size), header.format), normals, read);
  for (const Element& element : header.elements) reader.read(element);
  read.finish();
  return read;
}

}  // namespace backlight::models
