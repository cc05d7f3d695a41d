#include "backlight/film/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace backlight {
namespace {

double luminance(const Vec3& rgb) {
  return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

// Signals of the 8-bit codes and their linear light by ((s + 0.055) / 1.055)^2.4, in 30 digits by mpmath.
// EXPECT_DOUBLE_EQ allows 4 ulps: the power carries the rounding of its base 2.4-fold.
TEST(Srgb, FollowsTheStandard) {
  EXPECT_DOUBLE_EQ(srgb_to_linear(128.0 / 255.0), 0.215860500113899163761817647393);
  EXPECT_DOUBLE_EQ(srgb_to_linear(10.0 / 255.0), 0.00303526983548837491653007952407);
  EXPECT_DOUBLE_EQ(linear_to_srgb(0.18), 0.461356129500441649862826868134);
  EXPECT_EQ(linear_to_srgb(0.0), 0.0);
  EXPECT_NEAR(linear_to_srgb(1.0), 1.0, 1e-15);
  EXPECT_EQ(linear_to_srgb(-0.18), -linear_to_srgb(0.18));
  for (int code = 0; code < 256; ++code) {
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(code / 255.0)), code / 255.0, 1e-7);
  }
}

TEST(DisplayTransform, ShowsTheFilmAsItIsByDefault) {
  const DisplayTransform transform;
  EXPECT_EQ(transform.apply(Vec3{0.25, 0.5, 1.0}), (Vec3{0.25, 0.5, 1.0}));
  EXPECT_EQ(transform.apply(Vec3{0.25, 3.0, 1.5}), (Vec3{0.25, 1.0, 1.0}));
}

TEST(DisplayTransform, ExposureCountsInStops) {
  EXPECT_EQ(DisplayTransform{.exposure_stops = -2.0}.apply(Vec3{0.5, 1.0, 4.0}), (Vec3{0.125, 0.25, 1.0}));
  EXPECT_EQ(DisplayTransform{.exposure_stops = 1.0}.apply(Vec3{0.125, 0.25, 0.0}), (Vec3{0.25, 0.5, 0.0}));
}

TEST(DisplayTransform, CurvesFollowTheirFormulas) {
  for (const double value : {0.001, 0.18, 1.0, 30.0, 900.0}) {
    const double reinhard = value * (1.0 + value / 1e6) / (1.0 + value);
    const double logarithmic = std::log1p(value) / std::log1p(1000.0);
    EXPECT_NEAR(DisplayTransform{.tone = ToneCurve::reinhard}.apply(Vec3{value}).g, reinhard, 1e-15);
    EXPECT_NEAR(DisplayTransform{.tone = ToneCurve::logarithmic}.apply(Vec3{value}).g, logarithmic, 1e-15);
  }
}

TEST(DisplayTransform, DragosCurveHasTheValuesOfItsFormula) {
  // Decimal arithmetic, 30 digits: log(1 + L) / log(2 + 8 (L/W)**(log(0.85)/log(0.5))) / log10(1 + W).
  const DisplayTransform transform{.tone = ToneCurve::drago, .white = 1e6};
  EXPECT_NEAR(transform.apply(Vec3{1.0}).g, 0.1377291393670483910927, 1e-14);
  EXPECT_NEAR(transform.apply(Vec3{1000.0}).g, 0.9021022303832106906215, 1e-14);
  EXPECT_NEAR(transform.apply(Vec3{1e6}).g, 1.0, 1e-14);
}

TEST(DisplayTransform, CurvesReachWhiteAtWhiteAndRiseOnTheWay) {
  for (const ToneCurve tone : {ToneCurve::reinhard, ToneCurve::logarithmic, ToneCurve::drago}) {
    const DisplayTransform transform{.tone = tone, .white = 50.0};
    EXPECT_EQ(transform.apply(Vec3{0.0}), Vec3{0.0});
    EXPECT_NEAR(transform.apply(Vec3{50.0}).r, 1.0, 1e-15);
    EXPECT_EQ(transform.apply(Vec3{500.0}), Vec3{1.0});
    double last = 0.0;
    for (double value = 1e-3; value < 50.0; value *= 1.5) {
      const double shown = transform.apply(Vec3{value}).r;
      EXPECT_GT(shown, last);
      last = shown;
    }
  }
}

TEST(DisplayTransform, CurvesKeepLuminanceAndHueOfBrightColours) {
  const DisplayTransform transform{.tone = ToneCurve::logarithmic};
  const Vec3 film{0.0, 1.0, 200.0};  // a strongly blue-shifted lamp
  const Vec3 shown = transform.apply(film);
  EXPECT_NEAR(luminance(shown), std::log1p(luminance(film)) / std::log1p(1000.0), 1e-14);
  EXPECT_EQ(shown.b, 1.0);
  EXPECT_LT(shown.r, shown.g);
  // Mixed with grey: the ratio of the differences between channels stays.
  EXPECT_NEAR((shown.g - shown.r) / (shown.b - shown.r), (film.g - film.r) / (film.b - film.r), 1e-14);
}

TEST(DisplayTransform, ColoursOutsideTheGamutLoseSaturationNotLuminance) {
  const Vec3 film{-0.2, 0.6, 0.1};
  const Vec3 shown = DisplayTransform{}.apply(film);
  EXPECT_EQ(shown.r, 0.0);
  EXPECT_NEAR(luminance(shown), luminance(film), 1e-15);
  EXPECT_NEAR((shown.b - shown.r) / (shown.g - shown.r), (film.b - film.r) / (film.g - film.r), 1e-14);
  EXPECT_EQ(DisplayTransform{}.apply(Vec3{-1.0, 0.1, 0.1}), Vec3{0.0});  // no light at all
}

TEST(DisplayTransform, StaysInRangeForAnyValue) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ToneCurve tone : {ToneCurve::none, ToneCurve::reinhard, ToneCurve::logarithmic}) {
    const DisplayTransform transform{.exposure_stops = 3.0, .tone = tone};
    for (const double r : {-infinity, -1e300, -1.0, 0.0, 1e-300, 0.5, 1e300, infinity}) {
      for (const double b : {-infinity, -2.0, 0.0, 7.0, 1e300, infinity}) {
        const Vec3 shown = transform.apply(Vec3{r, 0.3, b});
        for (const double value : {shown.r, shown.g, shown.b}) {
          EXPECT_TRUE(value >= 0.0 && value <= 1.0) << r << " " << b << " " << value;
        }
      }
    }
    EXPECT_TRUE(std::isnan(transform.apply(Vec3{0.0, nan, 0.0}).r));
  }
  EXPECT_EQ(DisplayTransform{}.apply(Vec3{infinity}), Vec3{1.0});
}

TEST(DisplayImage, GivesBytesAndCountsWhatTheyDoNotShow) {
  const std::vector<ChannelInfo> rgb{{"R", {}}, {"G", {}}, {"B", {}}};
  Image image({{0, 0, 9, 9}, {1, 2, 3, 4}, rgb, {}});
  for (std::size_t channel = 0; channel < 3; ++channel) {
    image.at(channel, 1, 2) = 0.18F;
    image.at(channel, 2, 2) = channel == 0 ? 2.0F : 0.5F;
    image.at(channel, 1, 3) = channel == 2 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
    image.at(channel, 2, 3) = channel == 0 ? -0.2F : 0.0F;
  }
  const Result<DisplayedImage> displayed = display_image(image, {});
  ASSERT_TRUE(displayed.ok()) << displayed.error();
  EXPECT_EQ(displayed.value().pixels.width, 2);
  EXPECT_EQ(displayed.value().pixels.height, 2);
  // 255 * 0.4613561 = 117.6; 255 * 0.7353570 = 187.5.
  EXPECT_EQ(displayed.value().pixels.samples,
            (std::vector<std::uint8_t>{118, 118, 118, 255, 188, 188, 255, 0, 255, 0, 0, 0}));
  EXPECT_EQ(displayed.value().report.beyond_white, 1U);
  EXPECT_EQ(displayed.value().report.outside_gamut, 1U);
  EXPECT_EQ(displayed.value().report.not_a_number, 1U);
}

TEST(DisplayImage, ShowsTheViewAskedFor) {
  const std::vector<std::string> views{"left", "right"};
  const std::vector<ChannelInfo> rgb{{"R", {}}, {"G", {}}, {"B", {}}};
  Image image({{0, 0, 1, 1}, {0, 0, 1, 1}, channels_of_views(rgb, views), views});
  image.plane(0)[0] = 1.0F;  // red on the left, blue on the right
  image.plane(5)[0] = 1.0F;
  EXPECT_EQ(display_image(image, {}, 0).value().pixels.samples, (std::vector<std::uint8_t>{255, 0, 0}));
  EXPECT_EQ(display_image(image, {}, 1).value().pixels.samples, (std::vector<std::uint8_t>{0, 0, 255}));
  EXPECT_EQ(display_image(image, {}, 2).error(), "the picture has no view number 2");
  const Image depth({{0, 0, 1, 1}, {0, 0, 1, 1}, {{"Z", {}}}, {}});
  EXPECT_EQ(display_image(depth, {}).error(), "the picture has no channel R");
}

}  // namespace
}  // namespace backlight
