#include "backlight/colour/reflected_light.h"

#include <bit>

#include "backlight/base/lanes.h"
#include "room.h"

namespace backlight {
namespace {

// The first bits of a number's fraction, and its exponent, say which node is at or below it.
constexpr int bits_below_node = 45;

// As many as stay in a processor's second cache.
constexpr std::size_t node_places = 1024;
constexpr std::size_t cell_places = 128;

// Below, light falls so steeply towards the blue that it is not followed well from node to node.
constexpr double coldest_kelvin = 1000.0;

double node_at(std::uint64_t index) {
  return std::bit_cast<double>(index << bits_below_node);
}

}  // namespace

bool ReflectedLight::has(const LightRows::Place& place) {
  return place.family == LightRows::Family::daylight ||
         (place.family == LightRows::Family::bodies && place.at >= coldest_kelvin);
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
void ReflectedLight::prepare(const Axis& axis, double (&node)[order], double (&divisor)[order]) {
  for (int i = 0; i < axis.count; ++i) {
    double product = 1.0;
    for (int k = 0; k < axis.count; ++k) {
      if (k != i) product *= axis.node[i] - axis.node[k];
    }
    node[i] = axis.node[i];
    divisor[i] = 1.0 / product;
  }
}

void ReflectedLight::fill_shares(const double (&node)[order], const double (&divisor)[order], int count,
                                 double at, double (&share)[order]) {
  if (count == 1) {
    share[0] = 1.0;
    return;
  }
  const double a = at - node[0], b = at - node[1], c = at - node[2], d = at - node[3];
  share[0] = b * (c * d) * divisor[0];
  share[1] = a * (c * d) * divisor[1];
  share[2] = a * b * d * divisor[2];
  share[3] = a * b * c * divisor[3];
}

void ReflectedLight::fill(Cell& cell, const Pair& pair, const Axis& axis, const Axis& lamp,
                          const SpectralKernels& kernels) {
  cell.count = axis.count;
  cell.lamp_count = lamp.count;
  prepare(axis, cell.node, cell.divisor);
  prepare(lamp, cell.lamp_node, cell.lamp_divisor);
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
      cell.colour[k][i][3] = 0.0;
    }
  }
}

LinearRgb ReflectedLight::per_luminance(const Pair& pair, double doppler, double lamp_doppler,
                                        bool one_lamp_doppler, const SpectralKernels& kernels) {
  if (cells_.empty()) {
    nodes_.reserve(node_places);
    cells_.reserve(cell_places);
    take_room(std::span(nodes_.data(), node_places));
    take_room(std::span(cells_.data(), cell_places));
    nodes_.resize(node_places);
    cells_.resize(cell_places);
  }
  const Axis axis = nodes_around(doppler, false), lamp = nodes_around(lamp_doppler, one_lamp_doppler);
  const Key key{pair.number, axis.key, lamp.key};
  Cell& cell = cells_[key.place(cell_places)];
  if (cell.key != key) {
    fill(cell, pair, axis, lamp, kernels);
    cell.key = key;
  }
  double share[order], lamp_share[order];
  fill_shares(cell.node, cell.divisor, cell.count, doppler, share);
  fill_shares(cell.lamp_node, cell.lamp_divisor, cell.lamp_count, lamp_doppler, lamp_share);
  Lanes<2> red_green = 0.0, blue = 0.0;
  for (int k = 0; k < cell.lamp_count; ++k) {
    Lanes<2> along_red_green = 0.0, along_blue = 0.0;
    for (int i = 0; i < cell.count; ++i) {
      along_red_green = along_red_green + Lanes<2>(share[i]) * Lanes<2>::load(cell.colour[k][i]);
      along_blue = along_blue + Lanes<2>(share[i]) * Lanes<2>::load(cell.colour[k][i] + 2);
    }
    red_green = red_green + Lanes<2>(lamp_share[k]) * along_red_green;
    blue = blue + Lanes<2>(lamp_share[k]) * along_blue;
  }
  return {red_green.v[0], red_green.v[1], blue.v[0]};
}

}  // namespace backlight
