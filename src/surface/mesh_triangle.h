// A triangle as lines see it: a template over lanes, the same bits for any number of them.
//
// The test is that of S. Woop, C. Benthin and I. Wald, "Watertight ray/triangle intersection", 2013: the
// corners, relative to the line, are sheared so that the line is an axis, and the signs of three cross
// products tell on which side of each edge it passes. Triangles that share an edge compute the same products
// for it, and rounding is monotonic, so a sign is right for the rounded corners or is 0. Where it is 0 the
// product is computed with its errors (exact.h), and if it is 0 indeed, the line is taken to pass a little
// aside, in the same direction for all edges. So a line through an edge or a corner crosses a closed mesh as
// one next to it does.
#pragma once

#include <cstdint>

#include "exact.h"

namespace backlight {

struct WideNode;

/// A mesh as plain numbers.
struct MeshView {
  const WideNode* nodes;
  const double (*places)[3];
  const double (*normals)[3] = nullptr;  ///< null: flat faces
  const double (*texture)[2] = nullptr;  ///< null: none
  const std::uint32_t (*triangles)[3];
  const std::uint32_t* members = nullptr;  ///< null: there is but one
  double low[3]{}, high[3]{};              ///< its box
  double radius;                           ///< of the ball about the origin that holds all
};

/// Cross products of the corners as seen along a line, and how far along its axis the corners are.
template <class V>
struct TriangleEdges {
  V u, v, w;                 // opposite to each corner
  V side_u, side_v, side_w;  // their signs; of what is not 0 they are the products themselves
  V at_a, at_b, at_c;
};

/// Of a cross product p×q that is 0: its value, exact as to its sign, and the sign of what it is for a line
/// that passes a little aside.
template <class V>
BACKLIGHT_LANES void decide_edge(V px, V py, V qx, V qy, V& product, V& side) {
  const V zero(0.0);
  const auto unsure = product == zero;
  product = select(unsure, difference_of_products(px, qy, py, qx), product);
  const V aside = select(py == qy, qx - px, py - qy);
  side = select(product == zero, aside, product);
}

/// Coordinates are in the order of the line's axes: the one that it goes along most, and the two after it.
template <class V>
BACKLIGHT_LANES TriangleEdges<V> triangle_edges(LaneVec3<V> A, LaneVec3<V> B, LaneVec3<V> C,
                                                LaneVec3<V> point, V shear_y, V shear_z) {
  TriangleEdges<V> e;
  e.at_a = A.x - point.x;
  e.at_b = B.x - point.x;
  e.at_c = C.x - point.x;
  const V ax = (A.y - point.y) - shear_y * e.at_a, ay = (A.z - point.z) - shear_z * e.at_a;
  const V bx = (B.y - point.y) - shear_y * e.at_b, by = (B.z - point.z) - shear_z * e.at_b;
  const V cx = (C.y - point.y) - shear_y * e.at_c, cy = (C.z - point.z) - shear_z * e.at_c;
  e.u = cx * by - cy * bx;
  e.v = ax * cy - ay * cx;
  e.w = bx * ay - by * ax;
  e.side_u = e.u;
  e.side_v = e.v;
  e.side_w = e.w;
  const V zero(0.0);
  if (bits((e.u == zero) | (e.v == zero) | (e.w == zero)) != 0) {
    decide_edge(cx, cy, bx, by, e.u, e.side_u);
    decide_edge(ax, ay, cx, cy, e.v, e.side_v);
    decide_edge(bx, by, ax, ay, e.w, e.side_w);
  }
  return e;
}

}  // namespace backlight
