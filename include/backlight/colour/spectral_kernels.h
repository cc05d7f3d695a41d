// Loops over the wavelengths of a spectrum, over lanes: several wavelengths in one instruction.
#pragma once

#include "backlight/base/instruction_sets.h"

namespace backlight {

/// A spectrum as plain numbers, for the kernels' sake (base/lanes.h says why). colour/spectrum.h has what
/// each kind is; of the numbers, each kind reads its own.
struct SpectrumForm {
  enum class Kind { constant, sigmoid, d65, illuminant, blackbody, tabulated };
  Kind kind = Kind::constant;
  double scale = 0.0;             ///< on all that follows; a constant's value
  double c0 = 0, c1 = 0, c2 = 0;  ///< sigmoid and illuminant: those of SigmoidReflectance
  bool levelled = false;          ///< sigmoid: it has levels of its own outside the visible range...
  double uv = 0.0;                ///< ...at 300 nm and below
  double ir = 0.0;                ///< ...and at 890 nm and above
  double kelvin = 0.0;            ///< blackbody
  double log_scale = 0.0;         ///< blackbody: logarithm of what Planck's law is divided by
  double short_factor = 0.0;      ///< D65 and illuminant: joins the blackbody to the table at 360 nm...
  double long_factor = 0.0;       ///< ...and at 830 nm
};

/// The kernels of one instruction set. All give the same bits.
struct SpectralKernels {
  const char* name;
  int width;
  /// out[i] = the spectrum's value at nm[i] for i < n. Of any kind but `tabulated`.
  void (*evaluate)(const SpectrumForm& spectrum, const double* nm, int n, double* out);
  /// colour[c] = Σ_i a[i] b[i] weights[c][i], i < n; b null: 1. Eight sums, of every eighth term, are added
  /// at the end, whatever the number of lanes.
  void (*film)(const double* const (&weights)[3], const double* a, const double* b, int n,
               double (&colour)[3]);
};

/// The kernels, if this machine runs them; `baseline` always does.
const SpectralKernels& spectral_kernels(InstructionSet set);

}  // namespace backlight
