// Loops over the wavelengths of a spectrum, and over points that lights reach, over lanes: several of them in
// one instruction.
#pragma once

#include <cstdint>

#include "backlight/base/instruction_sets.h"
#include "backlight/colour/rgb.h"

namespace backlight {

/// A spectrum as plain numbers, for the kernels' sake (base/lanes.h says why). colour/spectrum.h has what
/// each kind is; of the numbers, each kind reads its own.
struct SpectrumForm {
  enum class Kind { constant, sigmoid, d65, illuminant, blackbody, tabulated };
  Kind kind = Kind::constant;
  bool levelled = false;  ///< sigmoid: it has levels of its own outside the visible range
  double scale = 0.0;     ///< on all that follows; a constant's value
  /// Sigmoid and illuminant: as SigmoidReflectance. Blackbody: c0 the temperature in K, c1 the logarithm of
  /// what Planck's law is divided by: all of its strength, for which a double may be too small (scale is 1,
  /// or 0 for none).
  double c0 = 0.0, c1 = 0.0, c2 = 0.0;
  double middle = 0.5, half = 0.5;  ///< sigmoid and illuminant: as SigmoidReflectance
  /// Sigmoid: the level at 300 nm and below. D65 and illuminant: what joins the blackbody at 360 nm.
  double below = 0.0;
  double above = 0.0;  ///< the same at 890 nm and above, and at 830 nm
};

/// What SplineWeights has of its wavelengths, as plain numbers.
struct SplineForm {
  /// One of the observer's 471.
  struct Sample {
    /// What the values at both ends of its cell, and the curvatures there, have in the spline: times the
    /// film's red, green, blue and 0.
    double share[4][4]{};
  };
  struct Node {
    double pivot = 0.0, lower = 0.0, upper = 0.0;  ///< of the equations for the curvatures
    double bend = 0.0;                             ///< 6 / distance to the next
    int samples_end = 0;                           ///< of those between it and the next
  };
  int count;
  const double* nm;
  const Sample* samples;
  const Node* nodes;
  const double (*film_weights)[4];  ///< red, green, blue and 0 of each of the observer's samples
};

/// What LightRows has of a light at one shift or temperature, divided by e^log_scale.
struct LightRow {
  double log_scale = 0.0;
  double log_slope = 0.0;  ///< by the shift, or by the temperature
  LinearRgb film{0.0};     ///< colour of the whole light
  LinearRgb film_slope{0.0};
};

/// What ReflectedLight has between nodes of the Doppler factors to the camera and from a lamp: four either
/// way, or one; their colours, and what makes the shares of each.
struct LightCell {
  static constexpr int order = 4;
  struct Axis {
    int count = 0;
    double node[order], divisor[order];
  };
  Axis camera, lamp;
  double colour[order][order][3];  ///< by node of the lamp, node, channel
};

/// The kernels of one instruction set. All give the same bits.
struct SpectralKernels {
  const char* name;
  int width;
  /// out[i] = the spectrum's value at nm[i] for i < n. Of any kind but `tabulated`.
  void (*evaluate)(const SpectrumForm& spectrum, const double* nm, int n, double* out);
  /// share[i] = share[i]^exponent for i < n, of shares from 0 to 1 and exponent > 0 (base/lane_power.h).
  void (*raise)(double exponent, int n, double* share);
  /// colour[c] = Σ_i a[i] b[i] weights[c][i], i < n; b null: 1. Eight sums, of every eighth term, are added
  /// at the end, whatever the number of lanes.
  void (*film)(const double* const (&weights)[3], const double* a, const double* b, int n,
               double (&colour)[3]);
  /// The same with the weights Σ_k share[k] weights[k][c], k < 4.
  void (*film_between)(const double* const (&weights)[4][3], const double* share, const double* a,
                       const double* b, int n, double (&colour)[3]);
  /// Of a sigmoid at nm[i] in 360..830: sums[0][c] = Σ_i value weights[c][i], and its derivatives by what is
  /// added to the polynomial: t[i]^2 in sums[1], t[i] in sums[2], 1 in sums[3].
  void (*film_and_slopes)(const SpectrumForm& sigmoid, const double* nm, const double* t,
                          const double* const (&weights)[3], int n, double (&sums)[4][3]);
  /// SplineWeights::fill under the 471 samples of a light; `work`: room for eight numbers a node.
  void (*spline_weights)(const SplineForm& form, const double* light, double* work,
                         double* const (&weights)[3], float* left_out);
  /// LightRows::films of up to 64 points.
  std::uint64_t (*films)(const SpectrumForm& light, const LightRow* daylight, const LightRow* bodies,
                         const double* shift, std::uint64_t points, double* const (&film)[4]);
  /// factor times the colour between the nodes of a cell, at those of up to 64 points that are in it, one bit
  /// each.
  std::uint64_t (*between_nodes)(const LightCell& cell, const double* doppler, const double* lamp_doppler,
                                 const double* factor, std::uint64_t points, double* const (&colour)[3]);
};

/// The kernels, if this machine runs them; `baseline` always does.
const SpectralKernels& spectral_kernels(InstructionSet set);

}  // namespace backlight
