// What surfaces in motion reflect of lamps in motion, looked up between shifts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"

namespace backlight {

/// Film colours of smooth lights on smooth reflectances, relative to the luminance of all the light.
///
/// That quotient changes smoothly with the Doppler factor D from the surface to the camera and with that from
/// the lamp to the surface: it is the cubic, either way, through four nodes, of which each doubling has 128
/// (docs/colour.md). A node is worked out when it is first asked for, and depends on nothing but its own
/// numbers; which are remembered, and for how long, changes no bit of what is found.
///
/// Memory of one thread.
class ReflectedLight {
 public:
  /// A light that `LightRows` has, on a reflectance without features (null: 1).
  struct Pair {
    std::uint64_t number;  ///< no other pair's; not 2^64 - 1
    const Spectrum* light;
    const Spectrum* reflectance;
    const WavelengthSet* set;  ///< for the reflectance under that light
  };

  /// Whether the light of this place is smooth enough: all but blackbodies that arrive with less than 1000 K,
  /// or more than 4 million.
  [[nodiscard]] static bool has(const LightRows::Place& place);

  /// At points (up to 64, one bit each), `factor` times it. Arrays have room for whole registers of eight.
  void per_luminance(const Pair& pair, const double* doppler, const double* lamp_doppler,
                     bool one_lamp_doppler, const double* factor, std::uint64_t points,
                     double* const (&colour)[3], const SpectralKernels& kernels);

  /// At `doppler` > 0 times the camera's wavelengths for the reflectance, and `lamp_doppler` > 0 times those
  /// for the light. `one_lamp_doppler`: many points have that of the lamp in common, so that it makes a node.
  [[nodiscard]] LinearRgb per_luminance(const Pair& pair, double doppler, double lamp_doppler,
                                        bool one_lamp_doppler, const SpectralKernels& kernels);

 private:
  static constexpr int order = LightCell::order;
  // The nodes around a Doppler factor: four, or itself if it is one.
  struct Axis {
    std::uint64_t key;
    int count;
    double node[order];
  };
  struct Key {
    std::uint64_t pair = ~std::uint64_t{0};
    std::uint64_t doppler = 0;
    std::uint64_t lamp_doppler = 0;
    friend bool operator==(const Key&, const Key&) = default;
    [[nodiscard]] std::size_t place(std::size_t places) const;
  };
  struct Node {
    Key key;
    LinearRgb colour{0.0};
  };
  struct Cell {
    Key key;
    LightCell light;
  };
  static Axis nodes_around(double doppler, bool is_node);
  static LightCell::Axis prepared(const Axis& axis);
  void fill(LightCell& cell, const Pair& pair, const Axis& axis, const Axis& lamp,
            const SpectralKernels& kernels);

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
  std::vector<double> wavelengths_, values_, work_;
};

}  // namespace backlight
