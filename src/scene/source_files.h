// A scene file and the files that it includes, merged into one tree.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/base/sha256.h"
#include "backlight/scene/description.h"

namespace backlight {

/// Reads files into a description's sources and merges their tables.
class SourceFiles {
 public:
  SourceFiles(Description& description, Diagnostics& diagnostics)
      : description_(description), diagnostics_(diagnostics) {}

  /// Reads the scene file. False when it cannot be read; the reason is among the diagnostics.
  bool read(const std::filesystem::path& path);

  /// Takes a text as the scene file.
  void take(const std::string& text, const std::string& name, const std::filesystem::path& folder);

  /// Whether every text that was read is TOML.
  [[nodiscard]] bool is_toml() const { return is_toml_; }
  /// Of all bytes read, file after file.
  std::string sha256();

 private:
  // One file on the way from the scene file to the one being read.
  struct Step {
    std::string name;
    std::filesystem::path identity;
  };

  Node parse(const std::string& text, const std::string& name, const std::filesystem::path& folder);
  void merge_includes(Node& root, std::size_t source);
  void include(const Node& written, std::size_t source, Node& merged);
  [[nodiscard]] std::string cycle(const std::filesystem::path& identity, const std::string& name) const;
  void append(Node& merged, Node&& part);

  Description& description_;
  Diagnostics& diagnostics_;
  std::vector<Step> way_;
  std::set<std::filesystem::path> read_;
  Sha256 digest_;
  bool is_toml_ = true;
};

}  // namespace backlight
