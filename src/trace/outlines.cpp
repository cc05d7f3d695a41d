#include "backlight/trace/outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "cones.h"
#include "sheet_scene.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double most_pixels = 2.0;  // across
constexpr int rim_points = 16;
constexpr double rim_room = 1.03;  // the rim between two of them

struct Box {
  double x0 = infinity, y0 = infinity, x1 = -infinity, y1 = -infinity;

  void add(const ImagePoint& point) {
    x0 = std::min(x0, point.x);
    y0 = std::min(y0, point.y);
    x1 = std::max(x1, point.x);
    y1 = std::max(y1, point.y);
  }
};

// Around the image of the directions at an angle of asin(sine) from the axis, as far as it is on the film;
// empty where it is not small, or not there.
std::optional<Box> image_of(const Lens& lens, const Vec3& axis, double sine) {
  const Vec3 aside = std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = glm::normalize(glm::cross(axis, aside));
  const Vec3 v = glm::cross(axis, u);
  const double tangent = rim_room * sine / std::sqrt(1.0 - sine * sine);
  Box box;
  for (int i = 0; i < rim_points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / rim_points;
    const Vec3 rim = axis + tangent * (std::cos(angle) * u + std::sin(angle) * v);
    if (const auto point = point_of(lens, glm::normalize(rim))) box.add(*point);
  }
  if (!(box.x1 - box.x0 <= most_pixels && box.y1 - box.y0 <= most_pixels)) return std::nullopt;
  return box;
}

class Outliner {
 public:
  Outliner(const Scene& scene, int eye) : scene_(scene), eye_(eye) {}

  void add(const FrameView& view, bool delayed) {
    if (view.from_camera.is_robust() && view.far == nullptr) return;
    const SurfaceSet& surfaces = *view.scene->surfaces;
    const Vec3 origin = eye_event(view, scene_.camera, eye_).x;
    for (int i = 0; i < static_cast<int>(surfaces.size()); ++i) {
      const BoundingSphere sphere = surfaces.bounds(i);
      if (!std::isfinite(sphere.radius) || !(sphere.radius > 0.0)) continue;
      add(cone(view, origin, sphere, delayed), sphere.radius, delayed);
    }
  }

  std::vector<SmallThing> sorted() && {
    std::ranges::stable_sort(
        found_, [](const SmallThing& a, const SmallThing& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    return std::move(found_);
  }

 private:
  [[nodiscard]] LaneCone cone(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere,
                              bool delayed) const {
    if (!delayed) return cone_of_now(view, origin, sphere);
    if (view.far) return cone_of(*view.far, sphere, eye_offset(scene_.camera, eye_));
    return cone_of(view, origin, sphere);
  }

  // |m|² - h² = r²: the sine of the half-angle is r/|m|.
  void add(const LaneCone& cone, double radius, bool delayed) {
    const Vec3 m{cone.axis[0], cone.axis[1], cone.axis[2]};
    const double length = glm::length(m);
    if (!(cone.level > 0.0) || !(radius < 0.1 * length)) return;
    const Lens& lens = scene_.camera.lens;
    const double sine = radius / length;
    const auto box = image_of(lens, m / length, sine);
    if (!box) return;
    // Of what reaches over the edge of the film, the box is of what is on it.
    const ImagePoint centre{0.5 * (box->x0 + box->x1), 0.5 * (box->y0 + box->y1)};
    const double pixel = std::sqrt(pixel_solid_angle(lens, centre));
    if (sine > most_pixels * pixel || effects_at(scene_, centre).light_delay != delayed) return;
    add(*box, centre);
  }

  // Its parts in up to nine pixels.
  void add(const Box& box, const ImagePoint& centre) {
    // Nowhere on the film: perhaps so far off that no whole number says where.
    if (!(box.x0 < scene_.film.width && box.y0 < scene_.film.height)) return;
    for (int y = static_cast<int>(box.y0); y < std::min(box.y1, double(scene_.film.height)); ++y) {
      for (int x = static_cast<int>(box.x0); x < std::min(box.x1, double(scene_.film.width)); ++x) {
        found_.push_back({x, y, std::max(0.0, box.x0 - x), std::max(0.0, box.y0 - y),
                          std::min(1.0, box.x1 - x), std::min(1.0, box.y1 - y), centre});
      }
    }
  }

  const Scene& scene_;
  int eye_;
  std::vector<SmallThing> found_;
};

}  // namespace

std::vector<SmallThing> small_things(const Scene& scene, const Hub& hub, int eye) {
  bool with_delay = scene.effects.light_delay, without = !with_delay;
  for (const EffectsRegion& region : scene.regions) {
    (region.effects.light_delay ? with_delay : without) = true;
  }
  Outliner outliner(scene, eye);
  for (const int frame : hub.occupied) {
    const FrameView& view = hub.frames[static_cast<std::size_t>(frame)];
    if (with_delay) outliner.add(view, true);
    if (without) outliner.add(view, false);
  }
  return std::move(outliner).sorted();
}

}  // namespace backlight
