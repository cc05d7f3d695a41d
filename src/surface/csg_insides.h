// Who is inside what, as a line goes through a solid.
#pragma once

#include <vector>

#include "csg_solid.h"

namespace backlight {

/// Whether the line is inside something, where that may be unknown.
enum class Inside : std::uint8_t { no, yes, unknown };

class Insides {
 public:
  /// Outside of everything.
  void begin(const Solid& solid);

  [[nodiscard]] Inside whole() const { return whole_; }
  [[nodiscard]] Inside leaf(int leaf) const { return leaves_[index(leaf)]; }

  void set(int leaf, Inside inside);

  /// The line goes through the surface of a leaf of which it is known.
  void toggle(int leaf) { set(leaf, leaves_[index(leaf)] == Inside::yes ? Inside::no : Inside::yes); }

  /// A leaf out of some that are unknown on which it depends whether the line is inside the whole, or may
  /// depend; -1: there is none, and the whole is known.
  [[nodiscard]] int decisive(const std::vector<int>& unknown) const;

 private:
  /// What is known of the parts of an operation.
  struct Tally {
    int yes = 0;  ///< of the parts that count together
    int unknown = 0;
    Inside first = Inside::no;  ///< of a difference
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void count(int node, Inside part, int by);
  [[nodiscard]] Inside value(int node) const;

  const Solid* solid_ = nullptr;
  std::vector<Inside> leaves_;
  std::vector<Tally> tallies_;
  Inside whole_ = Inside::no;
};

}  // namespace backlight
