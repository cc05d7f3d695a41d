#include "backlight/film/exr.h"

#include <gtest/gtest.h>
#include <half.h>
#include <stdlib.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "backlight/base/files.h"
#include "folder.h"

namespace backlight {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Exr = InFolder;

const std::vector<ChannelInfo> all_channels{{"R", ChannelPrecision::half},
                                            {"G", ChannelPrecision::half},
                                            {"B", ChannelPrecision::half},
                                            {"A", ChannelPrecision::half},
                                            {"Z", ChannelPrecision::single},
                                            {"doppler.D", ChannelPrecision::single},
                                            {"emissionTime.T", ChannelPrecision::single},
                                            {"properTime.T", ChannelPrecision::single},
                                            {"P.X", ChannelPrecision::single},
                                            {"P.Y", ChannelPrecision::single},
                                            {"P.Z", ChannelPrecision::single},
                                            {"N.X", ChannelPrecision::single},
                                            {"N.Y", ChannelPrecision::single},
                                            {"N.Z", ChannelPrecision::single},
                                            {"objectId.V", ChannelPrecision::single}};

/// Different values everywhere; a multiple of 1/64 below 1024 is exact as half where it has 11 bits.
Image pattern(ImageLayout layout) {
  Image image(std::move(layout));
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    std::uint32_t state = 17 + static_cast<std::uint32_t>(channel);
    for (float& value : image.plane(channel)) {
      state = 1664525 * state + 1013904223;
      value = static_cast<float>(state >> 21U) / 64.0F;  // 11 bits
      if (image.layout().channels[channel].precision == ChannelPrecision::single) {
        value += static_cast<float>(state & 0xFFFFU) / 16777216.0F;
      }
    }
  }
  return image;
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

void expect_same_pixels(const Image& written, const Image& read) {
  ASSERT_EQ(written.channel_count(), read.channel_count());
  EXPECT_EQ(written.layout().data, read.layout().data);
  EXPECT_EQ(written.layout().display, read.layout().display);
  for (std::size_t channel = 0; channel < written.channel_count(); ++channel) {
    const std::string& name = written.layout().channels[channel].name;
    const int found = read.find_channel(name);
    ASSERT_GE(found, 0) << name;
    const auto a = written.plane(channel);
    const auto b = read.plane(static_cast<std::size_t>(found));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(same_bits(a[i], b[i])) << name << " value " << i << ": " << a[i] << " became " << b[i];
    }
  }
}

ChannelPrecision precision_of(const Image& image, const char* name) {
  return image.layout().channels.at(static_cast<std::size_t>(image.find_channel(name))).precision;
}

TEST_F(Exr, EveryChannelComesBackBitForBit) {
  // 37 rows: not a whole number of ZIP chunks (16 rows) nor of bands.
  const Image image = pattern({{0, 0, 53, 37}, {0, 0, 53, 37}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  const Result<ExrPicture> read = read_exr(folder / "a.exr");
  ASSERT_TRUE(read.ok()) << read.error();
  expect_same_pixels(image, read.value().image);
  EXPECT_EQ(precision_of(read.value().image, "R"), ChannelPrecision::half);
  EXPECT_EQ(precision_of(read.value().image, "A"), ChannelPrecision::half);
  EXPECT_EQ(precision_of(read.value().image, "Z"), ChannelPrecision::single);
  EXPECT_EQ(entries(), 1);
}

TEST_F(Exr, ACropIsADataWindowInsideTheWholePicture) {
  const Image image = pattern({{0, 0, 100, 80}, {13, 21, 47, 62}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  const Result<ExrPicture> read = read_exr(folder / "a.exr");
  ASSERT_TRUE(read.ok()) << read.error();
  expect_same_pixels(image, read.value().image);
  const int red = read.value().image.find_channel("R");
  EXPECT_EQ(read.value().image.at(static_cast<std::size_t>(red), 46, 61), image.at(0, 46, 61));
}

TEST_F(Exr, ASinglePixelAndANegativeOriginWork) {
  const Image one = pattern({{0, 0, 1, 1}, {0, 0, 1, 1}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", one, {}).ok());
  expect_same_pixels(one, read_exr(folder / "a.exr").value().image);
  const Image outside = pattern({{0, 0, 10, 10}, {-7, -3, 12, 30}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", outside, {}).ok());
  expect_same_pixels(outside, read_exr(folder / "a.exr").value().image);
}

TEST_F(Exr, HalfIsRoundedToNearestTiesToEven) {
  Image image({{0, 0, 6, 1}, {0, 0, 6, 1}, {{"R", ChannelPrecision::half}}, {}});
  // Half has 10 bits after the point: between 1 and 2 the step is 2^-10.
  const float step = 1.0F / 1024.0F;
  const std::vector<std::pair<float, float>> cases{
      {1.0F + 0.5F * step, 1.0F},                               // tie: down to even
      {1.0F + 1.5F * step, 1.0F + 2.0F * step},                 // tie: up to even
      {std::nextafter(1.0F + 0.5F * step, 2.0F), 1.0F + step},  // just above the tie
      {std::nextafter(1.0F + 1.5F * step, 1.0F), 1.0F + step},  // just below the tie
      {3.0F * 0x1p-25F, 0x1p-23F},  // subnormal tie 1.5 steps of 2^-24: up to even
      {-0.0F, -0.0F}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    image.plane(0)[i] = cases[i].first;
  }
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  const Image read = read_exr(folder / "a.exr").value().image;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_TRUE(same_bits(read.plane(0)[i], cases[i].second)) << i << ": " << read.plane(0)[i];
  }
}

TEST_F(Exr, ColourBecomesFloatWhenAValuePassesHalf) {
  for (const auto& [value, expected] :
       {std::pair{65504.0F, ChannelPrecision::half},
        std::pair{std::nextafter(65504.0F, infinity), ChannelPrecision::single},
        std::pair{-70000.0F, ChannelPrecision::single}, std::pair{infinity, ChannelPrecision::half}}) {
    Image image = pattern({{0, 0, 20, 20}, {0, 0, 20, 20}, all_channels, {}});
    image.at(1, 19, 19) = value;
    image.at(4, 3, 3) = 1e30F;  // a distance may be great without any effect on the colour
    ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
    const Image read = read_exr(folder / "a.exr").value().image;
    expect_same_pixels(image, read);
    for (const char* name : {"R", "G", "B", "A"}) {
      EXPECT_EQ(precision_of(read, name), expected) << name << " with " << value;
    }
  }
}

TEST_F(Exr, ColourIsFloatWhenAskedFor) {
  Image image = pattern({{0, 0, 4, 4}, {0, 0, 4, 4}, all_channels, {}});
  image.at(0, 0, 0) = 1.0F / 3.0F;
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}, ColourStorage::always_float).ok());
  const Image read = read_exr(folder / "a.exr").value().image;
  expect_same_pixels(image, read);
  EXPECT_EQ(precision_of(read, "R"), ChannelPrecision::single);
}

TEST_F(Exr, NanAndInfinityAreKept) {
  Image image = pattern({{0, 0, 3, 1}, {0, 0, 3, 1}, all_channels, {}});
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    image.plane(channel)[0] = nan;
    image.plane(channel)[1] = infinity;
    image.plane(channel)[2] = -infinity;
  }
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  const Image read = read_exr(folder / "a.exr").value().image;
  for (std::size_t channel = 0; channel < read.channel_count(); ++channel) {
    EXPECT_TRUE(std::isnan(read.plane(channel)[0]));
    EXPECT_EQ(read.plane(channel)[1], infinity);
    EXPECT_EQ(read.plane(channel)[2], -infinity);
  }
}

TEST_F(Exr, StereoIsOneFileOfTwoViews) {
  const std::vector<std::string> views{"left", "right"};
  EXPECT_EQ(channel_name("R", views, 0), "R");
  EXPECT_EQ(channel_name("R", views, 1), "right.R");
  EXPECT_EQ(channel_name("doppler.D", views, 0), "doppler.left.D");
  EXPECT_EQ(channel_name("doppler.D", views, 1), "doppler.right.D");
  EXPECT_EQ(channel_name("R", {}, 0), "R");
  const std::vector<ChannelInfo> channels = channels_of_views(all_channels, views);
  ASSERT_EQ(channels.size(), 2 * all_channels.size());
  const Image image = pattern({{0, 0, 9, 7}, {0, 0, 9, 7}, channels, views});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  const Image read = read_exr(folder / "a.exr").value().image;
  expect_same_pixels(image, read);
  EXPECT_EQ(read.layout().views, views);
}

TEST_F(Exr, TheHeaderComesBack) {
  ExrHeader header;
  header.software = "Backlight 0.1.0";
  header.comments = "two lines\nand \xCE\xB2 = 0.9";
  header.white_luminance = 80.0F;
  header.world_to_camera = world_to_camera_matrix(Vec3{1.0, 2.0, 3.0}, Vec3{1.0, 0.0, 0.0},
                                                  Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, -1.0});
  header.attributes = {{"backlight/complete", 1},
                       {"backlight/gamma", 2.25F},
                       {"backlight/time", 0.1},
                       {"backlight/scene", std::string("street.toml")},
                       {"backlight/cameraVelocity", Vec3{0.1, -0.2, 0.3}},
                       {"backlight/a name of more than thirty-one characters", -7},
                       {"backlight/overrides", std::vector<std::string>{"c=5", "camera.fov=40"}}};
  const Image image = pattern({{0, 0, 4, 4}, {0, 0, 4, 4}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, header).ok());
  const Result<ExrInfo> info = read_exr_info(folder / "a.exr");
  ASSERT_TRUE(info.ok()) << info.error();
  const ExrHeader& read = info.value().header;
  EXPECT_EQ(info.value().layout.channels.size(), all_channels.size());
  EXPECT_EQ(read.software, header.software);
  EXPECT_EQ(read.comments, header.comments);
  EXPECT_EQ(read.white_luminance, 80.0F);
  EXPECT_EQ(read.world_to_camera, header.world_to_camera);
  ASSERT_EQ(read.attributes.size(), header.attributes.size());
  EXPECT_EQ(*read.find<std::int32_t>("backlight/complete"), 1);
  EXPECT_EQ(*read.find<float>("backlight/gamma"), 2.25F);
  EXPECT_EQ(*read.find<double>("backlight/time"), 0.1);
  EXPECT_EQ(*read.find<std::string>("backlight/scene"), "street.toml");
  EXPECT_EQ(*read.find<Vec3>("backlight/cameraVelocity"), (Vec3{0.1, -0.2, 0.3}));
  EXPECT_EQ(*read.find<std::int32_t>("backlight/a name of more than thirty-one characters"), -7);
  EXPECT_EQ(*read.find<std::vector<std::string>>("backlight/overrides"),
            (std::vector<std::string>{"c=5", "camera.fov=40"}));
  EXPECT_EQ(read.find<std::int32_t>("backlight/time"), nullptr);
  EXPECT_EQ(read.find<std::int32_t>("backlight/none"), nullptr);
}

TEST(WorldToCamera, TakesThePositionToTheOriginAndLooksAlongMinusZ) {
  const double s = std::sqrt(0.5);
  const Vec3 position{3.0, -1.0, 2.0};
  const Vec3 forward{s, 0.0, s};
  const Vec3 up{0.0, 1.0, 0.0};
  const Vec3 right = glm::cross(forward, up);
  const std::array<float, 16> m = world_to_camera_matrix(position, right, up, forward);
  const auto apply = [&](const Vec3& p) {
    Vec3 q{0.0};
    for (int column = 0; column < 3; ++column) {
      const auto c = static_cast<std::size_t>(column);
      q[column] = p.x * double{m[c]} + p.y * double{m[4 + c]} + p.z * double{m[8 + c]} + double{m[12 + c]};
    }
    return q;
  };
  const auto expect_near = [](const Vec3& a, const Vec3& b) { EXPECT_LT(glm::length(a - b), 2e-6); };
  expect_near(apply(position), Vec3{0.0});
  expect_near(apply(position + 5.0 * forward), Vec3{0.0, 0.0, -5.0});
  expect_near(apply(position + 2.0 * right), Vec3{2.0, 0.0, 0.0});
  expect_near(apply(position + 3.0 * up), Vec3{0.0, 3.0, 0.0});
}

TEST_F(Exr, TheSamePictureGivesTheSameBytesAndNoClock) {
  const Image image = pattern({{0, 0, 70, 50}, {0, 0, 70, 50}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, {}).ok());
  ASSERT_TRUE(write_exr(folder / "b.exr", image, {}).ok());
  const std::string bytes = read_file(folder / "a.exr").value();
  EXPECT_EQ(bytes, read_file(folder / "b.exr").value());
  EXPECT_EQ(bytes.find("capDate"), std::string::npos);
}

// The rows of a picture from `first` on, as planes of their own.
std::vector<std::span<const float>> rows_of(const Image& image, int first, int count) {
  const auto width = static_cast<std::size_t>(image.layout().data.width());
  std::vector<std::span<const float>> planes;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    planes.push_back(image.plane(channel).subspan(width * static_cast<std::size_t>(first),
                                                  width * static_cast<std::size_t>(count)));
  }
  return planes;
}

TEST_F(Exr, RowsEncodedInAnyOrderGiveTheSameBytesAndComeBack) {
  const ImageLayout layout{{0, 0, 50, 50}, {3, 2, 47, 49}, all_channels, {}};
  const Image image = pattern(layout);
  ASSERT_TRUE(write_exr(folder / "whole.exr", image, {}).ok());
  Result<ExrWriter> writer = ExrWriter::open(folder / "rows.exr", layout, {});
  ASSERT_TRUE(writer.ok()) << writer.error();
  const auto last = writer.value().encode(34, rows_of(image, 32, 15), 15);
  const auto first = writer.value().encode(2, rows_of(image, 0, 32), 32);
  ASSERT_TRUE(first.ok() && last.ok());
  EXPECT_FALSE(writer.value().encode(3, rows_of(image, 1, 16), 16).ok());
  EXPECT_FALSE(writer.value().encode(2, rows_of(image, 0, 15), 15).ok());
  ASSERT_TRUE(writer.value().write(first.value()).ok());

  const ExrPicture whole = read_exr(folder / "whole.exr").value();
  std::vector<std::vector<float>> back(image.channel_count(), std::vector<float>(44 * 16));
  const std::vector<std::span<float>> planes(back.begin(), back.end());
  EXPECT_FALSE(writer.value().read_back(34, planes, 15).ok());
  ASSERT_TRUE(writer.value().read_back(18, planes, 16).ok());
  for (std::size_t channel = 0; channel < planes.size(); ++channel) {
    const auto found = static_cast<std::size_t>(whole.image.find_channel(layout.channels[channel].name));
    EXPECT_EQ(std::memcmp(planes[channel].data(), whole.image.plane(found).data() + 44 * 16,
                          planes[channel].size_bytes()),
              0)
        << layout.channels[channel].name;
  }

  ASSERT_TRUE(writer.value().write(last.value()).ok());
  ASSERT_TRUE(writer.value().commit().ok());
  EXPECT_EQ(read_file(folder / "rows.exr").value(), read_file(folder / "whole.exr").value());
}

TEST_F(Exr, RowsOutOfOrderAreRefused) {
  const ImageLayout layout{{0, 0, 9, 40}, {0, 0, 9, 40}, all_channels, {}};
  const Image image = pattern(layout);
  Result<ExrWriter> writer = ExrWriter::open(folder / "rows.exr", layout, {});
  const auto second = writer.value().encode(16, rows_of(image, 16, 16), 16);
  EXPECT_FALSE(writer.value().write(second.value()).ok());
  EXPECT_FALSE(writer.value().commit().ok());
  EXPECT_EQ(entries(), 0);
}

TEST_F(Exr, RowsGivenInPiecesGiveTheSameBytes) {
  const ImageLayout layout{{0, 0, 30, 90}, {2, 5, 28, 82}, all_channels, {}};
  const Image image = pattern(layout);
  ASSERT_TRUE(write_exr(folder / "whole.exr", image, {}).ok());
  for (const int piece : {1, 7, 16, 40, 77}) {
    Result<ExrWriter> writer = ExrWriter::open(folder / "rows.exr", layout, {});
    ASSERT_TRUE(writer.ok()) << writer.error();
    const std::size_t width = 26;
    for (int row = 0; row < 77; row += piece) {
      const int count = std::min(piece, 77 - row);
      std::vector<std::span<const float>> planes;
      for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        planes.push_back(image.plane(channel).subspan(width * static_cast<std::size_t>(row),
                                                      width * static_cast<std::size_t>(count)));
      }
      ASSERT_TRUE(writer.value().write_rows(planes, count).ok());
    }
    const Result<void> committed = writer.value().commit();
    ASSERT_TRUE(committed.ok()) << committed.error();
    EXPECT_EQ(read_file(folder / "rows.exr").value(), read_file(folder / "whole.exr").value()) << piece;
  }
}

TEST_F(Exr, AWriterOfRowsRefusesWhatItCannotStore) {
  const ImageLayout layout{{0, 0, 4, 2}, {0, 0, 4, 2}, {{"R", ChannelPrecision::half}}, {}};
  const std::vector<float> row{1.0F, 2.0F, 70000.0F, 4.0F};
  const std::vector<std::span<const float>> planes{row};
  const std::string start = "cannot write " + (folder / "a.exr").string() + ": ";
  {
    Result<ExrWriter> writer = ExrWriter::open(folder / "a.exr", layout, {});
    ASSERT_TRUE(writer.ok());
    EXPECT_EQ(writer.value().write_rows(planes, 2).error(), start + "the rows do not fit the picture");
  }
  {
    Result<ExrWriter> writer = ExrWriter::open(folder / "a.exr", layout, {});
    ASSERT_TRUE(writer.ok());
    EXPECT_EQ(writer.value().commit().error(), start + "rows of the picture are missing");
  }
  {
    Result<ExrWriter> writer = ExrWriter::open(folder / "a.exr", layout, {});
    ASSERT_TRUE(writer.ok());
    const std::string expected =
        start + "the value 70000.000000 of channel R is beyond half precision; store it as float";
    EXPECT_EQ(writer.value().write_rows(planes, 1).error(), expected);
    EXPECT_EQ(writer.value().commit().error(), expected);
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(Exr, TheClockIsOnlyWhatTheCallerGives) {
  ExrHeader header;
  header.creation_time = 951782400;  // 2000-02-29 00:00:00 UTC
  const Image image = pattern({{0, 0, 4, 4}, {0, 0, 4, 4}, all_channels, {}});
  ASSERT_TRUE(write_exr(folder / "a.exr", image, header).ok());
  const ExrHeader read = read_exr_info(folder / "a.exr").value().header;
  EXPECT_EQ(*read.find<std::string>("capDate"), "2000:02:29 00:00:00");
  EXPECT_EQ(*read.find<float>("utcOffset"), 0.0F);
}

TEST(SourceDateEpoch, IsReadFromTheEnvironment) {
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(source_date_epoch().value(), std::nullopt);
  ::setenv("SOURCE_DATE_EPOCH", "951782400", 1);
  EXPECT_EQ(source_date_epoch().value(), 951782400);
  ::setenv("SOURCE_DATE_EPOCH", "yesterday", 1);
  EXPECT_EQ(source_date_epoch().error(), "SOURCE_DATE_EPOCH is 'yesterday'; expected seconds since 1970");
  ::unsetenv("SOURCE_DATE_EPOCH");
}

TEST_F(Exr, RefusesPicturesThatMakeNoSense) {
  const std::string start = "cannot write " + (folder / "a.exr").string() + ": ";
  const PixelBox box{0, 0, 2, 2};
  const auto error_of = [&](const ImageLayout& layout, const ExrHeader& header = {}) {
    return write_exr(folder / "a.exr", Image(layout), header).error();
  };
  EXPECT_EQ(error_of({box, {1, 1, 1, 2}, all_channels, {}}), start + "the picture has no pixel");
  EXPECT_EQ(error_of({box, box, {}, {}}), start + "the picture has no channel");
  EXPECT_EQ(error_of({box, box, {{"R", {}}, {"R", {}}}, {}}),
            start + "two channels are called 'R', or one has no name");
  ExrHeader header;
  header.attributes = {{"channels", 1}};
  EXPECT_EQ(error_of({box, box, all_channels, {}}, header),
            start + "'channels' cannot be the name of a further attribute");
  EXPECT_EQ(entries(), 0);
}

}  // namespace
}  // namespace backlight
