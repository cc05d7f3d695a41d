// A glTF 2 file: its JSON and the numbers in its buffers.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "read_model.h"

namespace backlight::models {

using Json = nlohmann::json;

class GltfFile {
 public:
  /// Reads a .gltf or a .glb, as its first bytes say. Fails where it is of another version, or requires an
  /// extension that is not known here.
  explicit GltfFile(const std::string& path);

  [[nodiscard]] const Json& json() const { return json_; }

  /// The object of this number in one of the file's lists: "meshes", "nodes"... Fails where there is none.
  [[nodiscard]] const Json& item(const char* list, const Json& number) const;

  /// `components` numbers for each of an accessor's elements; those of a normalized accessor divided by what
  /// stands for 1.
  std::vector<double> numbers(const Json& accessor_number, std::size_t components);

  /// The bytes of a buffer view.
  std::string_view view(const Json& number);

  /// What a `uri` of data: holds, or an empty text: it names a file.
  static std::string data_of(const std::string& uri);
  /// The file's name in a `uri`, without its escapes.
  static std::string name_of(const std::string& uri);

  std::vector<std::string> files;  ///< others that were read

 private:
  void read_container(std::string_view bytes);
  void check_extensions() const;
  std::string_view buffer(std::size_t number);
  void fill(std::string_view bytes, std::size_t stride, int type, bool normalized, std::size_t count,
            std::size_t components, double* to) const;
  void put_sparse(const Json& accessor, std::size_t count, std::size_t components,
                  std::vector<double>& values);

  std::string path_;
  FileBytes bytes_;
  std::string_view binary_;  // of a .glb
  bool has_binary_ = false;
  Json json_;
  std::vector<std::unique_ptr<FileBytes>> mapped_;
  std::vector<std::unique_ptr<std::string>> decoded_;
  std::vector<std::string_view> buffers_;
  std::vector<bool> known_;
};

/// A number that must be whole and not negative; `otherwise`, where it is missing.
std::size_t whole(const Json& object, const char* key, std::size_t otherwise);
std::size_t whole(const Json& object, const char* key);

/// Numbers of a list, of which there must be as many.
void take_numbers(const Json& object, const char* key, std::span<double> into);

/// The object of a key, or an empty one.
const Json& object_of(const Json& object, const char* key);

}  // namespace backlight::models
