#include <algorithm>
#include <cmath>
#include <optional>

#include "one_lane.h"

namespace backlight {
namespace {

std::string problem_of(const Shape& shape) {
  const auto& c = shape.values;
  if (!std::all_of(c.begin(), c.end(), [](double value) { return std::isfinite(value); })) {
    return "coefficients must be finite";
  }
  // The last one is a constant: it makes no surface.
  if (std::all_of(c.begin(), c.end() - 1, [](double value) { return value == 0.0; })) {
    return "at least one of the first nine coefficients must not be zero";
  }
  return {};
}

/// A quadric that is an ellipsoid, in local coordinates: how far its centre is from the origin along each
/// axis, and its matrix of second moments M, max (n·(x - centre))² = n·Mn; both with room for their rounding.
struct Ellipsoid {
  Vec3 offset{0.0};
  Mat3 moments{0.0};
  double outward = 1.0;  ///< what the room is for the rounding of sums of the two

  /// Of the coordinates' sizes: the axis-aligned box about the origin.
  [[nodiscard]] Vec3 reach() const {
    Vec3 r;
    for (int i = 0; i < 3; ++i) r[i] = outward * (offset[i] + std::sqrt(moments[i][i]));
    return r;
  }
};

/// A determinant that is a smaller part than this of the product of its diagonal is not surely positive.
constexpr double degenerate = 1e-9;

/// What rounding makes of any step below, relative to its largest term.
constexpr double few_roundings = 1e-14;

/// The matrix A of f = x·Ax + b·x + c9 if it is definite (by its determinant and leading minors, Sylvester),
/// with its sign made positive. `scale`: powers of two that bring its diagonal to between 1/4 and 4, so that
/// what is nearly zero does not depend on units.
struct DefiniteForm {
  Vec3 scale{1.0};
  double sign = 1.0;
  Mat3 adjugate{0.0};  ///< of the scaled matrix
  double determinant = 0.0;
  double condition = 1.0;  ///< product of the diagonal over the determinant

  bool take(const std::array<double, 10>& q) {
    sign = q[0] < 0.0 ? -1.0 : 1.0;
    if (!(sign * q[0] > 0.0 && sign * q[1] > 0.0 && sign * q[2] > 0.0)) return false;
    for (int i = 0; i < 3; ++i) scale[i] = std::ldexp(1.0, -std::ilogb(q[static_cast<std::size_t>(i)]) / 2);
    const auto element = [&](double coefficient, int i, int j) {
      return sign * ((coefficient * scale[i]) * scale[j]);
    };
    const double xy = 0.5 * element(q[3], 0, 1), xz = 0.5 * element(q[4], 0, 2);
    const double yz = 0.5 * element(q[5], 1, 2);
    const double a[3][3] = {
        {element(q[0], 0, 0), xy, xz}, {xy, element(q[1], 1, 1), yz}, {xz, yz, element(q[2], 2, 2)}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        adjugate[i][j] = difference_of_products(a[i1][j1], a[i2][j2], a[i1][j2], a[i2][j1]);
      }
    }
    determinant = a[0][0] * adjugate[0][0] + a[0][1] * adjugate[0][1] + a[0][2] * adjugate[0][2];
    const double product = a[0][0] * a[1][1] * a[2][2];
    condition = product / determinant;
    return determinant > degenerate * product && adjugate[2][2] > degenerate * (a[0][0] * a[1][1]);
  }
};

/// x·Ax + b·x is least about the centre -A⁻¹b/2, where f is c9 + b·centre/2 = -k; the surface is
/// (x - centre)·A(x - centre) = k, and M = k A⁻¹. Nothing where A is not surely definite: such a surface has
/// no bounds, or barely.
std::optional<Ellipsoid> ellipsoid(const std::array<double, 10>& q) {
  DefiniteForm form;
  if (!form.take(q)) return std::nullopt;
  Ellipsoid e;
  double k = -form.sign * q[9];
  double size = std::abs(q[9]);
  const double room = few_roundings * form.condition;
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0;
    double terms = 0.0;
    for (int j = 0; j < 3; ++j) {
      const double term =
          form.adjugate[i][j] * (form.sign * q[static_cast<std::size_t>(6 + j)] * form.scale[j]);
      sum += term;
      terms += std::abs(term);
    }
    const double unit = 0.5 * form.scale[i] / form.determinant;
    e.offset[i] = unit * (std::abs(sum) + room * terms);
    const double linear = 0.5 * form.sign * q[static_cast<std::size_t>(6 + i)];
    k += linear * unit * sum;
    size += std::abs(linear) * unit * terms;
  }
  // An empty surface is the point at the centre, or what rounding makes of it.
  const double level = std::max(0.0, k) + room * size;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      e.moments[i][j] = level * form.scale[i] * form.scale[j] * form.adjugate[i][j] / form.determinant;
    }
  }
  e.outward = 1.0 + 1e-12 + room;
  const Vec3 reach = e.reach();
  if (!std::isfinite(reach.x + reach.y + reach.z)) return std::nullopt;
  return e;
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const auto e = ellipsoid(shape.values);
  if (!e) return infinite;
  // The longest axis, squared, is the largest eigenvalue of the moments: no more than the largest sum of a
  // row, and the root of the sum of all squares.
  double row_sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (int j = 0; j < 3; ++j) {
      const double moment = std::abs(e->moments[i][j]) * factor[i] * factor[j];
      sum += moment;
      squares += moment * moment;
    }
    row_sum = std::max(row_sum, sum);
  }
  const double longest = std::sqrt(std::min(row_sum, std::sqrt(squares)));
  return e->outward * (glm::length(e->offset * factor) + longest);
}

double half_extent(const Shape& shape, const Extent& e) {
  const auto its = ellipsoid(shape.values);
  if (!its) return infinite;
  const Vec3 reach = its->reach();
  return reach.x * e.x + reach.y * e.y + reach.z * e.z;
}

}  // namespace

const ShapeMethods quadric_methods = form_methods<QuadricForm, texture_of_place>(
    ShapeKind::quadric, "quadric", problem_of, bounding_radius, half_extent);

Shape quadric(const std::array<double, 10>& coefficients) {
  return {ShapeKind::quadric, coefficients, {}, {}, {}};
}

}  // namespace backlight
