#include "backlight/film/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace backlight {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

Image picture(const std::vector<std::string>& names, const PixelBox& data = {0, 0, 4, 2},
              const std::vector<std::string>& views = {}) {
  ImageLayout layout;
  layout.display = {0, 0, 8, 8};
  layout.data = data;
  layout.views = views;
  for (const std::string& name : names) layout.channels.push_back({name, ChannelPrecision::single});
  return Image(layout);
}

ImageDifference compared(const Image& reference, const Image& now, const CompareLimits& limits = {}) {
  auto result = compare_images(reference, now, limits);
  if (!result.ok()) throw std::runtime_error(result.error());
  return std::move(result).value();
}

std::string trouble(const Image& reference, const Image& now, const CompareLimits& limits = {}) {
  const auto result = compare_images(reference, now, limits);
  return result.ok() ? "" : result.error();
}

TEST(Compare, MeasuresEachChannel) {
  Image a = picture({"R", "Z"}, {2, 3, 6, 5});
  Image b = a;
  a.at(0, 4, 3) = 2.0F;
  b.at(0, 4, 3) = 5.0F;
  b.at(0, 5, 4) = -4.0F;
  const ImageDifference d = compared(a, b);
  ASSERT_EQ(d.channels.size(), 2U);
  const ChannelDifference& r = d.channels[0];
  EXPECT_DOUBLE_EQ(r.mean, 7.0 / 8.0);
  EXPECT_DOUBLE_EQ(r.rms, std::sqrt(25.0 / 8.0));
  EXPECT_DOUBLE_EQ(r.psnr, 20.0 * std::log10(5.0 / std::sqrt(25.0 / 8.0)));
  EXPECT_EQ(r.maximum, 4.0);
  EXPECT_EQ(r.x, 5);
  EXPECT_EQ(r.y, 4);
  EXPECT_EQ(r.reference, 0.0F);
  EXPECT_EQ(r.now, -4.0F);
  EXPECT_EQ(r.over_fail, 2U);
  EXPECT_EQ(d.channels[1].maximum, 0.0);
  EXPECT_EQ(d.channels[1].x, -1);
  EXPECT_EQ(d.channels[1].psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(d.pixels, 8U);
  EXPECT_EQ(d.over_fail, 2U);
  EXPECT_EQ(d.verdict, Verdict::failure);
  EXPECT_EQ(d.worst().name, "R");
}

TEST(Compare, CountsAPixelOnceWhateverItsChannels) {
  const Image a = picture({"R", "G"});
  Image b = a;
  b.at(0, 1, 1) = b.at(1, 1, 1) = 1.0F;
  EXPECT_EQ(compared(a, b).over_fail, 1U);
}

TEST(Compare, ValuesThatAreNotFiniteEqualThemselvesOnly) {
  Image a = picture({"R"});
  Image b = a;
  const std::pair<float, float> pairs[] = {{nan, nan},  {inf, inf},  {-inf, -inf}, {nan, 1.0F},
                                           {1.0F, nan}, {inf, -inf}, {nan, inf},   {0.0F, 0.0F}};
  int i = 0;
  for (const auto& [reference, now] : pairs) {
    a.plane(0)[static_cast<std::size_t>(i)] = reference;
    b.plane(0)[static_cast<std::size_t>(i++)] = now;
  }
  CompareLimits generous;
  generous.fail = 1e30;
  const ImageDifference d = compared(a, b, generous);
  const ChannelDifference& r = d.channels[0];
  EXPECT_EQ(r.nan_reference, 3U);
  EXPECT_EQ(r.nan_new, 2U);
  EXPECT_EQ(r.inf_reference, 3U);
  EXPECT_EQ(r.inf_new, 4U);
  EXPECT_EQ(r.not_comparable, 4U);
  EXPECT_EQ(r.over_fail, 4U);
  EXPECT_TRUE(std::isinf(r.maximum));
  EXPECT_EQ(r.x, 3);
  EXPECT_EQ(r.mean, 0.0);
  EXPECT_EQ(d.verdict, Verdict::failure);
  EXPECT_EQ(compared(a, a).verdict, Verdict::pass);
}

TEST(Compare, LimitsDecide) {
  const Image a = picture({"R"});  // 8 pixels
  Image b = a;
  b.at(0, 0, 0) = 1.0F;
  const auto verdict = [&](const CompareLimits& limits) { return compared(a, b, limits).verdict; };
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(verdict({}), Verdict::failure);
  EXPECT_EQ(verdict({.fail = 0.999}), Verdict::failure);
  EXPECT_EQ(verdict({.fail = 1.0, .warn = 1.0}), Verdict::pass);
  EXPECT_EQ(verdict({.fail = 1.0}), Verdict::warning);
  EXPECT_EQ(verdict({.fail_relative = 1.9}), Verdict::failure);  // |a - b| is twice the mean
  EXPECT_EQ(verdict({.fail_relative = 2.0, .warn = 2.0}), Verdict::pass);
  EXPECT_EQ(verdict({.fail_percent = 12.4}), Verdict::failure);
  EXPECT_EQ(verdict({.fail_percent = 12.5, .warn = 2.0}), Verdict::pass);
  EXPECT_EQ(verdict({.fail_percent = 12.5, .hard_fail = 0.5}), Verdict::failure);
  EXPECT_EQ(verdict({.fail = 2.0, .hard_fail = 0.5}), Verdict::failure);
  EXPECT_EQ(verdict({.fail_percent = 12.5, .hard_fail = 1.0, .warn = 2.0}), Verdict::pass);
  EXPECT_EQ(verdict({.allow_failures = 1, .hard_fail = 0.5, .warn = 2.0}), Verdict::pass);
  EXPECT_EQ(verdict({.fail = 2.0, .warn = 0.5, .warn_percent = 12.5}), Verdict::pass);
  EXPECT_EQ(verdict({.fail = 2.0, .warn = infinite, .hard_warn = 0.5}), Verdict::warning);
}

TEST(Compare, TolerancesGoByNameInAllViews) {
  const std::vector<std::string> views{"left", "right"};
  const Image a = picture({"R", "right.R", "Z", "right.Z", "P.left.X", "P.right.X"}, {0, 0, 4, 2}, views);
  Image b = a;
  for (std::size_t i = 0; i < b.channel_count(); ++i) b.at(i, 1, 1) = 0.5F;
  CompareLimits limits;
  limits.tolerances = {{"Z", 1.0}, {"P", 2.0}, {"right.R", 3.0}};
  const ImageDifference d = compared(a, b, limits);
  const double expected[] = {1e-6, 3.0, 1.0, 1.0, 2.0, 2.0};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(d.channels[i].tolerance, expected[i]) << d.channels[i].name;
    EXPECT_EQ(d.channels[i].over_fail, i == 0 ? 1U : 0U) << d.channels[i].name;
  }
  limits.channels = {"Z", "P"};
  EXPECT_EQ(compared(a, b, {.tolerances = {{"Z", 1.0}, {"P", 1.0}}, .channels = {"Z", "P"}}).verdict,
            Verdict::pass);
}

TEST(Compare, SaysWhatCannotBeCompared) {
  const Image a = picture({"R", "Z"});
  EXPECT_EQ(trouble(a, picture({"R", "Z"}, {0, 0, 4, 3})),
            "the data windows differ: 4x2 at 0,0 and 4x3 at 0,0");
  ImageLayout larger = a.layout();
  larger.display = {0, 0, 9, 8};
  EXPECT_EQ(trouble(a, Image(larger)), "the sizes differ: 8x8 and 9x8");
  EXPECT_EQ(trouble(a, picture({"R", "G"})),
            "the channels differ: only in the reference: Z; only in the new picture: G");
  EXPECT_EQ(trouble(a, picture({"R", "Z"}, {0, 0, 4, 2}, {"left", "right"})),
            "the views differ: none and left, right");
  EXPECT_EQ(trouble(a, a, {.tolerances = {{"doppler", 1.0}}}),
            "there is no channel 'doppler'; there are R, Z");
  EXPECT_EQ(trouble(a, picture({"R", "G"}), {.channels = {"R"}}), "");
}

}  // namespace
}  // namespace backlight
