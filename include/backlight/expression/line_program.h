// An expression along many straight lines at once: certain bounds of its values and slopes over a piece of
// each line, and its values and slopes at a point of each.
//
// Every line is computed by itself, with one IEEE operation for each step whatever the width of the machine's
// registers: the results do not depend on which lines are computed together, nor on the instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "backlight/expression/line_polynomials.h"
#include "backlight/expression/tape.h"

namespace backlight {

/// Lines as arrays, with room for `capacity` of them, and what was asked and found of each. Variable v on
/// line i is origin[v][i] + s direction[v][i].
class LineBatch {
 public:
  /// Numbers of lines are rounded up to a multiple of this; the spare ones repeat the last.
  static constexpr std::size_t padding = 8;
  static constexpr std::size_t most_variables = 4;

  explicit LineBatch(std::size_t capacity);

  [[nodiscard]] std::size_t capacity() const { return capacity_; }

  double* origin(std::size_t variable) { return at(variable); }
  double* direction(std::size_t variable) { return at(most_variables + variable); }
  /// The piece of the line, from <= to. At a point, only `from` counts.
  double* from() { return at(8); }
  double* to() { return at(9); }
  /// Line i with all of its variables, and a piece of it.
  void put(std::size_t i, const std::array<double, most_variables>& line_origin,
           const std::array<double, most_variables>& line_direction, double piece_from, double piece_to) {
    for (std::size_t v = 0; v < most_variables; ++v) {
      origin(v)[i] = line_origin[v];
      direction(v)[i] = line_direction[v];
    }
    from()[i] = piece_from;
    to()[i] = piece_to;
  }

  // Found by LineProgram. Bounds are certain: computed with outward rounding.
  double* lower() { return at(10); }
  double* upper() { return at(11); }
  /// Of the derivative with respect to s; the whole real line where it is unknown. Where the expression has a
  /// kink (abs, min, max) they hold the slopes on both sides.
  double* slope_lower() { return at(12); }
  double* slope_upper() { return at(13); }
  /// A Continuity (interval.h), as a number.
  double* continuity() { return at(14); }
  /// Of all values within the bounds: -1 or 1; 0: not certain, or not continuous.
  int certain_sign(std::size_t i) {
    if (continuity()[i] != 0.0) return 0;
    return lower()[i] > 0.0 ? 1 : upper()[i] < 0.0 ? -1 : 0;
  }
  /// Of enclose_zeros(): a ZeroRegion (affine.h); its sign as a number.
  double* first_zero() { return at(10); }
  double* last_zero() { return at(11); }
  double* sign() { return at(12); }
  /// Of numbers(): f and df/ds in double precision.
  double* value() { return at(10); }
  double* slope() { return at(12); }

 private:
  double* at(std::size_t array) { return numbers_.data() + array * capacity_; }

  std::size_t capacity_;
  std::vector<double> numbers_;
};

/// The widths that the kernels come in; `automatic` is the widest that this processor has. `avx2` must not be
/// asked for on a processor without it.
enum class LineWidth : std::uint8_t { automatic, baseline, avx2 };

/// Where the values and slopes of one result of a tape go, and the affine forms (affine.h) of one: a number
/// for each line.
struct LineNumbers {
  double* value;
  double* slope;
};
struct LineForms {
  double* centre;
  double* slope;
  double* error;
};

/// A tape made ready for lines. Immutable; safe to use from many threads, each with a workspace of its own.
class LineProgram {
 public:
  struct Step {
    Operation operation;
    bool slope_a;  ///< whether the operand changes along the line
    bool slope_b;
    std::uint32_t out, a, b;  ///< as in Instruction
    bool constant_a = false;  ///< whether the operand is a constant of the tape
    bool constant_b = false;
    // As polynomials along the line; what is of a higher degree than LinePolynomials, or none, has `none`.
    static constexpr std::uint8_t none = 255;
    std::uint8_t degree = none, degree_a = none, degree_b = none;
  };

  /// Of a tape with at most LineBatch::most_variables variables.
  explicit LineProgram(const Tape& tape, LineWidth width = LineWidth::automatic);

  /// How many doubles of work memory `count` lines take.
  [[nodiscard]] std::size_t workspace(std::size_t count) const;

  /// Bounds of the values and of the slopes over [from, to] of the first `count` lines.
  void enclose_pieces(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const;

  /// Where affine forms over [from, to] of the first `count` lines leave room for zeros.
  void enclose_zeros(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const;

  /// Bounds of the values at `from`.
  void enclose_points(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const;

  /// Values and slopes at `from`, in double precision: Expression::evaluate to a few ulp (of each operation).
  void numbers(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const;
  /// The same of each of the tape's results.
  void all_numbers(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
                   std::span<const LineNumbers> results) const;

  /// Affine forms over [from, to] of each of the tape's results; where there is none, the errors are
  /// infinite.
  void forms(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
             std::span<const LineForms> results) const;

  /// The expression as a polynomial on [from, to] of the first `count` lines, at most LinePolynomials::most.
  /// To be asked of polynomials only.
  void polynomials(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
                   LinePolynomials& found) const;

  /// The expression's degree, if it is made of + - * and whole powers, and the degree is not above
  /// LinePolynomials::most_degree; else nothing.
  [[nodiscard]] std::optional<int> degree() const;

  [[nodiscard]] const Tape& tape() const { return tape_; }
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] LineWidth width() const { return width_; }

 private:
  Tape tape_;
  LineWidth width_;
  std::vector<Step> steps_;
};

}  // namespace backlight
