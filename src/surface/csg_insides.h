// Who is inside what, as a line goes through a solid.
#pragma once

#include <vector>

#include "csg_solid.h"

namespace backlight {

class Insides {
 public:
  /// Outside of everything.
  void begin(const Solid& solid);

  [[nodiscard]] bool whole() const { return whole_; }
  [[nodiscard]] bool leaf(int leaf) const { return leaf_inside_[index(leaf)] != 0; }

  /// The line goes through the surface of a leaf.
  void toggle(int leaf);

  /// From now on (or no longer) it is not known whether the line is inside this leaf, which counts as
  /// outside.
  void set_unknown(int leaf, bool unknown) { unknown_[index(leaf)] = unknown ? 1 : 0; }

  /// A leaf out of `unknown` on which it depends whether the line is inside the whole, or may depend; -1:
  /// whatever they are, whole() is right.
  int decisive(const std::vector<int>& unknown);

 private:
  enum class Truth : unsigned char { no, yes, unknown };
  /// What is known of the parts of an operation.
  struct Tally {
    int yes = 0;  ///< of the parts that count together
    int unknown = 0;
    Truth first = Truth::no;  ///< of a difference
    Truth value = Truth::no;
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] bool value(int node) const;
  void set_part(int node, bool first, bool inside);
  void tally(int node, bool first, Truth part);
  [[nodiscard]] Truth value_of(int node) const;

  const Solid* solid_ = nullptr;
  std::vector<char> leaf_inside_;
  std::vector<char> unknown_;       // of each leaf
  std::vector<int> count_;          // of each operation: how many of the parts that count together are inside
  std::vector<char> first_inside_;  // of a difference: whether its first part is
  std::vector<Tally> tallies_;
  bool whole_ = false;
};

}  // namespace backlight
