// Surfaces made of triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "backlight/base/vector.h"

namespace backlight {

struct WideNode;

/// What a mesh is made of: corners of triangles in local coordinates, with what they have beside their place.
/// Two corners are in the same place where their coordinates are equal, whether or not they are the same one.
struct MeshData {
  std::vector<Vec3> places;                             ///< of corners; finite
  std::vector<Vec3> normals;                            ///< of any length, by corner; empty: flat faces
  std::vector<std::array<double, 2>> texture;           ///< u and v by corner, v downwards; empty: none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of corners, counterclockwise from outside
  std::vector<std::uint32_t> members;  ///< by triangle: SurfacePoint::member; empty: all are 0
};

/// Triangles laid out for the search: in the order of a tree of boxes over them. Immutable; safe to use from
/// many threads, and shared by all surfaces that are copies of one another.
class Mesh {
 public:
  /// Indices must be in range and places finite. Triangles without an area are dropped. The places are kept
  /// relative to `centre`.
  explicit Mesh(MeshData data);
  ~Mesh();
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  /// Where the origin of the kept coordinates is in those that were given: 0, unless the mesh lies far off
  /// it. Few bits, so that differences from it are exact where the places have room for them.
  [[nodiscard]] const Vec3& centre() const { return centre_; }

  [[nodiscard]] std::size_t triangles() const { return data_.triangles.size(); }
  /// How many had no area.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  [[nodiscard]] bool is_smooth() const { return !data_.normals.empty(); }

  /// Whether each edge is that of two triangles, which go along it in opposite ways: the mesh encloses
  /// something. Takes about as long as making the mesh.
  [[nodiscard]] bool is_closed() const;

  /// As kept: relative to `centre`, in the tree's order.
  [[nodiscard]] const MeshData& data() const { return data_; }
  [[nodiscard]] const std::vector<WideNode>& nodes() const { return nodes_; }
  [[nodiscard]] const Vec3& low() const { return low_; }
  [[nodiscard]] const Vec3& high() const { return high_; }
  [[nodiscard]] double radius() const { return radius_; }  ///< of the ball about the origin that holds all

 private:
  void drop_degenerate();
  void measure();
  void lay_out();

  MeshData data_;
  std::vector<std::array<Vec3, 3>> lines_;  ///< dropped ones with three different corners: they join edges
  Vec3 centre_{0.0}, low_{0.0}, high_{0.0};
  double radius_ = 0.0;
  std::size_t dropped_ = 0;
  std::vector<WideNode> nodes_;
};

/// Gives each corner the mean of the normals of the faces around its place, by their angles there, among
/// those that are turned by less than `crease` (radians) from the corner's own face. Corners are split where
/// they have to be.
void add_smooth_normals(MeshData& data, double crease);

}  // namespace backlight
