// Files of models that are written for a test.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "backlight/model/model_file.h"

namespace backlight::test {

inline std::filesystem::path write_model(const std::string& name, const std::string& bytes) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / ("model_" + name);
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline Result<Model> read_bytes(const std::string& name, const std::string& bytes) {
  return read_model(write_model(name, bytes), true);
}

/// A model that must be good.
inline Model good(const std::string& name, const std::string& bytes) {
  Result<Model> read = read_bytes(name, bytes);
  EXPECT_TRUE(read.ok()) << name << ": " << (read.ok() ? "" : read.error());
  return read.ok() ? std::move(read).value() : Model{};
}

/// What is said of a file that must be refused, without its path.
inline std::string refusal(const std::string& name, const std::string& bytes) {
  const Result<Model> read = read_bytes(name, bytes);
  EXPECT_FALSE(read.ok()) << name;
  if (read.ok()) return {};
  const std::string mark = "model_" + name + ": ";
  const std::size_t at = read.error().find(mark);
  return at == std::string::npos ? read.error() : read.error().substr(at + mark.size());
}

/// The coordinates of all triangles' corners, one after the other.
inline std::vector<double> corners_of(const Model& model) {
  std::vector<double> all;
  for (const auto& triangle : model.mesh.triangles)
    for (const std::uint32_t corner : triangle)
      for (int k = 0; k < 3; ++k) all.push_back(model.mesh.places[corner][k]);
  return all;
}

/// Twice the sum of the triangles' areas as vectors: of the whole surface, whatever way it is cut.
inline Vec3 area_of(const Model& model) {
  Vec3 sum{0.0};
  for (const auto& [a, b, c] : model.mesh.triangles) {
    const auto& at = model.mesh.places;
    sum += glm::cross(at[b] - at[a], at[c] - at[a]);
  }
  return sum;
}

/// The same of their sizes: more than area_of() says where some are turned or on one another.
inline double size_of(const Model& model) {
  double sum = 0.0;
  for (const auto& [a, b, c] : model.mesh.triangles) {
    const auto& at = model.mesh.places;
    sum += glm::length(glm::cross(at[b] - at[a], at[c] - at[a]));
  }
  return sum;
}

template <class T>
std::string bytes_of(std::initializer_list<double> numbers, bool big = false) {
  std::string bytes;
  for (const double number : numbers) {
    const T value = static_cast<T>(number);
    std::string its(sizeof value, '\0');
    std::memcpy(its.data(), &value, sizeof value);
    if (big) its.assign(its.rbegin(), its.rend());
    bytes += its;
  }
  return bytes;
}

}  // namespace backlight::test
