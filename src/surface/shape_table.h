// What each kind of shape can do: one row a kind.
//
// To add a shape: an enumerator in ShapeKind with the function that makes it (surface/shape.h), its closed
// form and kind in closed_forms.h, a file here with its methods, and its row in shape_table.cpp. Beside
// these, only the plane is asked for by its kind: it is infinite.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "backlight/surface/ray_sheet.h"
#include "backlight/surface/shape.h"
#include "local_lines.h"

namespace backlight {

class SolidWalk;
struct Stretch;
struct PlacedSurface;

/// A crossing at line.at(t).
struct Crossing {
  double t = 0.0;
  int part = 0;             ///< which face
  bool unresolved = false;  ///< could not be isolated to full precision
};

/// Ordered by t. A closed surface is crossed inwards and outwards in turn; a line that only touches counts as
/// crossing twice at the same t, or not at all, as rounding decides.
struct Crossings {
  int count = 0;
  Crossing list[4];
  bool inside_before = false;  ///< whether the line comes from inside the solid (t = -infinity)

  void add(double t, int part) { list[count++] = {t, part, false}; }
};

/// Which crossings are wanted. `first`: solvers may leave out those with λ <= lambda_min, and those behind
/// the first of the others; what they report is the same to the last bit however many lines are asked
/// together. `all`: the whole line; they may differ from the first ones by rounding.
enum class Wanted { first, all };

/// The first crossing of a line, at t; infinity: there is none.
struct FirstOnLine {
  double t = std::numeric_limits<double>::infinity();
  bool unresolved = false;
  int part = 0;
};

/// A point put onto the surface, in local coordinates. The gradient points outward and has any length.
struct LocalPoint {
  Vec3 position{0.0};
  Vec3 gradient{0.0, 1.0, 0.0};
  Vec3 shading{0.0};  ///< as the gradient, of the surface that light is reckoned by; zero: the same
  double u = 0.0;
  double v = 0.0;
  double error = 0.0;    ///< of the position, beyond rounding of the coordinates
  int member = 0;        ///< of a solid made of several: which of them
  bool is_unit = false;  ///< whether the gradient's length is 1, to within rounding
  // Of matter that is not at rest in the local coordinates: as of SurfacePoint.
  bool moves = false;
  Vec3 velocity{0.0};
  double own_time = 0.0;
};

/// Whether a point's u and v are to be computed; else they are 0.
enum class TextureCoordinates : bool { unwanted, wanted };

/// Half the extent along one rest axis of a circle of radius 1 about the local y axis, of a unit sphere, and
/// of the local unit vectors.
struct Extent {
  double circle;
  double sphere;
  double x, y, z;
};

/// One row of the table.
struct ShapeMethods {
  ShapeKind kind;
  const char* name;
  /// Whether the shape has an inside, so that CSG can take it.
  bool encloses;
  /// Whether no line that leaves its surface on the outside meets it again.
  bool is_convex = false;
  /// Whether none does that leaves it on the inside.
  bool is_flat = false;
  /// What is wrong with the shape, or an empty text.
  std::string (*problem)(const Shape&);
  /// Of the bounding sphere about the local origin, stretched by the factors >= 0 along the local axes;
  /// infinity: none.
  double (*bounding_radius)(const Shape&, const Vec3& factor);
  /// Half the extent along a rest axis; not asked of a shape without bounds.
  double (*half_extent)(const Shape&, const Extent&);
  Crossings (*crossings)(const Shape&, const LocalLine&, double lambda_min, Wanted);
  /// The point of a crossing that `crossings` reported for this line.
  LocalPoint (*point)(const Shape&, const LocalLine&, const Crossing&);
  /// Begins the walk over the crossings of a shape that may have more than four; it may leave out those
  /// before the line's parameter `from`, and all is known to be `within` a stretch. Null: `crossings` reports
  /// them all.
  void (*begin_walk)(const Shape&, const LocalLine&, double from, const Stretch& within,
                     SolidWalk&) = nullptr;
  /// The first crossings of many lines at once, each as `crossings` would report it; null: those of a
  /// closed form (closed_forms.h).
  void (*first_crossings)(const Shape&, const LocalLines&, double lambda_min,
                          std::span<FirstOnLine>) = nullptr;
  /// How crossings are found; null: in closed form.
  RootFinder (*finder)(const Shape&) = nullptr;
  /// The points of many crossings, each on its own line and as `point` would find it; null: likewise.
  void (*points)(const Shape&, const LocalLines&, std::span<const Crossing>, TextureCoordinates,
                 std::span<LocalPoint>) = nullptr;
  /// The points of hits `first` to `last` of a sheet, as `points` would find them, straight into the sheet
  /// from a kernel; null: by `points`.
  void (*sheet_points)(const PlacedSurface&, const RaySheet&, int first, int last, const SheetHits&,
                       TextureCoordinates, SheetPoints&) = nullptr;
  /// Whether each of many lines crosses the shape between the two λ, however many are asked together. Null:
  /// that is asked of the first crossings. A shape has it if it has first_crossings.
  void (*blocks)(const Shape&, const LocalLines&, double lambda_min, double lambda_max,
                 std::span<bool>) = nullptr;
  /// Fills u and v of a point of a face, where only its place is known.
  void (*texture)(const Shape&, int part, LocalPoint&) = nullptr;
  /// Whether there are more faces than a solid's own crossings can name: they are found again.
  bool has_many_parts = false;
  /// Whether the normal that light is reckoned by may be another than the surface's own; null: it never is.
  bool (*is_smooth)(const Shape&) = nullptr;
  /// Which face a place on the surface is on, to within rounding; null: there is but one.
  int (*part_at)(const Shape&, const Vec3&) = nullptr;
};

/// The row of a kind.
const ShapeMethods& methods(ShapeKind kind);
inline const ShapeMethods& methods(const Shape& shape) {
  return methods(shape.kind);
}

inline Crossings crossings(const Shape& shape, const LocalLine& line, double lambda_min, Wanted wanted) {
  return methods(shape).crossings(shape, line, lambda_min, wanted);
}

// The methods `crossings` (the first one) and `point` of shapes that have `first_crossings` and `points`.
Crossings crossings_of_one(const Shape& shape, const LocalLine& line, double lambda_min, Wanted);
LocalPoint point_of_one(const Shape& shape, const LocalLine& line, const Crossing& crossing);

extern const ShapeMethods sphere_methods, box_methods, cylinder_methods, cone_methods, torus_methods,
    disk_methods, plane_methods, quadric_methods, csg_methods, implicit_methods, mesh_methods,
    travelling_ball_methods;

// Words and numbers that several shapes share.

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// "NAME must be positive and finite", or an empty text.
std::string unless_positive(const char* name, double value);

/// The first of two texts that is not empty.
std::string first_of(std::string one, std::string other);

/// Longitude about y as a fraction of a turn: 1/2 at +z, growing towards +x.
double longitude(double x, double z);

/// Texture coordinates of a disc of `radius` that faces up (side = 1) or down (side = -1).
void texture_of_disc(double radius, double side, LocalPoint& point);

/// The texture coordinates of a point of a body's surface, where only its place is known: longitude and
/// latitude where it has none of its own.
void texture_of_body(const Shape& body, LocalPoint& point);

/// Whether the matter of a travelling ball has other velocities than its centre.
bool travelling_ball_turns(const Shape& shape);

/// u = x, v = z.
void texture_of_place(const Shape& shape, int part, LocalPoint& point);

}  // namespace backlight
