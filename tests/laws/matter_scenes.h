// What the tests of matter in motion share: text of scenes, and how far two pictures are apart.
#pragma once

#include <string>

#include "rendering.h"
#include "worst.h"

namespace backlight::test {

/// 17 digits, which name a double exactly.
std::string digits(double value);
std::string list(const Vec3& v);

/// "position = [...]": at `place` at time 0, moving with `velocity`, as formulas of t.
std::string path(const Vec3& place, const Vec3& velocity);

double lorentz_factor(const Vec3& velocity);

/// A velocity given by its size and the angles, in degrees, that turn the x axis into its direction: about y,
/// then about z, so that rotate = [any, about_y, about_z] takes a body's x axis there.
struct Oblique {
  double speed;
  double about_y = -35.0;
  double about_z = 25.0;

  [[nodiscard]] Vec3 velocity() const;
  [[nodiscard]] std::string rotate(double about_x) const;
};

/// The largest differences of two pictures of the same size, relative to the larger value or 1; of colours
/// relative to the pixel's brightness.
struct Match {
  int seen = 0;      ///< pixels that show a surface
  int other_id = 0;  ///< pixels that show another object
  Worst distance, doppler, emission_time, own_time, position, normal, colour;

  /// What an observer sees: all but the coordinates in which places and own times are told.
  [[nodiscard]] double worst_seen() const;
};

enum class Pixels {
  all,
  inside
};  ///< inside: all eight neighbours show the same object in the first picture

Match match(const Rendering& a, const Rendering& b, Pixels pixels = Pixels::inside);

/// That two pictures show the same matter, in the same coordinates, with the same colours.
void expect_same(const Match& m, const std::string& what, int least_seen = 700);

/// Whether every value of every channel has the same bits.
bool same_bits(const Rendering& a, const Rendering& b);

}  // namespace backlight::test
