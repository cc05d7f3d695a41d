#include "gltf_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace backlight::models {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what);
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  if (bytes.size() < at + sizeof word) fail("it is cut short");
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// Those without which all triangles are where they should be.
bool is_known(const std::string& extension) {
  static constexpr const char* begins[] = {"KHR_materials_", "KHR_texture_transform", "KHR_mesh_quantization",
                                           "KHR_lights_punctual", "KHR_xmp"};
  return std::ranges::any_of(begins, [&](const char* its) { return extension.starts_with(its); });
}

std::size_t size_of(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      fail("its numbers are of the type " + std::to_string(type) + ", which there is not");
  }
}

template <class T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double number_at(const char* bytes, int type, bool normalized) {
  switch (type) {
    case 5120:
      return normalized ? std::max(as<std::int8_t>(bytes) / 127.0, -1.0) : as<std::int8_t>(bytes);
    case 5121:
      return as<std::uint8_t>(bytes) / (normalized ? 255.0 : 1.0);
    case 5122:
      return normalized ? std::max(as<std::int16_t>(bytes) / 32767.0, -1.0) : as<std::int16_t>(bytes);
    case 5123:
      return as<std::uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
    case 5125:
      return as<std::uint32_t>(bytes);
    default:
      return as<float>(bytes);
  }
}

std::size_t components_of(const std::string& type) {
  static const std::pair<const char*, std::size_t> known[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, count] : known)
    if (type == name) return count;
  fail("its accessors have the type '" + type + "', which there is not");
}

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string decoded(std::string_view base64) {
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<int, 256> value_of = [] {
    std::array<int, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i)
      values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    return values;
  }();
  std::string bytes;
  bytes.reserve(base64.size() / 4 * 3);
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    const int value = value_of[static_cast<unsigned char>(c)];
    if (value < 0) fail("the base64 text of its data is damaged");
    bits = (bits << 6U | static_cast<unsigned>(value)) & 0xffffffU;
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> static_cast<unsigned>(count) & 0xffU));
  }
  return bytes;
}

}  // namespace

std::size_t whole(const Json& object, const char* key, std::size_t otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  const double value = found->is_number() ? found->get<double>() : -1.0;
  if (!(value >= 0.0 && value < 9e15) || value != std::floor(value))
    fail("its '" + std::string(key) + "' is no whole number");
  return static_cast<std::size_t>(value);
}

std::size_t whole(const Json& object, const char* key) {
  if (object.find(key) == object.end()) fail("its '" + std::string(key) + "' is missing");
  return whole(object, key, 0);
}

void take_numbers(const Json& object, const char* key, std::span<double> into) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  if (!found->is_array() || found->size() != into.size())
    fail("its '" + std::string(key) + "' has not " + std::to_string(into.size()) + " numbers");
  for (std::size_t i = 0; i < into.size(); ++i) {
    const Json& number = (*found)[i];
    if (!number.is_number()) fail("its '" + std::string(key) + "' is not of numbers");
    into[i] = number.get<double>();
  }
}

const Json& object_of(const Json& object, const char* key) {
  static const Json nothing = Json::object();
  const auto found = object.find(key);
  return found != object.end() && found->is_object() ? *found : nothing;
}

GltfFile::GltfFile(const std::string& path) : path_(path), bytes_(path) {
  const std::string_view bytes = bytes_.view();
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) {
    read_container(bytes);
    text = bytes.substr(20, word_at(bytes, 12));
  }
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  try {
    json_ = Json::parse(text);
  } catch (const Json::exception& exception) {
    const std::string what = exception.what();
    fail("it is no glTF: " +
         what.substr(what.find("] ") == std::string::npos ? 0 : what.find("] ") + 2, 120));
  }
  if (!json_.is_object()) fail("it is no glTF");
  const std::string version = text_of(object_of(json_, "asset"), "version");
  if (!version.starts_with("2"))
    fail(version.empty() ? "it is no glTF: it says no version"
                         : "it is of version " + version + " of glTF, not 2");
  check_extensions();
  const Json& list = json_.contains("buffers") ? json_["buffers"] : Json();
  buffers_.resize(list.is_array() ? list.size() : 0);
  known_.resize(buffers_.size());
}

/// The chunks of a .glb: JSON and, perhaps, one of bytes.
void GltfFile::read_container(std::string_view bytes) {
  if (word_at(bytes, 4) != 2)
    fail("it is of version " + std::to_string(word_at(bytes, 4)) + " of glTF, not 2");
  const std::uint64_t json_size = word_at(bytes, 12);
  if (word_at(bytes, 16) != 0x4e4f534aU || 20 + json_size > bytes.size()) fail("it is cut short");
  const std::uint64_t next = 20 + (json_size + 3) / 4 * 4;
  if (next + 8 > bytes.size()) return;
  const std::uint64_t size = word_at(bytes, next);
  if (word_at(bytes, next + 4) != 0x004e4942U) return;
  if (next + 8 + size > bytes.size()) fail("it is cut short");
  binary_ = bytes.substr(next + 8, size);
  has_binary_ = true;
}

void GltfFile::check_extensions() const {
  const auto required = json_.find("extensionsRequired");
  if (required == json_.end() || !required->is_array()) return;
  for (const Json& its : *required) {
    const std::string name = its.is_string() ? its.get<std::string>() : std::string("?");
    if (!is_known(name))
      fail("it requires the extension " + name + ", which is not supported: save it without");
  }
}

const Json& GltfFile::item(const char* list, const Json& number) const {
  const auto found = json_.find(list);
  const std::size_t count = found != json_.end() && found->is_array() ? found->size() : 0;
  const double value = number.is_number() ? number.get<double>() : -1.0;
  if (!(value >= 0.0 && value < static_cast<double>(count)) || value != std::floor(value))
    fail("it names number " + number.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 40) +
         " of its " + list + ", and there are " + std::to_string(count));
  const Json& its = (*found)[static_cast<std::size_t>(value)];
  if (!its.is_object()) fail(std::string("one of its ") + list + " is damaged");
  return its;
}

std::string GltfFile::data_of(const std::string& uri) {
  if (!uri.starts_with("data:")) return {};
  const std::size_t mark = uri.find(";base64,");
  if (mark == std::string::npos || mark > 200) fail("its data is not in base64");
  return decoded(std::string_view(uri).substr(mark + 8));
}

std::string GltfFile::name_of(const std::string& uri) {
  std::string name;
  const auto digit = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
  };
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped =
        uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    name.push_back(escaped ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i]);
    if (escaped) i += 2;
  }
  return name;
}

std::string_view GltfFile::buffer(std::size_t number) {
  const Json& its = item("buffers", number);
  if (known_[number]) return buffers_[number];
  const std::string uri = text_of(its, "uri");
  std::string_view bytes;
  if (uri.empty()) {
    if (number != 0 || !has_binary_) fail("its buffer " + std::to_string(number) + " has no 'uri'");
    bytes = binary_;
  } else if (uri.starts_with("data:")) {
    bytes = *decoded_.emplace_back(std::make_unique<std::string>(data_of(uri)));
  } else {
    const std::filesystem::path path = std::filesystem::path(path_).parent_path() / name_of(uri);
    bytes = mapped_.emplace_back(std::make_unique<FileBytes>(path.string()))->view();
    files.push_back(path.string());
  }
  const std::size_t size = whole(its, "byteLength");
  if (bytes.size() < size) {
    fail("its buffer " + std::to_string(number) + " should have " + std::to_string(size) +
         " bytes, and has " + std::to_string(bytes.size()));
  }
  known_[number] = true;
  return buffers_[number] = bytes.substr(0, size);
}

std::string_view GltfFile::view(const Json& number) {
  const Json& its = item("bufferViews", number);
  const std::string_view bytes = buffer(whole(its, "buffer"));
  const std::size_t offset = whole(its, "byteOffset", 0), size = whole(its, "byteLength");
  if (offset > bytes.size() || size > bytes.size() - offset) fail("a view of a buffer ends beyond it");
  return bytes.substr(offset, size);
}

void GltfFile::fill(std::string_view bytes, std::size_t stride, int type, bool normalized, std::size_t count,
                    std::size_t components, double* to) const {
  const std::size_t size = size_of(type), element = size * components;
  if (stride == 0) stride = element;
  if (count > 0 && (stride > bytes.size() + element || element > bytes.size() ||
                    (count - 1) > (bytes.size() - element) / stride))
    fail("it says that it has " + std::to_string(count) + " numbers where there are less bytes");
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < components; ++k)
      *to++ = number_at(bytes.data() + i * stride + k * size, type, normalized);
}

std::vector<double> GltfFile::numbers(const Json& accessor_number, std::size_t components) {
  const Json& accessor = item("accessors", accessor_number);
  if (components_of(text_of(accessor, "type")) != components)
    fail("an accessor has the type '" + text_of(accessor, "type") + "' where " + std::to_string(components) +
         " numbers are wanted");
  const std::size_t count = whole(accessor, "count");
  if (count > 3 * most_triangles)
    fail("it says that it has " + std::to_string(count) + " vertices or indices");
  const int type = static_cast<int>(std::min<std::size_t>(whole(accessor, "componentType"), 1000000));
  const auto normalized = accessor.find("normalized");
  const bool divided = normalized != accessor.end() && normalized->is_boolean() && normalized->get<bool>();
  const auto number = accessor.find("bufferView");
  std::vector<double> values;
  if (number != accessor.end()) {
    const Json& its = item("bufferViews", *number);
    std::string_view bytes = view(*number);
    const std::size_t offset = whole(accessor, "byteOffset", 0);
    if (offset > bytes.size()) fail("an accessor begins beyond its view");
    bytes.remove_prefix(offset);
    // No more memory than there are bytes.
    if (count > bytes.size())
      fail("it says that it has " + std::to_string(count) + " numbers where there are less bytes");
    values.resize(count * components);
    fill(bytes, whole(its, "byteStride", 0), type, divided, count, components, values.data());
  } else if (accessor.contains("sparse")) {
    values.resize(count * components);  // zeros
  } else {
    fail("an accessor has no numbers: its 'bufferView' is missing");
  }
  put_sparse(accessor, count, components, values);
  return values;
}

void GltfFile::put_sparse(const Json& accessor, std::size_t count, std::size_t components,
                          std::vector<double>& values) {
  if (!accessor.contains("sparse")) return;
  const Json& sparse = object_of(accessor, "sparse");
  const Json &where = object_of(sparse, "indices"), &what = object_of(sparse, "values");
  const std::size_t changed = whole(sparse, "count");
  const auto bytes_of = [&](const Json& its) {
    const std::string_view bytes = view(its.contains("bufferView") ? its["bufferView"] : Json());
    return bytes.substr(std::min(whole(its, "byteOffset", 0), bytes.size()));
  };
  const std::string_view indices = bytes_of(where), numbers = bytes_of(what);
  if (changed > indices.size())
    fail("it says that it has " + std::to_string(changed) + " numbers where there are less bytes");
  std::vector<double> at(changed), to(changed * components);
  const auto type = [](const Json& of) {
    return static_cast<int>(std::min<std::size_t>(whole(of, "componentType"), 1000000));
  };
  fill(indices, 0, type(where), false, changed, 1, at.data());
  const auto normalized = accessor.find("normalized");
  const bool divided = normalized != accessor.end() && normalized->is_boolean() && normalized->get<bool>();
  fill(numbers, 0, type(accessor), divided, changed, components, to.data());
  for (std::size_t i = 0; i < changed; ++i) {
    const std::size_t place = index_below(count, at[i], "the number");
    std::copy_n(to.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(place * components));
  }
}

}  // namespace backlight::models
