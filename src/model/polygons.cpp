// Polygons cut into triangles.
#include <algorithm>
#include <cmath>

#include "read_model.h"

namespace backlight::models {
namespace {

struct Flat {
  double x, y;
};

/// Twice the signed area of a triangle: positive where it goes round counterclockwise.
double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners as seen from where the polygon goes round counterclockwise, along an axis.
std::vector<Flat> flattened(const std::vector<Triple>& places, std::span<const std::uint32_t> corners) {
  Triple normal{};  // by M. E. Newell's sum
  const Triple& origin = places[corners[0]];
  const auto from_origin = [&](std::size_t i, std::size_t k) {
    return places[corners[i % corners.size()]][k] - origin[k];
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      normal[k] += from_origin(i, l) * from_origin(i + 1, m) - from_origin(i, m) * from_origin(i + 1, l);
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
  if (normal[axis] < 0.0) std::swap(across, up);
  std::vector<Flat> flat;
  for (std::size_t i = 0; i < corners.size(); ++i)
    flat.push_back({from_origin(i, across), from_origin(i, up)});
  return flat;
}

class Cutter {
 public:
  Cutter(std::vector<Flat> flat) : flat_(std::move(flat)), left_(flat_.size()) {
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = i;
  }

  [[nodiscard]] bool is_convex() const {
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (!(turn_at(i) >= 0.0)) return false;
    return true;
  }

  /// Calls add(a, b, c) for each triangle: one corner after the other whose triangle has no other corner in
  /// it.
  template <class Add>
  void cut(const Add& add) {
    while (left_.size() > 3) {
      const std::size_t ear = next_ear();
      add(at(ear + left_.size() - 1), at(ear), at(ear + 1));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    add(left_[0], left_[1], left_[2]);
  }

 private:
  [[nodiscard]] std::size_t at(std::size_t i) const { return left_[i % left_.size()]; }
  [[nodiscard]] double turn_at(std::size_t i) const {
    return turn(flat_[at(i + left_.size() - 1)], flat_[at(i)], flat_[at(i + 1)]);
  }

  [[nodiscard]] bool is_empty(std::size_t i) const {
    const Flat &a = flat_[at(i + left_.size() - 1)], &b = flat_[at(i)], &c = flat_[at(i + 1)];
    return std::ranges::none_of(left_, [&](std::size_t other) {
      const Flat& p = flat_[other];
      const auto same = [&](const Flat& q) { return p.x == q.x && p.y == q.y; };
      return !same(a) && !same(b) && !same(c) && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 &&
             turn(c, a, p) >= 0.0;
    });
  }

  /// Of a polygon that crosses itself there may be none: then any corner will do.
  [[nodiscard]] std::size_t next_ear() const {
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) > 0.0 && is_empty(i)) return i;
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) == 0.0) return i;
    return 0;
  }

  std::vector<Flat> flat_;
  std::vector<std::size_t> left_;
};

double square_of_distance(const Triple& a, const Triple& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

}  // namespace

void Read::add_polygon(std::span<const std::uint32_t> corners, std::uint32_t material) {
  const std::size_t count = corners.size();
  if (count < 3) {
    ++left_out;
    return;
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    add_triangle(corners[a], corners[b], corners[c], material);
  };
  if (count == 3) return add(0, 1, 2);
  Cutter cutter(flattened(places, corners));
  if (!cutter.is_convex()) return cutter.cut(add);
  // A bent quadrilateral is cut along its shorter diagonal.
  if (count == 4 && !(square_of_distance(places[corners[0]], places[corners[2]]) <
                      square_of_distance(places[corners[1]], places[corners[3]]))) {
    add(0, 1, 3);
    return add(1, 2, 3);
  }
  for (std::size_t i = 2; i < count; ++i) add(0, i - 1, i);
}

}  // namespace backlight::models
