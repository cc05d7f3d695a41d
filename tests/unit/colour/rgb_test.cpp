#include "backlight/colour/rgb.h"

#include <gtest/gtest.h>

#include <cmath>

namespace backlight {
namespace {

// Sharma, Wu & Dalal 2005, table 1.
struct Pair {
  double l1, a1, b1, l2, a2, b2, difference;
};
constexpr Pair published_pairs[] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

TEST(DeltaE2000, PublishedPairs) {
  int number = 0;
  for (const Pair& p : published_pairs) {
    SCOPED_TRACE("pair " + std::to_string(++number));
    const Lab first{p.l1, p.a1, p.b1}, second{p.l2, p.a2, p.b2};
    EXPECT_NEAR(delta_e_2000(first, second), p.difference, 5.1e-5);
    EXPECT_NEAR(delta_e_2000(second, first), p.difference, 5.1e-5);
  }
}

TEST(DeltaE2000, ZeroForEqualColours) {
  EXPECT_EQ(delta_e_2000({40.0, 12.0, -3.0}, {40.0, 12.0, -3.0}), 0.0);
}

// CIE 15:2004, table T.3: x = 0.31272, y = 0.32903.
TEST(Rgb, WhiteIsTheCiesD65) {
  const Xyz white = white_xyz();
  const double sum = white.x + white.y + white.z;
  EXPECT_NEAR(white.x / sum, 0.31272, 1e-5);
  EXPECT_NEAR(white.y / sum, 0.32903, 1e-5);
  EXPECT_EQ(white.y, 1.0);
}

TEST(Rgb, WhiteHasEqualComponents) {
  const LinearRgb white = rgb_from_xyz(white_xyz());
  EXPECT_NEAR(white.x, 1.0, 1e-15);
  EXPECT_NEAR(white.y, 1.0, 1e-15);
  EXPECT_NEAR(white.z, 1.0, 1e-15);
}

// IEC 61966-2-1 gives the matrix to four digits, for the rounded white 0.3127, 0.3290: that moves it by up to
// 2e-4.
TEST(Rgb, MatrixAgreesWithThePublishedOne) {
  const double published[3][3] = {
      {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
  for (int c = 0; c < 3; ++c) {
    LinearRgb primary{0.0};
    primary[c] = 1.0;
    const Xyz xyz = xyz_from_rgb(primary);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(xyz[r], published[r][c], 2e-4) << r << ", " << c;
    EXPECT_EQ(luminance(primary), xyz.y);
  }
}

TEST(Rgb, PrimariesHaveTheirChromaticities) {
  const double x[3] = {0.64, 0.30, 0.15}, y[3] = {0.33, 0.60, 0.06};
  for (int c = 0; c < 3; ++c) {
    LinearRgb primary{0.0};
    primary[c] = 1.0;
    const Xyz xyz = xyz_from_rgb(primary);
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, x[c], 1e-15);
    EXPECT_NEAR(xyz.y / sum, y[c], 1e-15);
  }
}

TEST(Rgb, RoundTrip) {
  const LinearRgb colour{0.7, -0.2, 31.0};
  const LinearRgb back = rgb_from_xyz(xyz_from_rgb(colour));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], colour[c], 31.0 * 1e-15);
}

TEST(Lab, KnownColours) {
  const Lab white = lab_from_rgb(LinearRgb{1.0});
  EXPECT_NEAR(white.x, 100.0, 1e-12);
  EXPECT_NEAR(white.y, 0.0, 1e-12);
  EXPECT_NEAR(white.z, 0.0, 1e-12);
  // L* of the 18 % grey: 116 cbrt(0.18) - 16.
  EXPECT_NEAR(lab_from_rgb(LinearRgb{0.18}).x, 49.4961, 1e-4);
  // The linear part: L* = 903.2963 Y below Y = (6/29)^3.
  EXPECT_NEAR(lab_from_rgb(LinearRgb{0.001}).x, 0.9032963, 1e-7);
  // sRGB's red; published values are for the rounded white.
  const Lab red = lab_from_rgb({1.0, 0.0, 0.0});
  EXPECT_NEAR(red.x, 53.24, 0.01);
  EXPECT_NEAR(red.y, 80.09, 0.03);
  EXPECT_NEAR(red.z, 67.20, 0.03);
}

}  // namespace
}  // namespace backlight
