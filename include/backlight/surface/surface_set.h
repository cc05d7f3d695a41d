// All surfaces at rest in one inertial frame, and the questions that rays ask of them.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/surface/placement.h"
#include "backlight/surface/ray_clock.h"
#include "backlight/surface/ray_sheet.h"
#include "backlight/surface/shape.h"

namespace backlight {

struct AxisBox;
struct PlacedSurface;
struct WalkSurfaces;
struct WideNode;

/// Where a ray first meets the set. `surface` < 0: nowhere.
struct Hit {
  double lambda = std::numeric_limits<double>::infinity();  ///< ray parameter
  int surface = -1;                                         ///< as returned by SurfaceSet::add
  int part = 0;                                             ///< which face (documented with each shape)
  bool unresolved = false;  ///< the root could not be isolated to full precision (surface/implicit.h)
  /// Where the crossing is along the surface's own line (src/surface/local_line.h), more exactly than λ tells
  /// from afar; not a number where it is to be found again.
  double along = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool found() const { return surface >= 0; }
};

/// A point on a surface, in the coordinates of the set's rest frame.
struct SurfacePoint {
  Vec3 position{0.0};  ///< on the surface to within error_bound
  Vec3 normal{0.0};    ///< unit, geometric, outward; turn it towards the viewer if need be
  /// Unit, by which light is reckoned: the same, unless is_smooth() of the surface.
  Vec3 shading_normal{0.0};
  double u = 0.0;  ///< texture coordinates, as documented with each shape
  double v = 0.0;
  int member = 0;  ///< of a solid made of several: the member that was hit (surface/solid.h); else 0
  /// No farther than this is `position` from the true surface: 16 machine epsilons of the coordinates that
  /// went into it. A ray that leaves from position ± error_bound·normal, away from the surface, does not meet
  /// the surface at its own start.
  double error_bound = 0.0;
  /// Of matter that is not at rest in the frame: its velocity there, and its own time
  /// (surface/matter_motion.h).
  bool moves = false;
  Vec3 velocity{0.0};
  double own_time = 0.0;
};

/// A sphere about something. radius < 0: about nothing; infinite: what it encloses has no bounds.
struct BoundingSphere {
  Vec3 centre{0.0};
  double radius = -1.0;
};

/// Light from an event of the frame, and from others that are no farther from it in place and time together
/// than `apart`.
struct LightFlash {
  Vec3 place{0.0};
  double time = 0.0;
  double apart = 0.0;
  double until = std::numeric_limits<double>::infinity();  ///< where it is later counts no more
};

/// How the surfaces are looked through for a single ray; the answers are the same bit for bit.
enum class Search {
  tree,          ///< by the tree of boxes that sheets go down
  every_surface  ///< each is asked: the law, which knows of no bounds
};

/// Of which surfaces a question is.
enum class Among { all, bounded };

/// The surfaces at rest in one frame. A ray is x(λ) = origin + λ direction, all in this frame's coordinates.
/// `direction` has any length (the ray parameter λ is shared by all frames, docs/physics.md section 2), and
/// the origin may be 10⁹ object sizes away: each surface solves its own problem about the ray's closest
/// approach to its centre, found without rounding error (src/surface/lane_surface.h).
///
/// `clock` tells the frame's time along the ray, which shapes whose formula depends on t ask for.
///
/// Fill with add(), then build() once; the queries are const, and may run in any number of threads.
class SurfaceSet {
 public:
  SurfaceSet();
  SurfaceSet(SurfaceSet&&) noexcept;
  SurfaceSet& operator=(SurfaceSet&&) noexcept;
  ~SurfaceSet();

  /// Room for so many surfaces.
  void reserve(std::size_t count);

  /// Takes a surface for which problem() is empty; returns its index: 0, 1, 2... One that casts no shadow is
  /// seen, and in nothing's way: blocked() passes it over.
  int add(const Shape& shape, const Placement& placement, bool casts_shadow = true);

  /// Lays the surfaces out for the search. To be called after the last add() and before any question.
  void build();

  [[nodiscard]] std::size_t size() const;

  /// A surface's shape, as add() took it.
  [[nodiscard]] const Shape& shape(int surface) const;

  /// Whether a surface casts a shadow, as add() was told.
  [[nodiscard]] bool casts_shadow(int surface) const;

  /// Whether a ray that leaves the surface on its outside (SurfacePoint) never meets it again...
  [[nodiscard]] bool is_convex(int surface) const;
  /// ...and on its inside neither.
  [[nodiscard]] bool is_flat(int surface) const;

  /// Whether SurfacePoint::shading_normal may be another than the normal.
  [[nodiscard]] bool is_smooth(int surface) const;

  /// Whether matter of it may not be at rest in the frame: SurfacePoint::moves of its points.
  [[nodiscard]] bool moves(int surface) const;
  [[nodiscard]] bool any_moves() const;

  /// The radius of the ball about the centre of bounds() that is opaque all through; 0: there is none.
  [[nodiscard]] double opaque_radius(int surface) const;

  // One ray.

  /// The smallest λ in (0, lambda_limit) at which the ray meets a surface; of equal λ, the smallest index.
  [[nodiscard]] Hit nearest(const Vec3& origin, const Vec3& direction,
                            double lambda_limit = std::numeric_limits<double>::infinity(),
                            const RayClock& clock = {}, Search search = Search::tree,
                            Among among = Among::all) const;

  /// Whether the ray meets any surface that casts a shadow, at a λ in the open interval (0, lambda_max).
  [[nodiscard]] bool blocked(const Vec3& origin, const Vec3& direction, double lambda_max,
                             const RayClock& clock = {}, Search search = Search::tree,
                             Among among = Among::all) const;

  /// nearest() of one surface alone: the first crossing at λ > 0, or nowhere.
  [[nodiscard]] Hit first_crossing_of(int surface, const Vec3& origin, const Vec3& direction,
                                      const RayClock& clock = {}) const;

  /// The point of a hit that nearest() found for this very ray. The position is not origin + λ direction,
  /// which from afar would carry the rounding of λ, but the crossing found again near the surface, and put
  /// onto it.
  [[nodiscard]] SurfacePoint resolve(const Hit& hit, const Vec3& origin, const Vec3& direction,
                                     const RayClock& clock = {}) const;

  // Many rays at once, each with the same answer as by itself: those whose bits are set in `rays`.

  /// Updates the hits where a surface is met at a smaller λ > 0, or at the same and its number is smaller:
  /// surface i has number first_number + i. `passing`: what light of these rays meets of the one surface
  /// that there is, where that is known.
  void nearest(const RaySheet& sheet, std::uint64_t rays, double first_number, SheetHits& hits,
               const PassingBall& passing = {}) const;

  /// Which of the rays are blocked at a λ in (0, lambda_max). `own` by ray: the number of a surface that is
  /// known not to be in the way; numbers as above.
  [[nodiscard]] std::uint64_t blocked(const RaySheet& sheet, std::uint64_t rays, double lambda_max,
                                      double first_number = 0.0, const double (*own)[sheet_size] = nullptr,
                                      const PassingBall& passing = {}) const;

  /// The points of the hits of rays `first` to `last`, all on one surface. u and v are not set if they are
  /// not wanted.
  void points(const RaySheet& sheet, int surface, int first, int last, const SheetHits& hits,
              bool with_texture_coordinates, SheetPoints& points) const;

  [[nodiscard]] BoundingSphere bounds(int surface) const;
  [[nodiscard]] BoundingSphere bounds() const;  ///< of the whole set
  /// Of all places at which light can have left the set that arrives at this event.
  [[nodiscard]] BoundingSphere seen_from(const Vec3& place, double time) const;
  /// Of all places at which light of the flash can meet the set.
  [[nodiscard]] BoundingSphere lit_from(const LightFlash& flash) const;
  /// Of several sets, each with its flash, and what its light meets of a set that is one surface on a path.
  static constexpr std::size_t most_lit = 64;
  static void lit_from(std::span<const SurfaceSet* const> sets, std::span<const LightFlash> flashes,
                       std::span<BoundingSphere> spheres, std::span<PassingBall> balls);
  /// What light that arrives at this event meets of a set that is one surface on a path.
  [[nodiscard]] PassingBall passing_seen_from(const Vec3& place, double time) const;
  /// Whether these two say more than bounds(): anything in it goes along a path.
  [[nodiscard]] bool any_travels() const;
  /// Of those surfaces that have bounds.
  [[nodiscard]] const BoundingSphere& bounds_of_bounded() const { return bounds_of_bounded_; }

 private:
  [[nodiscard]] WalkSurfaces walk_surfaces(Among among, double first_number,
                                           const PassingBall& passing = {}) const;
  [[nodiscard]] const PlacedSurface& at(int surface) const;
  [[nodiscard]] BoundingSphere around(const std::vector<AxisBox>& boxes,
                                      const std::vector<int>& bounded) const;

  std::vector<PlacedSurface> surfaces_;
  std::vector<WideNode> nodes_;  ///< over those that have bounds, but for a lone one
  std::vector<int> direct_;      ///< the others: first `unbounded_` without bounds, then a lone one
  std::size_t unbounded_ = 0;
  BoundingSphere bounds_of_bounded_;
};

}  // namespace backlight
