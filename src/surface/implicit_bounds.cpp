#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "backlight/expression/enclosure.h"
#include "backlight/surface/implicit_surface.h"
#include "implicit_projective.h"
#include "shape_table.h"

namespace backlight {
namespace {

/// Boxes that one proof may look at.
constexpr int most_boxes = 60000;
/// The search for the cube begins this far out (as a power of two), and stops this far in.
constexpr int farthest = 40;
constexpr int nearest = -40;
/// Each side of the box is moved in by steps of 1/2, 1/4, ... of its width, and once more when all have been.
constexpr int halvings = 7;
constexpr int passes = 2;

constexpr Interval any_time{-infinite, infinite, Continuity::continuous};

/// -1 or 1 where a value is certain to have that sign, else 0.
int certain_sign(const Interval& value) {
  if (value.continuity >= Continuity::partial) return 0;
  return value.lower > 0.0 ? 1 : value.upper < 0.0 ? -1 : 0;
}

using Cell = std::array<Interval, 3>;

/// Whether `sign` (of a cell) is `wanted` all over the cell, which is halved along its longest edge where
/// that is not clear at once.
template <class Sign>
bool holds(const Cell& whole, int wanted, int budget, const Sign& sign) {
  std::vector<Cell> cells{whole};
  for (int looked = 0; !cells.empty(); ++looked) {
    if (looked >= budget) return false;
    const Cell cell = cells.back();
    cells.pop_back();
    const int found = sign(cell);
    if (found == wanted) continue;
    if (found != 0) return false;
    const auto longest = std::max_element(cell.begin(), cell.end(), [](const Interval& a, const Interval& b) {
      return a.upper - a.lower < b.upper - b.lower;
    });
    const double middle = 0.5 * longest->lower + 0.5 * longest->upper;
    if (!(longest->lower < middle && middle < longest->upper)) return false;
    Cell low = cell;
    Cell high = cell;
    const auto axis = static_cast<std::size_t>(longest - cell.begin());
    low[axis].upper = middle;
    high[axis].lower = middle;
    cells.push_back(low);
    cells.push_back(high);
  }
  return true;
}

Interval between(double lower, double upper) {
  return {lower, upper, Continuity::continuous};
}

class Proof {
 public:
  explicit Proof(const ImplicitFormula& formula) : formula_(formula) {}

  std::optional<FormulaBounds> find() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        auto face = seen_from_infinity(formula_.expression(), axis, side);
        if (!face) return std::nullopt;
        faces_.push_back(*std::move(face));
      }
    }
    sign_ = sign_on_face(faces_.front(), {between(0, 0), between(0, 0), between(0, 0)});
    if (sign_ == 0) return std::nullopt;
    int exponent = farthest;
    if (!clear_beyond(between(0.0, std::ldexp(1.0, -exponent)))) return std::nullopt;
    while (exponent > nearest &&
           clear_beyond(between(std::ldexp(1.0, -exponent), std::ldexp(1.0, 1 - exponent)))) {
      --exponent;
    }
    FormulaBounds bounds;
    bounds.inside_beyond = sign_ < 0;
    const Cell box = cut_down(std::ldexp(1.0, exponent));
    bounds.low = {box[0].lower, box[1].lower, box[2].lower};
    bounds.high = {box[0].upper, box[1].upper, box[2].upper};
    return bounds;
  }

 private:
  int sign_on_face(const ProjectiveFormula& face, const Cell& cell) const {
    std::vector<Interval> variables{cell[0], cell[1], cell[2], any_time};
    variables.resize(4 + face.unknowns, between(-1.0, 1.0));
    return certain_sign(enclose(face.g.tape(), variables));
  }

  [[nodiscard]] bool clear_beyond(const Interval& w) const {
    return std::all_of(faces_.begin(), faces_.end(), [&](const ProjectiveFormula& face) {
      return holds({between(-1.0, 1.0), between(-1.0, 1.0), w}, sign_, most_boxes,
                   [&](const Cell& cell) { return sign_on_face(face, cell); });
    });
  }

  [[nodiscard]] bool clear(const Cell& cell) const {
    return holds(cell, sign_, most_boxes / 8, [&](const Cell& piece) {
      const Vec3 low{piece[0].lower, piece[1].lower, piece[2].lower};
      const Vec3 high{piece[0].upper, piece[1].upper, piece[2].upper};
      return certain_sign(formula_.range(low, high, any_time));
    });
  }

  void move_in(Cell& box, std::size_t axis, bool upper) const {
    double step = 0.5 * (box[axis].upper - box[axis].lower);
    for (int i = 0; i < halvings; ++i, step *= 0.5) {
      Cell slab = box;
      double& end = upper ? box[axis].upper : box[axis].lower;
      const double inward = upper ? end - step : end + step;
      (upper ? slab[axis].lower : slab[axis].upper) = inward;
      if (clear(slab)) end = inward;
    }
  }

  /// The cube without the slabs at its six sides that are proved to be empty.
  [[nodiscard]] Cell cut_down(double half) const {
    Cell box{between(-half, half), between(-half, half), between(-half, half)};
    for (int pass = 0; pass < passes; ++pass) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) move_in(box, axis, upper);
      }
    }
    return box;
  }

  const ImplicitFormula& formula_;
  std::vector<ProjectiveFormula> faces_;
  int sign_ = 0;
};

}  // namespace

std::optional<FormulaBounds> prove_bounds(const ImplicitFormula& formula) {
  return Proof(formula).find();
}

}  // namespace backlight
