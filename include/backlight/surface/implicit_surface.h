// Surfaces given by formulas: what may be chosen, and where they can be.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "backlight/surface/implicit.h"
#include "backlight/surface/shape.h"

namespace backlight {

/// What becomes of a root that cannot be isolated to full precision (one of even multiplicity, above all).
enum class UnresolvedRoots { take, skip };

/// The formulas that were blended into one, and the member that each stands for: where the blend is hit,
/// SurfacePoint::member is that of the formula that is least there.
struct ImplicitBlend {
  std::vector<ImplicitFormula> formulas;
  std::vector<int> members;
};

struct ImplicitOptions {
  UnresolvedRoots unresolved = UnresolvedRoots::take;
  /// Of the formula's t for one unit of the frame's time (c = 1).
  double seconds_per_length = 1.0;
  std::shared_ptr<const ImplicitBlend> blend{};
  /// Of the matter; if it has a ball, that bounds the surface, and not the box.
  std::shared_ptr<const MatterMotion> motion{};
  /// `interval`, `affine` or `polynomial` (where it is one; else by forms); nothing: choose_root_finder(),
  /// unless there is something wrong with the shape.
  std::optional<RootFinder> finder{};
};

/// Which search for the first roots of a formula within a box takes the least work: intervals with slopes,
/// reduced affine forms or, for a polynomial of low degree, its coefficients along each ray. All are tried on
/// 32 fixed lines, the steps are counted, and each is weighted by a fixed cost for every operation of the
/// formula: no time is measured, so that the choice is the same everywhere. Takes about as long as some
/// hundred rays.
RootFinder choose_root_finder(const ImplicitFormula& f, const Vec3& low, const Vec3& high);

/// As implicit(f, low, high) of surface/shape.h.
Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high, const ImplicitOptions& options);

/// What was chosen for a shape's unresolved roots; of another than a formula's: take.
UnresolvedRoots unresolved_of(const Shape& shape);

/// A box outside which f has one sign.
struct FormulaBounds {
  Vec3 low{0.0};
  Vec3 high{0.0};
  bool inside_beyond = false;  ///< whether that sign is negative: the solid goes on forever
};

/// Bounds that hold for every t; nothing when none can be proved.
///
/// Far out, f is looked at in projective coordinates: a point is s·(direction), the direction on a face of
/// the cube of half edge 1, and f is s^d times an expression g of the direction and of w = 1/s, which is
/// regular at infinity, w = 0. Where interval arithmetic over pieces of the faces shows g > 0 (or g < 0) for
/// all w in [0, W], there is no surface outside the cube of half edge 1/W. That settles every formula of + -
/// * /, powers, roots, abs, min and max whose leading terms vanish nowhere on the cube, and what sin, cos,
/// atan, tanh, floor and mod add to such a formula. It does not settle exp and log of what grows, nor a
/// surface that comes from infinity. The cube is then cut down to a box, side by side, by intervals over
/// slabs.
std::optional<FormulaBounds> prove_bounds(const ImplicitFormula& formula);

/// How many roots of formulas the calling thread has found since it began, for statistics: the difference of
/// two calls is the work between them.
std::uint64_t roots_solved_by_this_thread();

}  // namespace backlight
