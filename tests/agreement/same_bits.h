// That images of the same scene have the same bits.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>

#include "backlight/film/image.h"

namespace backlight::test {

/// Tables of a scene: a lamp at rest, and one that flies.
inline const std::string two_lamps = R"toml(
[[light]]
position = [3, 7, -4]
intensity = 160
[[light]]
position = [-5, 6, -2]
beta = [0.4, 0, 0.2]
intensity = 90
color = [1, 0.7, 0.3]
)toml";

/// In the data window of `part`, in every channel; the first values that differ are told.
inline void expect_same_bits(const Image& whole, const Image& part) {
  ASSERT_EQ(whole.channel_count(), part.channel_count());
  const PixelBox& window = part.layout().data;
  int off = 0;
  for (std::size_t channel = 0; channel < part.channel_count(); ++channel) {
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const float a = whole.at(channel, x, y), b = part.at(channel, x, y);
        if (std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b)) continue;
        if (++off < 4) {
          ADD_FAILURE() << whole.layout().channels[channel].name << " at " << x << ' ' << y << ": " << a
                        << " and " << b;
        }
      }
    }
  }
  EXPECT_EQ(off, 0);
}

}  // namespace backlight::test
