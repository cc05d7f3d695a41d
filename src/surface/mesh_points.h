// The points of a mesh where lines cross its triangles: a template over the number of lanes, of which one is
// the law.
#pragma once

#include "backlight/surface/ray_sheet.h"
#include "lane_surface.h"
#include "mesh_triangle.h"

namespace backlight {

template <int N>
class MeshPoints {
  using V = Lanes<N>;
  using V3 = LaneVec3<V>;
  using Mask = LaneMask<N>;

 public:
  /// A point in local coordinates, as LocalPoint (shape_table.h).
  struct Point {
    V3 position, gradient;
    V3 shading;  ///< not set of flat faces
    V u, v;      ///< not set unless they are wanted
  };

  /// Where lines cross the triangles of these numbers.
  static BACKLIGHT_LANES Point at(const MeshView& mesh, const std::uint32_t (&triangle)[N],
                                  const LaneLine<V>& line, bool textured) {
    Corners corner;
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < 3; ++k) corner[k][i] = mesh.triangles[triangle[i]][k];
    const V3 a = three(mesh.places, corner[0]), b = three(mesh.places, corner[1]),
             c = three(mesh.places, corner[2]);
    const V3 weight = weights(a, b, c, line);
    const V3 ab = b - a, ac = c - a;
    Point point;
    point.position = a + (weight.y * ab + weight.z * ac);
    const V unit(1.0 / mesh.radius);  // so that no product over- or underflows
    point.gradient = cross(unit * ab, unit * ac);
    if (mesh.normals != nullptr) {
      const V3 mean = weight.x * three(mesh.normals, corner[0]) + weight.y * three(mesh.normals, corner[1]) +
                      weight.z * three(mesh.normals, corner[2]);
      point.shading = select<V>(dot(mean, point.gradient) < V(0.0), -mean, mean);
    }
    if (textured) put_texture(mesh, corner, weight, point);
    return point;
  }

  /// The points of hits `first` to `last`, all on this surface.
  static void run(const MeshView& mesh, const LaneSurface& surface, const RaySheet& rays, int first, int last,
                  const SheetHits& hits, bool textured, SheetPoints& out) {
    const std::uint64_t wanted =
        (last < 64 ? (std::uint64_t{1} << last) - 1 : ~std::uint64_t{0}) & (~std::uint64_t{0} << first);
    for (int i = first / N * N; i < last; i += N) {
      const unsigned lanes = static_cast<unsigned>(wanted >> i) & all_lanes;
      std::uint32_t triangle[N];
      const int sure = __builtin_ctz(lanes);
      for (int k = 0; k < N; ++k)
        triangle[k] = static_cast<std::uint32_t>(hits.part[i + ((lanes >> k & 1U) != 0 ? k : sure)]);
      const V3 origin = rays.one_origin ? V3(V(rays.origin[0][0]), V(rays.origin[1][0]), V(rays.origin[2][0]))
                                        : load3<V>(rays.origin, i);
      const LaneLine<V> line = lane_line(surface, LaneRay<V>{origin, load3<V>(rays.direction, i)});
      const Point point = at(mesh, triangle, line, textured);
      const LanePoint<V> placed =
          in_rest_frame(surface, LaneLocalPoint<V>{point.position, point.gradient}, false);
      put(lanes, placed.position, out.position, i);
      put(lanes, placed.normal, out.normal, i);
      put(lanes, placed.error_bound, out.error_bound + i);
      if (mesh.normals != nullptr)
        put(lanes, shading_normal(surface, point.shading, placed.normal), out.shading_normal, i);
      if (textured) {
        put(lanes, point.u, out.u + i);
        put(lanes, point.v, out.v + i);
      }
      for (unsigned left = mesh.members != nullptr ? lanes : 0; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        out.member[i + k] = static_cast<int>(mesh.members[triangle[k]]);
      }
    }
  }

 private:
  static constexpr unsigned all_lanes = (1U << N) - 1U;
  /// The numbers of the corners.
  using Corners = long long[3][N];

  /// Of each lane, from[step * at[lane]].
  template <int step>
  static BACKLIGHT_LANES V gather(const double* from, const long long (&at)[N]) {
#if defined(__AVX512F__)
    if constexpr (N == 8) {
      __m512i index = _mm512_loadu_si512(at);
      index = step == 3 ? _mm512_add_epi64(index, _mm512_add_epi64(index, index))
                        : _mm512_add_epi64(index, index);
      return (typename V::Vec)_mm512_i64gather_pd(index, from, 8);
    }
#endif
    double all[N];
    for (int i = 0; i < N; ++i) all[i] = from[step * at[i]];
    return V::load(all);
  }

  static BACKLIGHT_LANES V3 three(const double (*from)[3], const long long (&corner)[N]) {
    const double* const x = *from;
    return {gather<3>(x, corner), gather<3>(x + 1, corner), gather<3>(x + 2, corner)};
  }

  static BACKLIGHT_LANES V3 cross(V3 a, V3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }

  /// Of the corners in the crossing; they sum up to 1.
  static BACKLIGHT_LANES V3 weights(V3 a, V3 b, V3 c, const LaneLine<V>& line) {
    const V3 d = line.direction;
    const V x = magnitude(d.x), y = magnitude(d.y), z = magnitude(d.z);
    const Mask along_x = (x >= y) & (x >= z), along_y = y >= z;
    const auto turned = [&](V3 p) __attribute__((always_inline)) {
      return V3(select(along_x, p.x, select(along_y, p.y, p.z)),
                select(along_x, p.y, select(along_y, p.z, p.x)),
                select(along_x, p.z, select(along_y, p.x, p.y)));
    };
    const V3 way = turned(d);
    const TriangleEdges<V> e =
        triangle_edges(turned(a), turned(b), turned(c), turned(line.point), way.y / way.x, way.z / way.x);
    const V inverse = V(1.0) / (e.u + e.v + e.w);
    return {e.u * inverse, e.v * inverse, e.w * inverse};
  }

  static BACKLIGHT_LANES void put_texture(const MeshView& mesh, const Corners& corner, V3 weight,
                                          Point& point) {
    point.u = point.v = V(0.0);
    if (mesh.texture == nullptr) return;
    const double* const u = *mesh.texture;
    const auto mean = [&](const double* of) __attribute__((always_inline)) {
      return weight.x * gather<2>(of, corner[0]) + weight.y * gather<2>(of, corner[1]) +
             weight.z * gather<2>(of, corner[2]);
    };
    point.u = mean(u);
    double v[N];
    mean(u + 1).store(v);
    for (double& its : v)
      if (!(its >= 0.0 && its <= 1.0)) its -= __builtin_floor(its);
    point.v = V::load(v);
  }

  /// Of a smooth mesh; where its normals cancel, the surface's own.
  static BACKLIGHT_LANES V3 shading_normal(const LaneSurface& surface, V3 shading, V3 own) {
    const V zero(0.0);
    const V3 by_rest = surface.local_from_rest.transposed_times(shading);
    return select<V>((shading.x == zero) & (shading.y == zero) & (shading.z == zero), own,
                     (V(1.0) / length(by_rest)) * by_rest);
  }

  /// Stores the lanes of some rays, as the others are.
  static BACKLIGHT_LANES void put(unsigned lanes, V a, double* to) {
    (lanes == all_lanes ? a : select(mask_of_bits<N>(lanes), a, V::load(to))).store(to);
  }
  static BACKLIGHT_LANES void put(unsigned lanes, V3 a, double (*to)[sheet_size], int i) {
    put(lanes, a.x, to[0] + i);
    put(lanes, a.y, to[1] + i);
    put(lanes, a.z, to[2] + i);
  }
};

}  // namespace backlight
