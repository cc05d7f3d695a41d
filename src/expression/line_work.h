// What the kernels for lines are given, and the functions that they call for what has no lanes of its own.
#pragma once

#include <cstddef>
#include <cstdint>

#include "backlight/expression/line_polynomials.h"
#include "backlight/expression/line_program.h"

namespace backlight {

/// Plain pointers, so that files for wider instruction sets need no library. A register is `stride` doubles
/// for each of its components (for bounds: -lower, upper, and the same of the slope; for numbers: value and
/// slope; for affine forms: centre, slope and error), one after the other.
struct LineWork {
  const LineProgram::Step* steps;
  std::size_t step_count;
  const double* constants;
  const double* origin[LineBatch::most_variables];
  const double* direction[LineBatch::most_variables];
  const double* from;
  const double* to;
  double* registers;
  std::uint32_t register_count;
  double* found[3];    ///< of zeros: first, last, sign
  std::size_t stride;  ///< a multiple of LineBatch::padding: the lines that are computed
};

/// One set of kernels.
struct LineKernels {
  void (*pieces)(const LineWork&);
  void (*points)(const LineWork&);
  void (*numbers)(const LineWork&);
  void (*zeros)(const LineWork&);
  void (*forms)(const LineWork&);
  void (*polynomials)(const LineWork&, LinePolynomials&);
};

LineKernels baseline_line_kernels();
// Null pointers where the compiler has no such instructions.
LineKernels avx2_line_kernels();
LineKernels avx512_line_kernels();

/// Lane by lane, the bounds of an operation that is not computed in lanes. Compiled for every machine. Notes
/// trouble where the result is not certain to be continuous.
void bounds_of_each(Operation operation, std::size_t lanes, const double* a_minus_lower,
                    const double* a_upper, const double* b_minus_lower, const double* b_upper,
                    double* minus_lower, double* upper);

/// The same for numbers.
void number_of_each(Operation operation, std::size_t lanes, const double* a, const double* b, double* value);

/// The same for affine forms: centres, slopes and errors of a, then of b; those of the result.
void affine_of_each(Operation operation, std::size_t lanes, const double* operands, double* results);

/// Makes RoundUp::failed() true: a result of the kernel is not to be used.
void note_trouble();

}  // namespace backlight
