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

  /// At `doppler` > 0 times the camera's wavelengths for the reflectance, and `lamp_doppler` > 0 times those
  /// for the light. `one_lamp_doppler`: many points have that of the lamp in common, so that it makes a node.
  [[nodiscard]] LinearRgb per_luminance(const Pair& pair, double doppler, double lamp_doppler,
                                        bool one_lamp_doppler, const SpectralKernels& kernels);

 private:
  static constexpr int order = 4;
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
  // Between nodes: their colours, and what makes the shares of each.
  struct Cell {
    Key key;
    int count = 0;
    int lamp_count = 0;
    double node[order], divisor[order];
    double lamp_node[order], lamp_divisor[order];
    double colour[order][order][4];  // by node of the lamp, node, channel
  };
  static Axis nodes_around(double doppler, bool is_node);
  static void prepare(const Axis& axis, double (&node)[order], double (&divisor)[order]);
  static void fill_shares(const double (&node)[order], const double (&divisor)[order], int count, double at,
                          double (&share)[order]);
  void fill(Cell& cell, const Pair& pair, const Axis& axis, const Axis& lamp, const SpectralKernels& kernels);

  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
  std::vector<double> wavelengths_, values_, work_;
};

}  // namespace backlight
