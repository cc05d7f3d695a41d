// glTF 2: the triangles of its scene, and their materials.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "gltf_file.h"

namespace backlight::models {
namespace {

/// Rows of a linear map and where the origin goes.
using Matrix = std::array<std::array<double, 4>, 3>;

Matrix times(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
      if (j == 3) product[i][j] += a[i][3];
    }
  }
  return product;
}

Triple place_in(const Matrix& m, const double* v) {
  Triple place{};
  for (std::size_t i = 0; i < 3; ++i) place[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2] + m[i][3];
  return place;
}

double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// By the matrix of cofactors, as normals go; of a mirrored one by its opposite: outwards still.
Triple normal_in(const Matrix& m, const double* n) {
  Triple normal{};
  const double way = determinant(m) < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &b = m[(i + 1) % 3], &c = m[(i + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
      normal[i] += way * (b[k] * c[l] - b[l] * c[k]) * n[j];
    }
  }
  return normal;
}

/// By its matrix, or by its scale, rotation and translation.
Matrix matrix_of(const Json& node) {
  Matrix m{{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}}};
  if (node.contains("matrix")) {
    double column[16];
    take_numbers(node, "matrix", column);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) m[i][j] = column[4 * j + i];
    return m;
  }
  double t[3]{}, q[4]{0.0, 0.0, 0.0, 1.0}, s[3]{1.0, 1.0, 1.0};
  take_numbers(node, "translation", t);
  take_numbers(node, "rotation", q);
  take_numbers(node, "scale", s);
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(size > 0.0)) throw std::runtime_error("a node's 'rotation' is zero");
  for (double& x : q) x /= size;
  const auto [x, y, z, w] = std::array{q[0], q[1], q[2], q[3]};
  const double turn[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)},
                             {2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)},
                             {2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = turn[i][j] * s[j];
    m[i][3] = t[i];
  }
  return m;
}

/// How a texture is laid: which coordinates it takes, and what is done with them (KHR_texture_transform).
struct Laying {
  std::size_t set = 0;
  double offset[2]{0.0, 0.0}, scale[2]{1.0, 1.0};
  double rotation = 0.0;
};

std::string name_in(const Json& object) {
  const auto found = object.find("name");
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

class Materials {
 public:
  Materials(GltfFile& file, Read& read) : file_(file), read_(read) {
    const auto list = file.json().find("materials");
    const std::size_t count = list != file.json().end() && list->is_array() ? list->size() : 0;
    for (std::size_t i = 0; i < count; ++i) add(file.item("materials", i));
    read.materials.emplace_back();
    layings_.emplace_back();
  }

  /// The number of a primitive's material; of none, that of the grey one.
  [[nodiscard]] std::uint32_t number_of(const Json& primitive) const {
    const auto given = primitive.find("material");
    if (given == primitive.end()) return static_cast<std::uint32_t>(layings_.size() - 1);
    static_cast<void>(file_.item("materials", *given));  // fails if there is none
    return static_cast<std::uint32_t>(given->get<double>());
  }
  [[nodiscard]] const Laying& laying(std::uint32_t material) const { return layings_[material]; }

 private:
  void add(const Json& given) {
    Material material;
    material.name = name_in(given);
    Laying laying;
    const Json& glossy = object_of(object_of(given, "extensions"), "KHR_materials_pbrSpecularGlossiness");
    const bool is_glossy = !given.contains("pbrMetallicRoughness") && !glossy.empty();
    const Json& base = is_glossy ? glossy : object_of(given, "pbrMetallicRoughness");
    double factor[4]{1.0, 1.0, 1.0, 1.0};
    take_numbers(base, is_glossy ? "diffuseFactor" : "baseColorFactor", factor);
    std::copy_n(factor, 3, material.color.begin());
    const Json& texture = object_of(base, is_glossy ? "diffuseTexture" : "baseColorTexture");
    if (!texture.empty()) put_texture(texture, material, laying);
    put_emission(given, material);
    read_.materials.push_back(material);
    layings_.push_back(laying);
  }

  void put_emission(const Json& given, Material& material) {
    take_numbers(given, "emissiveFactor", material.emission);
    double strength = 1.0;
    const Json& its = object_of(object_of(given, "extensions"), "KHR_materials_emissive_strength");
    if (its.contains("emissiveStrength") && its["emissiveStrength"].is_number())
      strength = its["emissiveStrength"].get<double>();
    for (double& x : material.emission) x *= strength;
    if (given.contains("emissiveTexture")) material.emission = {};  // it is not all of it that glows
  }

  void put_texture(const Json& given, Material& material, Laying& laying) {
    laying.set = whole(given, "texCoord", 0);
    const Json& transform = object_of(object_of(given, "extensions"), "KHR_texture_transform");
    laying.set = whole(transform, "texCoord", laying.set);
    take_numbers(transform, "offset", laying.offset);
    take_numbers(transform, "scale", laying.scale);
    if (transform.contains("rotation") && transform["rotation"].is_number())
      laying.rotation = transform["rotation"].get<double>();
    const Json& texture = file_.item("textures", given.contains("index") ? given["index"] : Json());
    if (!texture.contains("source")) {  // an error where it is wanted
      material.texture = "(a texture that is neither PNG nor JPEG)";
      return;
    }
    const Json& image = file_.item("images", texture["source"]);
    if (image.contains("bufferView")) {
      material.embedded = file_.view(image["bufferView"]);
    } else if (image.contains("uri") && image["uri"].is_string()) {
      const std::string uri = image["uri"].get<std::string>();
      material.embedded = GltfFile::data_of(uri);
      if (material.embedded.empty()) material.texture = GltfFile::name_of(uri);
    } else {
      throw std::runtime_error("one of its images has neither 'uri' nor 'bufferView'");
    }
  }

  GltfFile& file_;
  Read& read_;
  std::vector<Laying> layings_;
};

class Reader {
 public:
  Reader(GltfFile& file, bool normals, Read& read)
      : file_(file), normals_(normals), read_(read), materials_(file, read) {}

  void read() {
    constexpr Matrix unit{{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}}};
    const Json& json = file_.json();
    const auto scenes = json.find("scenes");
    if (scenes == json.end() || scenes->empty()) throw std::runtime_error("it has no scene");
    const Json& scene = file_.item("scenes", json.contains("scene") ? json["scene"] : Json(0));
    for_each_of(scene, "nodes", [&](const Json& node) { visit(node, unit, 0); });
  }

 private:
  template <class Work>
  static void for_each_of(const Json& object, const char* key, const Work& work) {
    const auto list = object.find(key);
    if (list == object.end()) return;
    if (!list->is_array()) throw std::runtime_error("its '" + std::string(key) + "' is no list");
    for (const Json& its : *list) work(its);
  }

  /// Nodes are a tree: one that comes again has two parents, or is within itself.
  void visit(const Json& number, const Matrix& outer, int depth) {
    constexpr int deepest = 1000;
    if (depth > deepest) throw std::runtime_error("its nodes are nested more than 1000 deep");
    const Json& node = file_.item("nodes", number);
    const auto index = static_cast<std::size_t>(number.get<double>());
    if (visited_.size() <= index) visited_.resize(index + 1);
    if (visited_[index]) {
      throw std::runtime_error("its node " + std::to_string(index) +
                               " is within itself, or in its scene more than once");
    }
    visited_[index] = true;
    const Matrix here = times(outer, matrix_of(node));
    if (node.contains("mesh")) {
      const Json& mesh = file_.item("meshes", node["mesh"]);
      for_each_of(mesh, "primitives", [&](const Json& primitive) { add(primitive, here); });
    }
    for_each_of(node, "children", [&](const Json& child) { visit(child, here, depth + 1); });
  }

  void add(const Json& primitive, const Matrix& matrix) {
    const std::size_t mode = whole(primitive, "mode", 4);
    const Json& attributes = object_of(primitive, "attributes");
    if (!attributes.contains("POSITION")) return;  // as the standard has it
    const std::vector<double> places = file_.numbers(attributes["POSITION"], 3);
    const std::size_t vertices = places.size() / 3;
    std::optional<std::vector<double>> indices;
    if (primitive.contains("indices")) indices = file_.numbers(primitive["indices"], 1);
    const std::size_t count = indices ? indices->size() : vertices;
    if (mode < 4) {
      read_.left_out += mode == 1 ? count / 2 : mode == 3 && count > 0 ? count - 1 : count;
      return;
    }
    const std::uint32_t material = materials_.number_of(primitive);
    const auto first = static_cast<std::uint32_t>(read_.places.size());
    add_corners(places, attributes, matrix, materials_.laying(material));
    const auto corner = [&](std::size_t i) {
      return first + index_below(vertices, indices ? (*indices)[i] : static_cast<double>(i), "the vertex");
    };
    const bool mirrored = determinant(matrix) < 0.0;
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
      read_.add_triangle(corner(a), corner(mirrored ? c : b), corner(mirrored ? b : c), material);
    };
    if (mode == 4) {
      for (std::size_t i = 0; i + 2 < count; i += 3) triangle(i, i + 1, i + 2);
    } else if (mode == 5) {
      for (std::size_t i = 0; i + 2 < count; ++i) triangle(i, i + 1 + i % 2, i + 2 - i % 2);
    } else if (mode == 6) {
      for (std::size_t i = 0; i + 2 < count; ++i) triangle(0, i + 1, i + 2);
    } else {
      throw std::runtime_error("it has primitives of the mode " + std::to_string(mode) +
                               ", which there is not");
    }
  }

  void add_corners(const std::vector<double>& places, const Json& attributes, const Matrix& matrix,
                   const Laying& laying) {
    const std::size_t vertices = places.size() / 3;
    const auto other = [&](const std::string& name, std::size_t components) {
      std::vector<double> numbers;
      if (attributes.contains(name)) numbers = file_.numbers(attributes[name], components);
      if (!numbers.empty() && numbers.size() != components * vertices)
        throw std::runtime_error("it has " + std::to_string(vertices) + " vertices, and " + name + " of " +
                                 std::to_string(numbers.size() / components));
      return numbers;
    };
    const std::vector<double> normals = normals_ ? other("NORMAL", 3) : std::vector<double>();
    const std::vector<double> texture = other("TEXCOORD_" + std::to_string(laying.set), 2);
    read_.has_normals = read_.has_normals && !normals.empty();
    const double cosine = std::cos(laying.rotation), sine = std::sin(laying.rotation);
    for (std::size_t i = 0; i < vertices; ++i) {
      read_.add_corner(place_in(matrix, &places[3 * i]));
      if (!normals.empty()) read_.add_normal(normal_in(matrix, &normals[3 * i]));
      if (texture.empty()) continue;
      const double u = laying.scale[0] * texture[2 * i], v = laying.scale[1] * texture[2 * i + 1];
      read_.add_texture(cosine * u + sine * v + laying.offset[0],
                        1.0 - (cosine * v - sine * u + laying.offset[1]));
    }
  }

  GltfFile& file_;
  bool normals_;
  Read& read_;
  Materials materials_;
  std::vector<bool> visited_;
};

}  // namespace

Read read_gltf(const std::string& path, bool normals) {
  GltfFile file(path);
  Read read;
  Reader(file, normals, read).read();
  if (read.places.empty()) read.has_normals = false;
  read.files = file.files;
  read.finish();
  return read;
}

}  // namespace backlight::models
