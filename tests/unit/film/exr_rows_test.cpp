#include <gtest/gtest.h>
#include <half.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "backlight/film/exr.h"
#include "folder.h"

namespace backlight {
namespace {

using ExrRows = InFolder;

// Halves, the numbers half-way between two, and their neighbours.
TEST_F(ExrRows, HalvesAreRoundedToNearestTiesToEven) {
  std::vector<float> values;
  for (std::uint32_t bits = 0; bits < 0x7bffU; ++bits) {
    half low;
    half high;
    low.setBits(static_cast<std::uint16_t>(bits));
    high.setBits(static_cast<std::uint16_t>(bits + 1));
    const float middle = 0.5F * (float(low) + float(high));
    for (const float value : {float(low), std::nextafter(middle, 0.0F), middle, std::nextafter(middle, 1e9F)})
      values.insert(values.end(), {value, -value});
  }
  const int width = static_cast<int>(values.size());
  const ImageLayout layout{{0, 0, width, 1}, {0, 0, width, 1}, {{"R", ChannelPrecision::half}}, {}};
  ASSERT_TRUE(write_exr(folder / "a.exr", Image(layout, {values}), {}).ok());
  const ExrPicture read = read_exr(folder / "a.exr").value();
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(half(read.image.plane(0)[i]).bits(), half(values[i]).bits()) << values[i];
}

}  // namespace
}  // namespace backlight
