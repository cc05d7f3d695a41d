#include "passed_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "backlight/trace/sky.h"
#include "cones.h"
#include "sheet_scene.h"

namespace backlight {
namespace {

constexpr int deepest = 3;             // cells of an eighth of a pixel
constexpr double widest = 0.7;         // of a cell's image on the sky
constexpr double greatest_bend = 0.1;  // of it, by its size
// Film values below this, half a step of an 8-bit screen at black, do not show one by one: such images are
// put where straight lines through the cell say, without a ray of their own.
constexpr double dim = 0.5 / 255.0 / 12.92;

double largest(const LinearRgb& rgb) {
  return std::max({rgb.r, rgb.g, rgb.b});
}

// A square of the film, with where a route leads from its corners and its centre (the last).
struct Cell {
  double x, y, size;
  const Effects* effects;
  std::array<std::optional<Escape>, 5> ends = {};

  [[nodiscard]] ImagePoint point(std::size_t i) const {
    if (i == 4) return {x + 0.5 * size, y + 0.5 * size};
    return {x + (i % 2 == 0 ? 0.0 : size), y + (i < 2 ? 0.0 : size)};
  }
};

// How the ends of a cell lie on the sky.
struct Spread {
  int ends = 0;        // that there are
  Vec3 middle{0.0};    // the centre's, or another
  double reach = 0.0;  // how far the others are from it
  double bend = 0.0;   // how far it is from their mean

  explicit Spread(const Cell& cell) {
    Vec3 mean{0.0};
    for (std::size_t i = 5; i-- > 0;) {
      if (!cell.ends[i]) continue;
      const Vec3& direction = cell.ends[i]->direction;
      if (ends++ == 0) middle = direction;
      if (i < 4) mean += 0.25 * direction;
      reach = std::max(reach, glm::length(direction - middle));
    }
    bend = glm::length(mean - middle);
  }
  [[nodiscard]] bool is_whole() const { return ends == 5; }
  [[nodiscard]] bool is_even() const { return is_whole() && reach < widest && bend < greatest_bend * reach; }
};

}  // namespace

// The images of stars in one pixel.
class PixelSearch {
 public:
  PixelSearch(const PassedStars& sky, const PassedStars::Trace& trace)
      : sky_(sky), scene_(*sky.scene_), by_height_(sky.by_height_), trace_(trace) {}

  LinearRgb in_pixel(int x, int y) {
    const Cell pixel = cell(x, y, 1.0);
    area_ = pixel_solid_angle(scene_.camera.lens, pixel.point(4));
    std::vector<Cell> by_route;
    for (std::size_t i = 0; i < 5; ++i) {
      for (Escape& end : trace_(pixel.point(i), *pixel.effects, nullptr)) {
        const auto same = [&](const Cell& its) {
          return std::ranges::any_of(its.ends, [&](const auto& e) { return e && e->route == end.route; });
        };
        auto its = std::ranges::find_if(by_route, same);
        if (its == by_route.end()) its = by_route.insert(its, pixel);
        its->ends[i] = std::move(end);
      }
    }
    LinearRgb sum{0.0};
    for (const Cell& its : by_route) sum += in_cell(its, 0);
    return sum;
  }

 private:
  [[nodiscard]] Cell cell(double x, double y, double size) const {
    return {x, y, size, &effects_at(scene_, {x + 0.5 * size, y + 0.5 * size})};
  }

  std::optional<Escape> end_of(const ImagePoint& point, const Effects& effects, const Route& route) {
    std::vector<Escape> found = trace_(point, effects, &route);
    if (found.empty() || found[0].route != route) return std::nullopt;
    return std::move(found[0]);
  }

  LinearRgb in_cell(const Cell& cell, int depth) {
    LinearRgb sum{0.0};
    const Spread spread(cell);
    if (spread.ends == 0) return sum;
    // Where a way begins or ends within the cell, it may lead farther than the ends show.
    const double room = spread.is_whole() ? 1.5 : 4.0;
    if (spread.ends > 1 && near(spread.middle, room * spread.reach).empty()) return sum;
    if (!spread.is_even() && depth < deepest && !shows_none(cell, spread)) return in_parts(cell, depth);
    if (!cell.ends[4] || near(spread.middle, 1.25 * spread.reach).empty()) return sum;
    const auto centre =
        spread.is_even() ? place_by_corners(cell) : place(cell.point(4), cell, cell.ends[4]->route);
    if (!centre) return sum;
    for (const int star : found_) sum += light_of(star, cell, *centre);
    return sum;
  }

  LinearRgb in_parts(const Cell& whole, int depth) {
    LinearRgb sum{0.0};
    const auto known = std::ranges::find_if(whole.ends, [](const auto& end) { return end.has_value(); });
    const double half = 0.5 * whole.size;
    for (int i = 0; i < 4; ++i) {
      Cell part = cell(whole.x + (i % 2) * half, whole.y + (i / 2) * half, half);
      for (std::size_t k = 0; k < 5; ++k)
        part.ends[k] = end_of(part.point(k), *part.effects, (*known)->route);
      sum += in_cell(part, depth + 1);
    }
    return sum;
  }

  // The stars no farther from a direction than this, as the crow flies; into found_.
  const std::vector<int>& near(const Vec3& axis, double chord) {
    found_.clear();
    const SharedVector<Star>& stars = scene_.sky.stars;
    const auto height = [&](int star) { return stars[static_cast<std::size_t>(star)].direction.y; };
    auto star = std::ranges::lower_bound(by_height_, axis.y - chord, {}, height);
    for (; star != by_height_.end() && height(*star) <= axis.y + chord; ++star) {
      const Vec3 apart = stars[static_cast<std::size_t>(*star)].direction - axis;
      if (glm::dot(apart, apart) <= chord * chord) found_.push_back(*star);
    }
    return found_;
  }

  // Whether even the brightest of found_ is dim in a cell: its image fills about twice the square of its
  // reach.
  [[nodiscard]] bool shows_none(const Cell& cell, const Spread& spread) const {
    if (spread.ends == 1) return false;
    const auto star_at = [&](int star) -> const Star& {
      return scene_.sky.stars[static_cast<std::size_t>(star)];
    };
    const int star = *std::ranges::max_element(found_, {}, [&](int its) { return star_at(its).illuminance; });
    const auto way = std::ranges::find_if(cell.ends, [](const auto& end) { return end.has_value(); });
    const double area = 2.0 * spread.reach * spread.reach / (cell.size * cell.size);
    return largest((*way)->factor * sky_.about_colour(star_at(star), **way)) < dim * area;
  }

  // Where a way leads, and how that changes along the film. Differences are taken towards the cell's centre,
  // where the way goes on.
  struct Place {
    ImagePoint point;
    Escape way;
    Vec3 by_x, by_y;

    // Of the sky, per pixel; signed.
    [[nodiscard]] double area() const { return glm::dot(glm::cross(by_x, by_y), way.direction); }
  };
  std::optional<Place> place(const ImagePoint& p, const Cell& cell, const Route& route) {
    const double step = cell.size * 0x1p-9;
    const double x = p.x < cell.point(4).x ? step : -step;
    const double y = p.y < cell.point(4).y ? step : -step;
    std::array<Escape, 5> at;
    const std::array<ImagePoint, 5> points{
        p, {p.x + x, p.y}, {p.x + 2.0 * x, p.y}, {p.x, p.y + y}, {p.x, p.y + 2.0 * y}};
    for (std::size_t i = 0; i < 5; ++i) {
      auto end = end_of(points[i], *cell.effects, route);
      if (!end) return std::nullopt;
      at[i] = *std::move(end);
    }
    const auto slope = [&](std::size_t i, double by) {
      return (4.0 * (at[i].direction - at[0].direction) - (at[i + 1].direction - at[0].direction)) /
             (2.0 * by);
    };
    return Place{p, at[0], slope(1, x), slope(3, y)};
  }

  // The centre's, of a cell that is even.
  static Place place_by_corners(const Cell& cell) {
    const auto& e = cell.ends;
    const auto across = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      return (e[a]->direction - e[b]->direction + e[c]->direction - e[d]->direction) / (2.0 * cell.size);
    };
    return {cell.point(4), *e[4], across(1, 0, 3, 2), across(2, 0, 3, 1)};
  }

  // The next of Newton's steps from a place to where the way leads to the star.
  static std::optional<ImagePoint> step(const Place& from, const Star& star) {
    const Vec3& d = from.way.direction;
    const double along = glm::dot(star.direction, d);
    const double area = from.area();
    if (!(along > 0.3) || area == 0.0 || !std::isfinite(area)) return std::nullopt;
    const Vec3 off = star.direction / along - d;
    return ImagePoint{from.point.x + glm::dot(glm::cross(off, from.by_y), d) / area,
                      from.point.y + glm::dot(glm::cross(from.by_x, off), d) / area};
  }

  // The light of a star, if its image is in the cell; `centre`: the place there.
  LinearRgb light_of(int number, const Cell& cell, const Place& centre) {
    const Star& star = scene_.sky.stars[static_cast<std::size_t>(number)];
    std::optional<Place> here = centre;
    constexpr int most_steps = 24;
    for (int i = 0; i < most_steps; ++i) {
      const auto next = step(*here, star);
      if (!next) break;
      // A cell's width beyond it, the first step knows that it is not there.
      const double beyond = std::max(
          {cell.x - next->x, next->x - cell.x - cell.size, cell.y - next->y, next->y - cell.y - cell.size});
      if (i == 0 && beyond > cell.size) break;
      if (i == 0) {
        const LinearRgb about =
            centre.way.factor * sky_.about_colour(star, centre.way) / std::abs(centre.area());
        if (largest(about) < dim) return is_in(cell, *next) ? about : LinearRgb{0.0};
      }
      const ImagePoint within{std::clamp(next->x, cell.x, cell.x + cell.size),
                              std::clamp(next->y, cell.y, cell.y + cell.size)};
      const double moved = std::max(std::abs(within.x - here->point.x), std::abs(within.y - here->point.y));
      if (moved < 0x1p-30) {
        if (!is_in(cell, *next)) break;
        // Equation (33a); and the solid angle of a pixel there, which is not quite that of this one's middle.
        const double share = pixel_solid_angle(scene_.camera.lens, here->point) / area_;
        return share / std::abs(here->area()) * here->way.factor * sky_.colour(star, here->way);
      }
      here = place(within, cell, centre.way.route);
      if (!here) break;
    }
    return LinearRgb{0.0};
  }

  // In whole steps that are larger than the error of p, so that of two cells with a common side just one has
  // what is on it.
  static bool is_in(const Cell& cell, const ImagePoint& p) {
    const auto whole = [](double place) { return std::round(place * 0x1p20) * 0x1p-20; };
    const double x = whole(p.x) - cell.x, y = whole(p.y) - cell.y;
    return x >= 0.0 && x < cell.size && y >= 0.0 && y < cell.size;
  }

  const PassedStars& sky_;
  const Scene& scene_;
  const std::vector<int>& by_height_;
  const PassedStars::Trace& trace_;
  double area_ = 1.0;  // of the pixel, on the camera's sky
  std::vector<int> found_;
};

namespace {

constexpr double ratio = 1.02;  // of the temperatures of two bodies

// Around some surfaces of a set.
BoundingSphere around(const SurfaceSet& set, const std::vector<int>& surfaces) {
  Vec3 low{std::numeric_limits<double>::infinity()}, high = -low;
  for (const int i : surfaces) {
    const BoundingSphere ball = set.bounds(i);
    low = glm::min(low, ball.centre - ball.radius);
    high = glm::max(high, ball.centre + ball.radius);
  }
  return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

}  // namespace

PassedStars::PassedStars(const Scene& scene, const Hub& hub, const WavelengthSet& wavelengths,
                         bool everywhere)
    : scene_(&scene), wavelengths_(&wavelengths), everywhere_(everywhere) {
  const SharedVector<Star>& stars = scene.sky.stars;
  const auto [coldest, hottest] = std::ranges::minmax(stars, {}, &Star::temperature);
  coldest_ = coldest.temperature;
  for (double t = coldest_; bodies_.empty() || t < ratio * hottest.temperature; t *= ratio)
    bodies_.push_back(Spectrum::blackbody(t));
  by_height_.resize(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) by_height_[i] = static_cast<int>(i);
  std::ranges::stable_sort(by_height_, {},
                           [&](int star) { return stars[static_cast<std::size_t>(star)].direction.y; });
  // All around, the eyes turn with the head.
  const bool eyes_turn = scene.camera.stereo && scene.camera.lens.projection == Projection::equirectangular;
  everywhere_ = everywhere_ || eyes_turn;
  for (const int frame : hub.occupied) {
    const FrameView& view = hub.frames[static_cast<std::size_t>(frame)];
    std::vector<int> passing;
    for (std::size_t i = 0; i < view.scene->object_of_surface.size(); ++i) {
      const auto object = static_cast<std::size_t>(view.scene->object_of_surface[i]);
      if (passes_on(scene, scene.objects[object])) passing.push_back(static_cast<int>(i));
    }
    if (!passing.empty()) add_cones(view, passing);
  }
}

LinearRgb PassedStars::colour(const Star& star, const Escape& way) const {
  return colour_of(Spectrum::blackbody(star.temperature), star, way);
}

// To the ratio of temperatures: a body's own luminance at rest takes a sum over all wavelengths.
LinearRgb PassedStars::about_colour(const Star& star, const Escape& way) const {
  const double number = std::round(std::log(star.temperature / coldest_) / std::log(ratio));
  return colour_of(bodies_[std::min(static_cast<std::size_t>(number), bodies_.size() - 1)], star, way);
}

LinearRgb PassedStars::colour_of(const Spectrum& unit, const Star& star, const Escape& way) const {
  const Spectrum body = unit.scaled(scene_->sky.star_scale * star.illuminance);
  return star_colour(body, way.shift, way.filters, *wavelengths_);
}

void PassedStars::add_cones(const FrameView& view, const std::vector<int>& surfaces) {
  const BoundingSphere ball = around(*view.scene->surfaces, surfaces);
  const bool extended = view.from_camera.is_robust() || view.far != nullptr;
  const auto any_without_delay =
      std::ranges::any_of(scene_->regions, [](const EffectsRegion& r) { return !r.effects.light_delay; });
  const bool now = !scene_->effects.light_delay || any_without_delay;
  if (!std::isfinite(ball.radius) || (extended && (now || view.far == nullptr))) {
    everywhere_ = true;
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const int eye = scene_->camera.stereo ? (i == 0 ? -1 : 1) : 0;
    const Vec3 origin = eye_event(view, scene_->camera, eye).x;
    cones_[i].push_back(extended ? cone_of(*view.far, ball, eye_offset(scene_->camera, eye))
                                 : cone_of(view, origin, ball));
    if (now) cones_[i].push_back(cone_of_now(view, origin, ball));
  }
}

bool PassedStars::may_be_passed_on(int x, int y, int eye) const {
  const Lens& lens = scene_->camera.lens;
  const auto middle = direction_at(lens, {x + 0.5, y + 0.5});
  if (everywhere_ || !middle) return true;
  double reach = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto corner = direction_at(lens, {double(x + i % 2), double(y + i / 2)});
    if (corner) reach = std::max(reach, glm::length(*corner - *middle));
  }
  return std::ranges::any_of(cones_[eye > 0 ? 1 : 0], [&](const LaneCone& cone) {
    const Vec3 axis{cone.axis[0], cone.axis[1], cone.axis[2]};
    return glm::dot(*middle, axis) + 1.01 * reach * glm::length(axis) >= cone.level;
  });
}

LinearRgb PassedStars::in_pixel(int x, int y, int eye, const Trace& trace) const {
  if (!may_be_passed_on(x, y, eye)) return LinearRgb{0.0};
  return PixelSearch(*this, trace).in_pixel(x, y);
}

}  // namespace backlight
