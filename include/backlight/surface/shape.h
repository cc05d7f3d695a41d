// What a surface looks like in its own local coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "backlight/base/vector.h"
#include "backlight/expression/expression.h"

namespace backlight {

class ImplicitFormula;
struct ImplicitBlend;
class MatterMotion;
class Mesh;
class Solid;

/// The kinds of surfaces. What each can do is in one table, src/surface/shape_table.h.
enum class ShapeKind : std::uint8_t {
  sphere,
  box,
  cylinder,
  cone,
  torus,
  disk,
  plane,
  quadric,
  csg,
  implicit,
  mesh,
  travelling_ball
};

/// When a surface is there: where the formula is positive, of its matter's own time in seconds.
struct Presence {
  Expression of_own_time;  ///< of variables of which only the first, t, is used
  double seconds_per_length = 1.0;

  [[nodiscard]] bool at(double own_time) const;
};

/// A surface in local coordinates (y up, centred on the local origin), as a plain value. Make one with the
/// functions below; they do not validate, problem() does.
struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  std::array<double, 10> values{};       ///< the arguments of the function that made it, in their order
  std::shared_ptr<const Solid> solid{};  ///< csg: what it is made of (surface/solid.h)
  std::shared_ptr<const ImplicitFormula> formula{};  ///< implicit (surface/implicit.h)
  std::shared_ptr<const ImplicitBlend> blend{};  ///< implicit: what was blended (surface/implicit_surface.h)
  std::shared_ptr<const MatterMotion> motion{};  ///< of its matter; null: at rest (surface/matter_motion.h)
  std::shared_ptr<const Presence> presence{};    ///< null: it is always there
  std::shared_ptr<const Mesh> mesh{};            ///< mesh (surface/mesh.h)
};

/// |x| = radius. Texture: u = 1/2 + atan2(x, z)/2pi, v = polar angle from +y over pi. So the +z axis pierces
/// u = 1/2, v = 0 is the north pole +y, and u grows eastwards: seen from outside, north up, a map of the
/// Earth whose middle is longitude 0 is not mirrored. Worked example: (0,0,r) has (u,v) = (0.5, 0.5);
/// (r,0,0), to the right for a viewer out on +z, has u = 0.75 (90 degrees east); (-r,0,0) has u = 0.25.
Shape sphere(double radius);

/// |x_i| <= size_i/2. Parts 0..5: the faces -x +x -y +y -z +z. Texture: each face 0..1, u to the right and v
/// down for a viewer outside it: with +y up for the four sides, -z up above the top, +z up below the bottom
/// (the faces fold out around +z without a mirror image).
Shape box(Vec3 size);

/// x²+z² = radius², |y| <= height/2, closed by two caps. Parts: 0 side, 1 cap at -y, 2 cap at +y. Texture of
/// the side: u as for the sphere, v = 0 at the top, 1 at the bottom; of the caps: the disc fills the middle
/// of the unit square, u = 1/2 + x/2R, v = 1/2 + z/2R (top) or 1/2 - z/2R (bottom).
Shape cylinder(double radius, double height);

/// As the cylinder, its radius going linearly from `radius` at y = -height/2 to `top_radius` at +height/2;
/// one of them may be 0 (then that end is the apex and has no cap).
Shape cone(double radius, double top_radius, double height);

/// (√(x²+z²) - major)² + y² = minor². 0 < minor < major: horn and spindle tori (minor >= major) are rejected
/// by problem(), as their inside is not well defined. Texture: u as for the sphere; v around the tube, 1/2 on
/// the outer equator, 1/4 on top, 0 on the inner equator, 3/4 below.
Shape torus(double major, double minor);

/// y = 0, x²+z² <= radius²; its normal is +y. Texture: as the top cap of a cylinder.
Shape disk(double radius);

/// y = 0, infinite; its normal is +y. Texture: u = x, v = z: the texture repeats once a unit.
Shape plane();

/// c0 x² + c1 y² + c2 z² + c3 xy + c4 xz + c5 yz + c6 x + c7 y + c8 z + c9 = 0, infinite; the outside (where
/// the normal points) is where the left side is positive. Texture: u = x, v = z as for the plane.
Shape quadric(const std::array<double, 10>& coefficients);

/// f = 0 inside the box from `low` to `high`; the outside (where the normal points) is where f > 0. The
/// surface is open where the box cuts it; as a part of a solid, the box closes it. Parts: 0 the surface, 1..6
/// such closing faces, as of a box. Texture: longitude and latitude about the y axis, as the sphere's.
Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high);

/// Triangles, open or closed, in coordinates relative to the mesh's centre. Parts: the triangles. Texture:
/// the mesh's own, interpolated; 0 if it has none. Encloses something where it is closed. `has_members`:
/// whether the points' members are the mesh's own, or all 0.
Shape mesh(std::shared_ptr<const Mesh> mesh, bool has_members = false);

/// A ball of this radius whose centre goes along the path of `motion`'s ball, which is_quick(). `turns`: its
/// matter has other velocities than the centre. Texture: of the motion's body points.
Shape travelling_ball(double radius, bool turns, std::shared_ptr<const MatterMotion> motion);

/// Whether light is reckoned by normals that are interpolated, and not the surface's own (SurfacePoint).
bool is_smooth(const Shape& shape);

/// Whether the surface fits into no sphere: a plane, and a quadric that is not surely an ellipsoid.
bool is_infinite(const Shape& shape);

/// Whether the shape has an inside: a mesh where it is closed; of the closed forms all but the disk: a plane
/// is the half-space y < 0, a quadric is solid where its left side is negative.
bool is_solid(const Shape& shape);

/// How the crossings of a line with a surface are found (docs/implicit.md).
enum class RootFinder : std::uint8_t {
  closed_form,  ///< to degree 2
  quartic,      ///< the torus's own solver
  interval,     ///< a formula: bounds on it and on its slope
  polynomial,   ///< a formula that is a polynomial: its coefficients along the ray, Bernstein's form
  affine,       ///< a formula: reduced affine forms, bounds on the slope where a root is
  triangles,    ///< of a mesh, by a watertight test
  taylor,       ///< a ball on a path: bounds by Taylor's sums of its path
  solid         ///< the events of the parts of a solid, each found in its own way, in their order
};

/// Which of them the shape's camera and shadow rays take.
RootFinder root_finder(const Shape& shape);

/// "closed form", "quartic", "interval + derivative", "polynomial", "reduced affine", "triangles", "Taylor",
/// "CSG".
std::string_view name(RootFinder finder);

/// The name of the shape's root finder; of a solid those of its parts too, each once: "CSG of closed form and
/// reduced affine".
std::string root_finding(const Shape& shape);

/// As in a scene file: "sphere"; "solid" for what is made of several.
std::string_view name(ShapeKind kind);

/// What is wrong with the shape ("radius must be positive and finite"), or an empty text.
std::string problem(const Shape& shape);

}  // namespace backlight
