#include "backlight/colour/reflected_light.h"

#include <algorithm>
#include <bit>

#include "light_kernels.h"
#include "room.h"

namespace backlight {
namespace {

// The first bits of a number's fraction, and its exponent, say which node is at or below it.
constexpr int bits_below_node = 45;

// Nodes: most of what a picture of fifty coloured things in motion asks for, so that few are worked out
// twice. Cells: as many as stay in a processor's second cache.
constexpr std::size_t node_places = 16384;
constexpr std::size_t cell_places = 128;

double node_at(std::uint64_t index) {
  return std::bit_cast<double>(index << bits_below_node);
}

}  // namespace

bool ReflectedLight::has(const LightRows::Place& place) {
  return place.family == LightRows::Family::daylight ||
         (place.family == LightRows::Family::bodies && place.at >= coldest_followed_kelvin);
}

std::size_t ReflectedLight::Key::place(std::size_t places) const {
  const std::uint64_t mixed =
      pair * 0x9e3779b97f4a7c15 ^ doppler * 0xc2b2ae3d27d4eb4f ^ lamp_doppler * 0xd6e8feb86659fd93;
  return static_cast<std::size_t>((mixed ^ mixed >> 29) * 0x9e3779b97f4a7c15 >> 40) % places;
}

ReflectedLight::Axis ReflectedLight::nodes_around(double doppler, bool is_node) {
  const auto bits = std::bit_cast<std::uint64_t>(doppler);
  const std::uint64_t index = bits >> bits_below_node;
  if (is_node || node_at(index) == doppler) return {bits, 1, {doppler}};
  Axis axis{index, order, {}};
  for (std::uint64_t i = 0; i < order; ++i) axis.node[i] = node_at(index - 1 + i);
  return axis;
}

// For Lagrange's polynomials.
LightCell::Axis ReflectedLight::prepared(const Axis& axis) {
  LightCell::Axis result{axis.count, {}, {}};
  for (int i = 0; i < axis.count; ++i) {
    double product = 1.0;
    for (int k = 0; k < axis.count; ++k) {
      if (k != i) product *= axis.node[i] - axis.node[k];
    }
    result.node[i] = axis.node[i];
    result.divisor[i] = 1.0 / product;
  }
  return result;
}

void ReflectedLight::fill(LightCell& cell, const Pair& pair, const Axis& axis, const Axis& lamp,
                          const SpectralKernels& kernels) {
  cell.camera = prepared(axis);
  cell.lamp = prepared(lamp);
  const auto size = static_cast<std::size_t>(pair.set->size());
  for (std::vector<double>* room : {&wavelengths_, &values_, &work_}) {
    if (room->size() < size) room->resize(size);
  }
  for (int i = 0; i < axis.count; ++i) {
    const double doppler = axis.node[i];
    bool sampled = false;
    for (int k = 0; k < lamp.count; ++k) {
      const double lamp_doppler = lamp.node[k];
      const Key key{pair.number, std::bit_cast<std::uint64_t>(doppler),
                    std::bit_cast<std::uint64_t>(lamp_doppler)};
      Node& node = nodes_[key.place(node_places)];
      if (node.key != key) {
        if (!sampled && pair.reflectance != nullptr) {
          for (std::size_t m = 0; m < size; ++m) wavelengths_[m] = doppler * pair.set->nm()[m];
          pair.reflectance->evaluate(wavelengths_.data(), pair.set->size(), values_.data(), kernels);
          sampled = true;
        }
        const WavelengthSet::Sampled values{values_.data(), pair.reflectance, doppler};
        node = {key, pair.set->film_per_luminance(*pair.light, doppler * lamp_doppler,
                                                  sampled ? &values : nullptr, work_.data(), kernels)};
      }
      for (int c = 0; c < 3; ++c) cell.colour[k][i][c] = node.colour[c];
    }
  }
}

void ReflectedLight::per_luminance(const Pair& pair, const double* doppler, const double* lamp_doppler,
                                   bool one_lamp_doppler, const double* factor, std::uint64_t points,
                                   double* const (&colour)[3], const SpectralKernels& kernels) {
  if (cells_.empty()) {
    nodes_.reserve(node_places);
    cells_.reserve(cell_places);
    take_room(std::span(nodes_.data(), node_places));
    take_room(std::span(cells_.data(), cell_places));
    nodes_.resize(node_places);
    cells_.resize(cell_places);
  }
  while (points != 0) {
    const int first = std::countr_zero(points);
    const Axis axis = nodes_around(doppler[first], false);
    const Axis lamp = nodes_around(lamp_doppler[first], one_lamp_doppler);
    const Key key{pair.number, axis.key, lamp.key};
    Cell& cell = cells_[key.place(cell_places)];
    if (cell.key != key) {
      fill(cell.light, pair, axis, lamp, kernels);
      cell.key = key;
    }
    points &= ~kernels.between_nodes(cell.light, doppler, lamp_doppler, factor, points, colour);
    points &= ~(std::uint64_t{1} << first);  // not a number is in no cell
  }
}

LinearRgb ReflectedLight::per_luminance(const Pair& pair, double doppler, double lamp_doppler,
                                        bool one_lamp_doppler, const SpectralKernels& kernels) {
  constexpr std::size_t room = 8;
  double dopplers[room], lamp_dopplers[room], factor[room], colour[3][room]{};
  std::ranges::fill(dopplers, doppler);
  std::ranges::fill(lamp_dopplers, lamp_doppler);
  std::ranges::fill(factor, 1.0);
  per_luminance(pair, dopplers, lamp_dopplers, one_lamp_doppler, factor, 1, {colour[0], colour[1], colour[2]},
                kernels);
  return {colour[0][0], colour[1][0], colour[2][0]};
}

}  // namespace backlight
