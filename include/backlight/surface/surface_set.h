// All surfaces at rest in one inertial frame, and the questions that rays ask of them.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/surface/lane_surface.h"
#include "backlight/surface/placement.h"
#include "backlight/surface/ray_clock.h"
#include "backlight/surface/shape.h"

namespace backlight {

class BoundingTree;
struct PlacedSurface;
struct RestRay;

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
  double u = 0.0;      ///< texture coordinates, as documented with each shape
  double v = 0.0;
  int member = 0;  ///< of a solid made of several: the member that was hit (surface/solid.h); else 0
  /// No farther than this is `position` from the true surface: 16 machine epsilons of the coordinates that
  /// went into it. A ray that leaves from position ± error_bound·normal, away from the surface, does not meet
  /// the surface at its own start.
  double error_bound = 0.0;
};

/// A sphere about something. radius < 0: about nothing; infinite: what it encloses has no bounds.
struct BoundingSphere {
  Vec3 centre{0.0};
  double radius = -1.0;
};

/// How a set looks for the nearest surface; the answers are the same bit for bit.
enum class SearchMethod { automatic, list, tree };

/// The surfaces at rest in one frame. A ray is x(λ) = origin + λ direction, all in this frame's coordinates.
/// `direction` has any length (the ray parameter λ is shared by all frames, docs/physics.md section 2), and
/// the origin may be 10⁹ object sizes away: each surface solves its own problem about the ray's closest
/// approach to its centre, found without rounding error (src/surface/local_line.h).
///
/// `clock` tells the frame's time along the ray, which shapes whose formula depends on t ask for.
///
/// Fill with add(), then build() once; the queries are const, allocate nothing and may run in any number of
/// threads.
class SurfaceSet {
 public:
  SurfaceSet();
  SurfaceSet(SurfaceSet&&) noexcept;
  SurfaceSet& operator=(SurfaceSet&&) noexcept;
  ~SurfaceSet();

  /// Takes a surface for which problem() is empty; returns its index: 0, 1, 2... One that casts no shadow is
  /// seen, and in nothing's way: blocked() passes it over.
  int add(const Shape& shape, const Placement& placement, bool casts_shadow = true);

  /// Lays the surfaces out for the search. To be called after the last add() and before any question.
  void build(SearchMethod method = SearchMethod::automatic);

  [[nodiscard]] std::size_t size() const;

  /// A surface's shape, as add() took it.
  [[nodiscard]] const Shape& shape(int surface) const;

  /// Whether a surface casts a shadow, as add() was told.
  [[nodiscard]] bool casts_shadow(int surface) const;

  /// The smallest λ in (0, lambda_limit) at which the ray meets a surface; of equal λ, the smallest index.
  [[nodiscard]] Hit nearest(const Vec3& origin, const Vec3& direction,
                            double lambda_limit = std::numeric_limits<double>::infinity(),
                            const RayClock& clock = {}) const;

  /// nearest() of the surfaces that have bounds.
  [[nodiscard]] Hit nearest_bounded(const Vec3& origin, const Vec3& direction, double lambda_limit,
                                    const RayClock& clock) const;

  /// Whether the ray meets any surface that casts a shadow, at a λ in the open interval (lambda_min,
  /// lambda_max), lambda_min >= 0.
  [[nodiscard]] bool blocked(const Vec3& origin, const Vec3& direction, double lambda_min, double lambda_max,
                             const RayClock& clock = {}) const;

  /// blocked() by the surfaces that have bounds.
  [[nodiscard]] bool blocked_bounded(const Vec3& origin, const Vec3& direction, double lambda_min,
                                     double lambda_max, const RayClock& clock) const;

  /// The point of a hit that nearest() found for this very ray. The position is not origin + λ direction,
  /// which from afar would carry the rounding of λ, but the crossing found again near the surface, and put
  /// onto it.
  [[nodiscard]] SurfacePoint resolve(const Hit& hit, const Vec3& origin, const Vec3& direction,
                                     const RayClock& clock = {}) const;

  /// nearest() of one surface alone: the first crossing at λ > 0, or nowhere.
  [[nodiscard]] Hit first_crossing_of(int surface, const Vec3& origin, const Vec3& direction,
                                      const RayClock& clock = {}) const;

  /// The same for many rays at once: array i of `origin` and of `direction` holds their coordinates i.
  struct Rays {
    std::size_t count;
    const double* origin[3];
    const double* direction[3];
    const double* time;
    const double* rate;
  };
  void first_crossings_of(int surface, const Rays& rays, std::span<Hit> hits) const;

  /// Whether one surface, which casts a shadow, is met by each of many rays at a λ in the open interval
  /// (0, lambda_max): blocked() of that surface.
  void blocked_by(int surface, const Rays& rays, double lambda_max, std::span<bool> blocked) const;

  /// resolve() of the hits of one surface, one for each ray: array i of `rays` as above. u and v are 0 if
  /// they are not wanted.
  void resolve_all(std::span<const Hit> hits, const Rays& rays, bool with_texture_coordinates,
                   std::span<SurfacePoint> points) const;

  /// How many surfaces have bounds and a closed form that the lanes do not have: each is asked one ray at a
  /// time, whatever else is asked together.
  [[nodiscard]] std::size_t asked_one_by_one() const;

  /// A surface as the lanes have it: of kind `other` where only one ray at a time can be asked.
  [[nodiscard]] LaneSurface lane_surface(int surface) const;

  [[nodiscard]] BoundingSphere bounds(int surface) const;
  [[nodiscard]] BoundingSphere bounds() const;             ///< of the whole set
  [[nodiscard]] BoundingSphere bounds_of_bounded() const;  ///< of those surfaces that have bounds

 private:
  template <bool any>
  Hit search(const RestRay& ray, double lambda_min, double lambda_max,
             const std::vector<int>& unbounded) const;
  template <bool any>
  bool search_range(const RestRay& ray, double lambda_min, std::size_t first, std::size_t last,
                    Hit& best) const;
  template <bool any>
  void search_tree(const RestRay& ray, double lambda_min, Hit& best) const;
  static bool is_blocked_by(const PlacedSurface& surface, const RestRay& ray, double lambda_min,
                            double lambda_max);
  [[nodiscard]] bool may_meet(const RestRay& ray, double lambda_min, double lambda_max,
                              std::size_t slot) const;

  std::vector<PlacedSurface> surfaces_;  // by index
  std::vector<int> infinite_;            // indices of those without bounds
  // The bounded ones, in search order: their bounding spheres as arrays, for a loop that needs nothing else.
  std::vector<int> index_;
  std::vector<double> centre_x_, centre_y_, centre_z_, radius_;
  std::unique_ptr<BoundingTree> tree_;  // over the search order; null: try them all
};

}  // namespace backlight
