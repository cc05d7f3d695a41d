// Spectra: what a lamp sends out and what a surface gives back, at any wavelength.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backlight/colour/rgb.h"
#include "backlight/colour/spectral_kernels.h"
#include "backlight/colour/upsampling.h"

namespace backlight {

/// Planck's law: spectral radiance, in W/(m^2 sr nm), of a blackbody of temperature `kelvin` > 0 at `nm` > 0
/// in vacuum. Constants of the SI of 2019. Zero where the value underflows.
double blackbody_radiance(double kelvin, double nm);

class Spectrum;

/// A spectrum, or the reason why there is none. Exactly one of the two is set.
struct SpectrumOrError;

/// A function of the wavelength in nm, in the frame of what carries it: a reflectance (0..1, no unit), or a
/// spectral radiance, intensity or irradiance, relative to D65's: `d65()` has film Y = 1 (see
/// `WavelengthSet`). Never negative, and finite for every wavelength > 0, since Doppler shifts ask for gamma
/// rays and radio waves. A value type: copies are cheap, and evaluation neither allocates nor locks.
///
/// A lamp's may have lines besides: light of single wavelengths, which is no function of the wavelength.
class Spectrum {
 public:
  /// Zero everywhere.
  Spectrum() = default;

  /// `value` >= 0 at every wavelength.
  static Spectrum constant(double value);

  /// The smooth reflectance that has the colour `rgb` under D65 (`fit_sigmoid`). Components are clamped to
  /// [0, 1]: a surface cannot give back more than it gets; whoever reads the number should warn. A grey is a
  /// constant. Outside 360..830 nm it keeps its end values; a level `uv` or `ir` in [0, 1] is reached
  /// linearly in wavelength from 360 down to 300 nm, or from 830 up to 890 nm, and kept beyond.
  static Spectrum reflectance(const LinearRgb& rgb, std::optional<double> uv = {},
                              std::optional<double> ir = {});

  /// The same with a shape at hand, from `upsample` say.
  static Spectrum sigmoid_reflectance(const SigmoidReflectance& shape, std::optional<double> uv = {},
                                      std::optional<double> ir = {});

  /// An emission whose film colour is `rgb`, of any brightness: D65 times a sigmoid. White is a multiple of
  /// D65. Negative components count as 0.
  static Spectrum illuminant(const LinearRgb& rgb);

  /// CIE illuminant D65, 1 at 560 nm: the table from 360 to 830 nm; outside, a blackbody of 6504 K, scaled on
  /// each side to continue the table.
  static Spectrum d65();

  /// A blackbody of temperature `kelvin` > 0, scaled to film Y = 1 at rest. Below 26 K that scale takes the
  /// infrared past the largest double; it is kept at the largest double there (but see evaluate_light).
  static Spectrum blackbody(double kelvin);

  /// A blackbody of temperature `kelvin`, scaled as the one of `reference_kelvin` would be: bodies that share
  /// a reference keep their true brightness relative to each other.
  static Spectrum blackbody(double kelvin, double reference_kelvin);

  /// A blackbody of temperature `kelvin` > 0 whose film Y at rest is its luminance in cd/m^2 (docs/physics.md
  /// equation (9a)). At D times the wavelengths, times D^5, that is the luminance at D times the temperature.
  static Spectrum absolute_blackbody(double kelvin);

  /// nm^-5 / (exp(c2 / (nm kelvin)) - 1), divided by e^log_divisor.
  static Spectrum planckian(double kelvin, double log_divisor);

  /// Straight lines between the points given; the end values are kept outside. Fails unless there are as many
  /// wavelengths (nm, > 0, ascending) as values (>= 0), at least one, all finite.
  static SpectrumOrError tabulated(std::vector<double> wavelengths, std::vector<double> values);

  /// The same with lines: line i is at lines.wavelengths[i] (nm, > 0, in any order) and has as much power as
  /// a value lines.values[i] (>= 0) over one nanometre. Either table may be empty, but not both.
  static SpectrumOrError tabulated(std::vector<double> wavelengths, std::vector<double> values,
                                   std::vector<double> line_wavelengths, std::vector<double> line_values);

  /// This spectrum times `factor` >= 0. A blackbody's strength is kept as a logarithm.
  [[nodiscard]] Spectrum scaled(double factor) const;

  /// The value at `nm` > 0; of lines nothing.
  [[nodiscard]] double at(double nm) const;

  /// out[i] = at(nm[i]) for i < n, to the same bits, whichever kernels do it.
  void evaluate(const double* nm, int n, double* out) const;
  void evaluate(const double* nm, int n, double* out, const SpectralKernels& kernels) const;

  /// The same of a light that is to be summed over these wavelengths. Where a blackbody passes what a double
  /// holds (e^600, so that the powers of D have room) all its values are lowered by one factor: its colour
  /// stays, and is the greatest there is.
  void evaluate_light(const double* nm, int n, double* out, const SpectralKernels& kernels) const;
  void evaluate_light(const double* nm, int n, double* out) const;

  [[nodiscard]] bool is_blackbody() const { return form_.kind == Kind::blackbody; }

  /// Zero at every wavelength.
  [[nodiscard]] bool is_black() const;

  /// The same at every wavelength: a reflectance that no shift changes.
  [[nodiscard]] bool is_grey() const;

  /// A multiple of `d65()`: under such light, at rest, a reflectance made from an RGB colour shows that
  /// colour.
  [[nodiscard]] bool is_d65_shaped() const;

  /// The shape of a reflectance made from RGB, or of an illuminant; empty for others.
  [[nodiscard]] std::optional<SigmoidReflectance> shape() const;

  /// The same, which must have a shape, with another.
  [[nodiscard]] Spectrum with_shape(const SigmoidReflectance& shape) const;

  /// It has points or lines of its own, so that no fixed wavelengths can stand for it:
  /// `integrate_film` (colour/film_integral.h) is to be asked.
  [[nodiscard]] bool has_features() const { return form_.kind == Kind::tabulated; }

  /// Where it is not smooth, in nm and ascending: the points of a table, the joints of D65.
  [[nodiscard]] std::span<const double> knots() const;

  /// Wavelengths, in nm.
  struct Span {
    double begin;
    double end;
  };
  /// Where it may differ from zero: all wavelengths, unless it is a table.
  [[nodiscard]] std::span<const Span> bright() const;

  /// The power of each line, and where it is, in nm.
  struct Line {
    double nm;
    double power;
  };
  [[nodiscard]] std::span<const Line> lines() const;
  /// What `Line::power` is to be multiplied with.
  [[nodiscard]] double scale() const { return form_.scale; }

  /// Its numbers.
  [[nodiscard]] const SpectrumForm& form() const { return form_; }

 private:
  using Kind = SpectrumForm::Kind;
  struct Table {
    std::vector<double> nm;  // may be empty: then there are lines
    std::vector<double> values;
    std::vector<Line> lines;
    std::vector<Span> bright;
  };
  static std::vector<Span> bright_parts(const std::vector<double>& nm, const std::vector<double>& values);

  void set_shape(const SigmoidReflectance& shape);

  SpectrumForm form_;
  std::shared_ptr<const Table> table_;  // of a tabulated one
};

struct SpectrumOrError {
  std::optional<Spectrum> spectrum;
  std::string error;
};

/// The film colour of an emission at rest, by the CIE's sum over 1 nm, which every `WavelengthSet`
/// approximates; of tables and lines the integral (docs/colour.md, equation (c2)).
LinearRgb film_colour(const Spectrum& emission);

/// The film colour of a white-lit reflectance: of `reflectance` times D65, in the same way.
LinearRgb colour_under_d65(const Spectrum& reflectance);

/// The film colour of `reflectance` times `light`, in the same way.
LinearRgb colour_under(const Spectrum& light, const Spectrum& reflectance);

}  // namespace backlight
