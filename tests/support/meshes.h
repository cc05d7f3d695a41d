// Closed meshes of known bodies.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "backlight/surface/mesh.h"

namespace backlight::test {

/// A ball of 20·4^level triangles about the origin, whose corners are on the sphere.
inline MeshData icosphere(int level, double radius) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  MeshData mesh;
  mesh.places = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& place : mesh.places) place = radius * glm::normalize(place);
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [there, added] =
          middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.places.size()));
      if (added) mesh.places.push_back(radius * glm::normalize(mesh.places[a] + mesh.places[b]));
      return there->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t x = middle(a, b), y = middle(b, c), z = middle(c, a);
      finer.insert(finer.end(), {{a, x, z}, {b, y, x}, {c, z, y}, {x, y, z}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// A torus about the y axis: `around` by `across` quadrilaterals, each cut in two.
inline MeshData torus_mesh(double major, double minor, std::uint32_t around, std::uint32_t across) {
  MeshData mesh;
  const double turn = 2.0 * std::numbers::pi;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = turn * i / around, v = turn * j / across;
      const double rho = major + minor * std::cos(v);
      mesh.places.push_back({rho * std::sin(u), minor * std::sin(v), rho * std::cos(u)});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * across + j % across; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline MeshData box_mesh(const Vec3& size) {
  MeshData mesh;
  for (int i = 0; i < 8; ++i)
    mesh.places.push_back(0.5 * size *
                          Vec3{(i & 4) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 1) != 0 ? 1 : -1});
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

/// As an OBJ file, in which no digit is lost.
inline void write_obj(const std::string& path, const MeshData& mesh) {
  std::ofstream file(path);
  file << std::setprecision(17);
  for (const Vec3& p : mesh.places) file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& [a, b, c] : mesh.triangles) file << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
}

}  // namespace backlight::test
