// From roots of formulas to points, gradients and bounds of errors, over lanes.
#include "implicit_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "backlight/base/thread_memory.h"
#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/matter_motion.h"

namespace backlight {
namespace {

constexpr std::size_t window = 64;

/// Which of the formulas of a blend is the least.
int member_at(const Shape& shape, const Vec3& p, double time) {
  int member = 0;
  double least = infinite;
  for (std::size_t i = 0; shape.blend && i < shape.blend->formulas.size(); ++i) {
    const double value = shape.blend->formulas[i].value(p, time);
    if (!(value < least)) continue;
    least = value;
    member = shape.blend->members[i];
  }
  return member;
}

bool has_direction(const Vec3& gradient) {
  const double square = glm::dot(gradient, gradient);
  return square > 0.0 && square < infinite;
}

/// The line with the formula's time.
LocalLine timed(const Shape& shape, LocalLine line) {
  line.clock.start *= shape.values[implicit_value::time_scale];
  line.clock.rate *= shape.values[implicit_value::time_scale];
  return line;
}

double time_at(const LocalLine& line, double t) {
  return line.clock.start + t * line.clock.rate;
}

/// How far f's rounding hides its zero about an unresolved root, backwards along the line.
double hidden_length(const ImplicitFormula& f, const LocalLine& line, double t, double size) {
  double length = 4.0 * std::numeric_limits<double>::epsilon() * size;
  while (length < size && f.sign(line.at(t - length), time_at(line, t - length)) == 0) length *= 2.0;
  return length;
}

void put_on_face(const Shape& shape, int face, LocalPoint& point) {
  const Vec3 end = face % 2 == 0 ? implicit_low(shape) : implicit_high(shape);
  point.gradient = Vec3{0.0};
  point.gradient[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
  point.position[face / 2] = end[face / 2];
}

void find_beside(const ImplicitFormula& f, const LocalLine& line, double t, double size, LocalPoint& point) {
  point.error = hidden_length(f, line, t, size);
  const double before = t - point.error;
  const Vec3 gradient = f.gradient(line.at(before), time_at(line, before));
  if (has_direction(gradient)) point.gradient = gradient;
}

/// Points at which f is to be put to 0, up to a window of them.
class Batch {
 public:
  explicit Batch(const ImplicitFormula& f) : f_(f) {}

  /// `size`: of the coordinates that are met with.
  void add(LocalPoint& point, double time, double size) {
    points_[count_] = &point;
    sizes_[count_] = size;
    times_[count_++] = time;
    if (count_ == window) finish();
  }

  /// One of Newton's steps along the gradient, and what is left of f by intervals.
  void finish() {
    if (count_ == 0) return;
    find_gradients();
    for (std::size_t k = 0; k < count_; ++k) {
      const double square = glm::dot(gradient_[k], gradient_[k]);
      if (!has_direction(gradient_[k])) continue;
      points_[k]->gradient = gradient_[k];
      const Vec3 step = gradient_[k] * (value_[k] / square);
      if (glm::length(step) < 1e-12 * sizes_[k]) points_[k]->position = points_[k]->position - step;
    }
    place();
    f_.program().enclose_points(lines(), count_, workspace());
    for (std::size_t k = 0; k < count_; ++k) {
      if (!has_direction(gradient_[k])) continue;
      const double left = std::max(-lines().lower()[k], lines().upper()[k]);
      points_[k]->error = std::min(2.0 * left / glm::length(gradient_[k]), 1e-3 * sizes_[k]);
    }
    count_ = 0;
  }

 private:
  static LineBatch& lines() {
    static constinit thread_local ThreadMemory<LineBatch> batch;
    return batch.get(window);
  }
  static std::vector<double>& workspace() {
    static constinit thread_local ThreadMemory<std::vector<double>> memory;
    return memory.get();
  }

  /// A line through each point, without a direction as yet.
  void place() {
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3& p = points_[k]->position;
      lines().put(k, {p.x, p.y, p.z, times_[k]}, {}, 0.0, 0.0);
    }
  }

  void find_gradients() {
    place();
    for (int axis = 0; axis < 3; ++axis) {
      double* const direction = lines().direction(static_cast<std::size_t>(axis));
      std::fill_n(direction, count_, 1.0);
      f_.program().numbers(lines(), count_, workspace());
      std::fill_n(direction, count_, 0.0);
      for (std::size_t k = 0; k < count_; ++k) {
        gradient_[k][axis] = lines().slope()[k];
        value_[k] = lines().value()[k];
      }
    }
    // Where an operation has no slope along what does not change, lanes have none at all.
    for (std::size_t k = 0; k < count_; ++k) {
      if (!has_direction(gradient_[k])) gradient_[k] = f_.gradient(points_[k]->position, times_[k]);
    }
  }

  const ImplicitFormula& f_;
  std::size_t count_ = 0;
  LocalPoint* points_[window];
  double times_[window];
  double sizes_[window];
  double value_[window];
  Vec3 gradient_[window];
};

/// Of the coordinates about a point of the surface: what goes away has no bounds that say it.
double size_at(const Shape& shape, const Vec3& p) {
  const bool goes_away = shape.motion && shape.motion->ball() && shape.motion->carriage() == nullptr;
  if (goes_away) return 2.0 * shape.motion->ball()->radius + glm::length(p);
  return glm::length(implicit_high(shape) - implicit_low(shape));
}

}  // namespace

void implicit_points(const Shape& shape, const LocalLines& lines, std::span<const Crossing> crossings,
                     TextureCoordinates wanted, std::span<LocalPoint> points) {
  Batch batch(*shape.formula);
  for (std::size_t i = 0; i < lines.count; ++i) {
    const LocalLine line = timed(shape, lines.line(i));
    const Crossing& crossing = crossings[i];
    LocalPoint& point = points[i];
    point = LocalPoint{};
    point.position = line.at(crossing.t);
    point.gradient = -line.direction;
    if (wanted == TextureCoordinates::wanted) texture_of_body(shape, point);
    const double time = time_at(line, crossing.t);
    const double size = size_at(shape, point.position);
    if (shape.blend) point.member = member_at(shape, point.position, time);
    if (crossing.part >= implicit_caps) {
      put_on_face(shape, crossing.part - implicit_caps, point);
    } else if (crossing.unresolved) {
      find_beside(*shape.formula, line, crossing.t, size, point);
    } else {
      batch.add(point, time, size);
    }
  }
  batch.finish();
}

}  // namespace backlight
