// The normals of smooth meshes whose files have none.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "backlight/surface/mesh.h"

namespace backlight {
namespace {

/// A triangle's corner.
struct Wedge {
  std::uint32_t triangle, corner;
};

/// The unit normal of a face; of one without an area, zero.
Vec3 normal_of(const MeshData& data, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3& a = data.places[triangle[0]];
  const Vec3 normal =
      glm::cross(of_size_one(data.places[triangle[1]] - a), of_size_one(data.places[triangle[2]] - a));
  const double length = glm::length(normal);
  return length > 0.0 ? normal / length : Vec3{0.0};
}

double angle_at(const MeshData& data, const std::array<std::uint32_t, 3>& triangle, std::uint32_t corner) {
  const Vec3& at = data.places[triangle[corner]];
  const Vec3 one = of_size_one(data.places[triangle[(corner + 1) % 3]] - at);
  const Vec3 other = of_size_one(data.places[triangle[(corner + 2) % 3]] - at);
  return std::atan2(glm::length(glm::cross(one, other)), glm::dot(one, other));
}

/// The triangles' corners, those of the same place together.
std::vector<Wedge> by_place(const MeshData& data) {
  std::vector<std::uint32_t> corners(data.places.size());
  std::iota(corners.begin(), corners.end(), 0U);
  const auto key = [&](std::uint32_t corner) {
    const Vec3& at = data.places[corner];
    return std::array{at.x, at.y, at.z};
  };
  std::ranges::sort(corners, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> rank(corners.size());
  for (std::uint32_t i = 0, place = 0; i < corners.size(); ++i) {
    if (i > 0 && data.places[corners[i]] != data.places[corners[i - 1]]) ++place;
    rank[corners[i]] = place;
  }
  // Counted into their places.
  std::vector<std::uint32_t> begin(corners.size() + 1, 0);
  for (const auto& triangle : data.triangles) {
    for (const std::uint32_t corner : triangle) ++begin[rank[corner] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Wedge> wedges(3 * data.triangles.size());
  for (std::uint32_t i = 0; i < data.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) wedges[begin[rank[data.triangles[i][k]]]++] = {i, k};
  }
  return wedges;
}

}  // namespace

void add_smooth_normals(MeshData& data, double crease) {
  const double least_cosine = std::cos(crease);
  std::vector<Vec3> faces(data.triangles.size());
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = normal_of(data, data.triangles[i]);
  const std::vector<Wedge> wedges = by_place(data);
  const auto place_of = [&](const Wedge& wedge) {
    return data.places[data.triangles[wedge.triangle][wedge.corner]];
  };
  data.normals.assign(data.places.size(), Vec3{0.0});
  std::vector<Vec3> normals;
  std::vector<double> angles;
  struct Split {
    std::uint32_t from, corner;
  };
  std::vector<Split> split;  // at a place
  for (std::size_t first = 0, last = 0; first < wedges.size(); first = last) {
    const Vec3 place = place_of(wedges[first]);
    while (last < wedges.size() && place_of(wedges[last]) == place) ++last;
    normals.assign(last - first, Vec3{0.0});
    angles.clear();
    for (std::size_t i = first; i < last; ++i)
      angles.push_back(angle_at(data, data.triangles[wedges[i].triangle], wedges[i].corner));
    for (std::size_t i = first; i < last; ++i) {
      const Vec3& own = faces[wedges[i].triangle];
      for (std::size_t k = first; k < last; ++k) {
        const Vec3& other = faces[wedges[k].triangle];
        if (k != i && !(glm::dot(own, other) >= least_cosine)) continue;
        normals[i - first] += angles[k - first] * other;
      }
    }
    split.clear();
    for (std::size_t i = first; i < last; ++i) {
      std::uint32_t& corner = data.triangles[wedges[i].triangle][wedges[i].corner];
      const Vec3& normal = normals[i - first];
      if (data.normals[corner] == Vec3{0.0} || data.normals[corner] == normal) {
        data.normals[corner] = normal;
        continue;
      }
      const auto known = std::ranges::find_if(
          split, [&](const Split& its) { return its.from == corner && data.normals[its.corner] == normal; });
      if (known != split.end()) {
        corner = known->corner;
        continue;
      }
      split.push_back({corner, static_cast<std::uint32_t>(data.places.size())});
      data.places.push_back(place);
      data.normals.push_back(normal);
      if (!data.texture.empty()) data.texture.push_back(data.texture[corner]);
      corner = static_cast<std::uint32_t>(data.places.size() - 1);
    }
  }
}

}  // namespace backlight
