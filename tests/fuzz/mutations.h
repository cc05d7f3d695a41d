// Inputs made from good ones by the mistakes of people, editors and disks. The same seed makes the same
// inputs on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace backlight::fuzz {

/// Numbers by chance (splitmix64: Steele, Lea & Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  /// 0 ... count - 1; `count` is not 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(next() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  template <class Container>
  const auto& of(const Container& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::uint64_t state_;
};

/// A scene: numbers become extreme ones or formulas, lines are lost, doubled, swapped, taken from `other`,
/// values are nested, formulas and bytes are damaged.
std::string mutated_scene(std::string text, const std::string& other, Random& random);

/// A table of numbers: the same, with other separators, ends of lines and encodings.
std::string mutated_table(std::string text, const std::string& other, Random& random);

/// A picture: bytes flipped, mostly in the header, sizes made extreme, pieces lost or doubled, the end cut
/// off.
std::string mutated_picture(std::string bytes, const std::string& other, Random& random);

}  // namespace backlight::fuzz
