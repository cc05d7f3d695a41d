#include "implicit_stretches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "backlight/base/thread_memory.h"
#include "backlight/surface/matter_motion.h"
#include "implicit_points.h"
#include "moving_ball.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

/// A piece of a line is made so short that its form is no farther off than this part of the thinnest box; but
/// there are not more than so many.
constexpr double good_part = 0.25;
constexpr int most_pieces = 8;

/// Within bounds that are wider by the rounding of their corners, and the ball of what goes along a path.
void find_bounds(const Shape& shape, const LocalLines& lines, LineStretches& found) {
  constexpr double few_roundings = 4.0 * std::numeric_limits<double>::epsilon();
  const Vec3 low = implicit_low(shape), high = implicit_high(shape);
  double centre[3]{}, half[3]{infinite, infinite, infinite};
  for (int k = 0; k < 3 && std::isfinite(low[k]); ++k) {
    centre[k] = 0.5 * low[k] + 0.5 * high[k];
    half[k] = 0.5 * high[k] - 0.5 * low[k] + few_roundings * std::max(std::abs(low[k]), std::abs(high[k]));
  }
  surface_kernels().inside_box(centre, half, lines, found);
  if (!goes_away(shape)) return;
  Stretch stretches[LocalLines::most];
  inside_ball(*shape.motion, lines, stretches);
  for (std::size_t i = 0; i < lines.count; ++i) {
    found.in[i] = std::max(found.in[i], stretches[i].in);
    found.out[i] = std::min(found.out[i], stretches[i].out);
  }
}

struct Memory {
  LineBatch batch{CommonRows::most};
  std::vector<double> workspace;
  std::vector<LineStretches> met;
};

Memory& memory_of_thread() {
  static constinit thread_local ThreadMemory<Memory> memory;
  return memory.get();
}

/// Looks for boxes that move as one, within stretches of lines that are known: equation (28f).
class BoxSearch {
 public:
  BoxSearch(std::span<const Shape* const> shapes, const LocalLines& lines, std::span<LineStretches> found)
      : shapes_(shapes), lines_(lines), found_(found), m_(memory_of_thread()) {
    m_.met.resize(shapes.size());
    for (LineStretches& met : m_.met) {
      std::fill_n(met.in, lines.count, infinite);
      std::fill_n(met.out, lines.count, -infinite);
    }
  }

  void run() {
    for (std::size_t i = 0; i < lines_.count; ++i) begin(i);
    find_forms();
    divide();
    meet();
    for (const Piece& piece : pieces_) {
      add(piece.line, piece.from, piece.to);
      if (rows_.count == CommonRows::most) find_and_meet();
    }
    find_and_meet();
    for (std::size_t b = 0; b < shapes_.size(); ++b) {
      for (std::size_t i = 0; i < lines_.count; ++i) {
        if (!looked_at_[i]) continue;
        found_[b].in[i] = std::max(found_[b].in[i], m_.met[b].in[i]);
        found_[b].out[i] = std::min(found_[b].out[i], m_.met[b].out[i]);
      }
    }
  }

 private:
  struct Piece {
    std::size_t line;
    double from, to;
  };
  static constexpr std::size_t no_line = LocalLines::most;

  /// Of a line, all of where any of the bodies may be.
  void begin(std::size_t i) {
    double from = infinite, to = -infinite;
    for (const LineStretches& its : found_) {
      if (!(its.in[i] <= its.out[i])) continue;
      from = std::min(from, its.in[i]);
      to = std::max(to, its.out[i]);
    }
    looked_at_[i] = from < to && std::isfinite(from) && std::isfinite(to);
    if (looked_at_[i]) add(i, from, to);
  }

  void add(std::size_t line, double from, double to) {
    line_of_[rows_.count] = line;
    rows_.from[rows_.count] = from;
    rows_.to[rows_.count++] = to;
  }

  void find_forms() {
    for (std::size_t r = 0; r < rows_.count; ++r) {
      const FormulaLine line = formula_line(*shapes_.front(), lines_.line(line_of_[r]));
      m_.batch.put(r, line.origin, line.direction, rows_.from[r], rows_.to[r]);
    }
    const LineForms results[3]{{rows_.centre[0], rows_.slope[0], rows_.error[0]},
                               {rows_.centre[1], rows_.slope[1], rows_.error[1]},
                               {rows_.centre[2], rows_.slope[2], rows_.error[2]}};
    shapes_.front()->motion->box()->common->forms(m_.batch, rows_.count, m_.workspace, results);
  }

  /// How thin the thinnest box is.
  [[nodiscard]] double thinnest() const {
    double least = infinite;
    for (const Shape* shape : shapes_) {
      const BodyBox& box = *shape->motion->box();
      for (int k = 0; k < 3; ++k)
        least = std::min(least, box.half[k] / std::hypot(box.axis[k][0], box.axis[k][1], box.axis[k][2]));
    }
    return least;
  }

  /// Makes pieces of the rows whose forms are too far off. The error shrinks with the square of the length.
  void divide() {
    const double good = good_part * thinnest();
    for (std::size_t r = 0; r < rows_.count; ++r) {
      const double many =
          std::sqrt(std::max({rows_.error[0][r], rows_.error[1][r], rows_.error[2][r]}) / good);
      if (many <= 1.0) continue;
      const int pieces = many < most_pieces ? static_cast<int>(std::ceil(many)) : most_pieces;
      const double from = rows_.from[r], to = rows_.to[r], step = (to - from) / pieces;
      for (int k = 0; k < pieces; ++k)
        pieces_.push_back({line_of_[r], from + k * step, k + 1 == pieces ? to : from + (k + 1) * step});
      line_of_[r] = no_line;
    }
  }

  void find_and_meet() {
    find_forms();
    meet();
  }

  void meet() {
    LineStretches part;
    for (std::size_t b = 0; b < shapes_.size() && rows_.count > 0; ++b) {
      surface_kernels().meet_box(*shapes_[b]->motion->box(), rows_, part);
      LineStretches& met = m_.met[b];
      for (std::size_t r = 0; r < rows_.count; ++r) {
        const std::size_t i = line_of_[r];
        if (i == no_line) continue;
        met.in[i] = std::min(met.in[i], part.in[r]);
        met.out[i] = std::max(met.out[i], part.out[r]);
      }
    }
    rows_.count = 0;
  }

  std::span<const Shape* const> shapes_;
  const LocalLines& lines_;
  std::span<LineStretches> found_;
  Memory& m_;
  CommonRows rows_;
  std::size_t line_of_[CommonRows::most];
  bool looked_at_[LocalLines::most];
  std::vector<Piece> pieces_;
};

}  // namespace

bool goes_away(const Shape& shape) {
  return shape.motion && shape.motion->ball() && shape.motion->carriage() == nullptr;
}

Stretch inside_bounds(const Shape& shape, const LocalLine& line) {
  if (goes_away(shape)) return inside_ball(*shape.motion, line);
  const Vec3 low = implicit_low(shape), high = implicit_high(shape);
  const Vec3 centre = 0.5 * low + 0.5 * high, half = 0.5 * high - 0.5 * low;
  LaneStretch<Lanes<1>> stretch;
  for (int i = 0; i < 3; ++i) {
    stretch.narrow_to_slab(line.point[i] - centre[i], line.direction[i], half[i], 2 * i + implicit_caps);
  }
  return Stretch(stretch);
}

FormulaLine formula_line(const Shape& shape, const LocalLine& line) {
  const Vec3& p = line.point;
  const Vec3& d = line.direction;
  const double scale = shape.values[implicit_value::time_scale];
  return {{p.x, p.y, p.z, scale * line.clock.start}, {d.x, d.y, d.z, scale * line.clock.rate}};
}

void find_stretches(std::span<const Shape* const> shapes, const LocalLines& lines,
                    std::span<LineStretches> found) {
  for (std::size_t b = 0; b < shapes.size(); ++b) find_bounds(*shapes[b], lines, found[b]);
  const bool have_boxes = shapes.front()->motion && shapes.front()->motion->box() != nullptr;
  if (have_boxes) BoxSearch(shapes, lines, found).run();
}

}  // namespace backlight
