#include "backlight/surface/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "hierarchy.h"

namespace backlight {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// Of the triangles that a tree's nodes name, in the order in which they do: which was which.
std::vector<std::uint32_t> number_anew(std::vector<WideNode>& nodes, std::size_t triangles) {
  std::vector<std::uint32_t> order;
  order.reserve(triangles);
  for (WideNode& node : nodes) {
    for (std::int32_t& child : node.child) {
      if (child >= 0) continue;
      order.push_back(static_cast<std::uint32_t>(~child));
      child = ~static_cast<std::int32_t>(order.size() - 1);
    }
  }
  return order;
}

template <class T>
void take_in_order(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> taken;
  taken.reserve(order.size());
  for (const std::uint32_t from : order) taken.push_back(values[from]);
  values = std::move(taken);
}

}  // namespace

Mesh::Mesh(MeshData data) : data_(std::move(data)) {
  for (Vec3& place : data_.places) place += 0.0;  // of zeros only the positive one
  // Between corners all normals count alike, however long they are.
  for (Vec3& normal : data_.normals) {
    if (normal != Vec3{0.0}) normal = glm::normalize(of_size_one(normal));
  }
  drop_degenerate();
  measure();
  lay_out();
}

Mesh::~Mesh() = default;

void Mesh::drop_degenerate() {
  const std::size_t all = data_.triangles.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all; ++i) {
    const auto triangle = data_.triangles[i];
    const Vec3 &a = data_.places[triangle[0]], &b = data_.places[triangle[1]], &c = data_.places[triangle[2]];
    const Vec3 size = of_size_one(b - a), other = of_size_one(c - a);
    if (glm::cross(size, other) == Vec3{0.0}) {
      if (a != b && b != c && c != a) lines_.push_back({a, b, c});
      continue;
    }
    if (!data_.members.empty()) data_.members[kept] = data_.members[i];
    data_.triangles[kept++] = triangle;
  }
  dropped_ = all - kept;
  data_.triangles.resize(kept);
  if (!data_.members.empty()) data_.members.resize(kept);
}

void Mesh::measure() {
  if (data_.triangles.empty()) return;
  AxisBox box;
  for (const auto& triangle : data_.triangles) {
    for (const std::uint32_t corner : triangle) box.include({data_.places[corner], data_.places[corner]});
  }
  const Vec3 middle = 0.5 * box.lo + 0.5 * box.hi;
  const double reach = glm::length(0.5 * box.hi - 0.5 * box.lo);
  if (glm::length(middle) > 0.25 * reach) {
    const double step = std::ldexp(1.0, std::ilogb(reach) - 3);
    for (int k = 0; k < 3; ++k) {
      const double whole = std::nearbyint(middle[k] / step) * step;
      centre_[k] = std::isfinite(whole) ? whole : middle[k];
    }
  }
  for (Vec3& place : data_.places) place = (place - centre_) + 0.0;
  low_ = box.lo - centre_;
  high_ = box.hi - centre_;
  for (const auto& triangle : data_.triangles) {
    for (const std::uint32_t corner : triangle)
      radius_ = std::max(radius_, glm::length(data_.places[corner]));
  }
}

/// The tree, with triangles and corners in the order in which it comes by them.
void Mesh::lay_out() {
  std::vector<AxisBox> boxes(data_.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t corner : data_.triangles[i])
      boxes[i].include({data_.places[corner], data_.places[corner]});
  }
  if (boxes.empty()) return;
  nodes_ = wide_tree(boxes);
  boxes = {};
  const std::vector<std::uint32_t> order = number_anew(nodes_, data_.triangles.size());
  take_in_order(data_.triangles, order);
  take_in_order(data_.members, order);
  std::vector<std::uint32_t> number_of(data_.places.size(), nobody), corners;
  corners.reserve(data_.places.size());
  for (auto& triangle : data_.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (number_of[corner] == nobody) {
        number_of[corner] = static_cast<std::uint32_t>(corners.size());
        corners.push_back(corner);
      }
      corner = number_of[corner];
    }
  }
  take_in_order(data_.places, corners);
  take_in_order(data_.normals, corners);
  take_in_order(data_.texture, corners);
}

bool Mesh::is_closed() const {
  // Corners in the same place are one: their numbers are those of the places in order.
  std::vector<std::uint32_t> order(data_.places.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::ranges::sort(
      order, [&](std::uint32_t a, std::uint32_t b) { return before(data_.places[a], data_.places[b]); });
  std::vector<std::uint32_t> place_of(order.size());
  std::uint32_t places = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && data_.places[order[i]] != data_.places[order[i - 1]]) ++places;
    place_of[order[i]] = places;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * data_.triangles.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  };
  for (const auto& [a, b, c] : data_.triangles) add(place_of[a], place_of[b], place_of[c]);
  for (const auto& [a, b, c] : lines_) {
    const auto number = [&](const Vec3& place) {
      const Vec3 kept = (place - centre_) + 0.0;
      const auto found = std::ranges::lower_bound(order, kept, before,
                                                  [&](std::uint32_t corner) { return data_.places[corner]; });
      const bool known = found != order.end() && data_.places[*found] == kept;
      return known ? place_of[*found] : nobody;
    };
    add(number(a), number(b), number(c));
  }
  if (edges.empty()) return false;
  std::ranges::sort(edges);
  if (std::ranges::adjacent_find(edges) != edges.end()) return false;
  return std::ranges::all_of(edges, [&](const auto& edge) {
    return std::ranges::binary_search(edges, std::pair{edge.second, edge.first});
  });
}

}  // namespace backlight
