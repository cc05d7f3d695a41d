#include "backlight/render/partial_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "backlight/render/image_faults.h"
#include "backlight/render/image_identity.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

class PartialFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "backlight-partial-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
    header.attributes = {{identity_attribute, std::string("me")}, {"backlight/complete", std::int32_t{1}}};
  }
  void TearDown() override { fs::remove_all(folder); }

  static ImageLayout layout(const std::vector<std::string>& views = {}) {
    const std::vector<ChannelInfo> channels{{"R", ChannelPrecision::half}, {"Z", ChannelPrecision::single}};
    return {{0, 0, 20, 30}, {2, 3, 12, 25}, channels_of_views(channels, views), views};
  }
  static constexpr int rows = 16;  // of a band: there are two

  // The first pixels of the first band.
  static void set_done(RowBand& band, std::size_t view, std::size_t count) {
    std::fill_n(band.done[view].begin(), count, std::uint8_t{1});
    band.missing -= count;
  }

  fs::path folder;
  ExrHeader header;
};

TEST_F(PartialFile, StandsBesideTheImage) {
  EXPECT_EQ(partial_path("x/shot.0007.exr"), fs::path("x/shot.0007.partial.exr"));
}

TEST_F(PartialFile, GivesEveryBitBack) {
  for (const std::vector<std::string>& views : {std::vector<std::string>{}, {"left", "right"}}) {
    PartialImage partial(layout(views), rows, true);
    RowBand& band = *partial.begin(0);
    for (std::size_t channel = 0; channel < band.image.channel_count(); ++channel) {
      for (std::size_t i = 0; i < 100; ++i) {
        band.image.plane(channel)[i] = 1.0F / (static_cast<float>(i) + 0.3F) + 1e6F * float(channel);
      }
      band.image.plane(channel)[5] = std::numeric_limits<float>::infinity();
      band.image.plane(channel)[6] = -0.0F;
      band.image.plane(channel)[7] = std::numeric_limits<float>::denorm_min();
    }
    for (std::size_t view = 0; view < band.done.size(); ++view) set_done(band, view, 100);
    ASSERT_TRUE(write_partial(folder / "p.exr", partial, header).ok());
    EXPECT_EQ(*read_exr_info(folder / "p.exr").value().header.find<std::int32_t>("backlight/complete"), 0);

    PartialImage back(layout(views), rows, true);
    const auto read = read_partial(folder / "p.exr", "me", back);
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_EQ(back.begin(0)->done, band.done);
    EXPECT_EQ(back.begin(0)->missing, band.missing);
    EXPECT_EQ(back.find(1), nullptr);
    for (std::size_t channel = 0; channel < band.image.channel_count(); ++channel) {
      const auto wrote = band.image.plane(channel);
      EXPECT_EQ(std::memcmp(wrote.data(), back.find(0)->image.plane(channel).data(), wrote.size_bytes()), 0)
          << channel;
    }
  }
}

TEST_F(PartialFile, IsZeroWhereNothingIsDone) {
  PartialImage partial(layout(), rows, true);
  RowBand& band = *partial.begin(0);
  for (std::size_t channel = 0; channel < 2; ++channel) std::ranges::fill(band.image.plane(channel), 7.0F);
  set_done(band, 0, 3);
  ASSERT_TRUE(write_partial(folder / "p.exr", partial, header).ok());
  const Image image = read_exr(folder / "p.exr").value().image;
  for (const char* name : {"R", "Z"}) {
    const auto plane = image.plane(static_cast<std::size_t>(image.find_channel(name)));
    EXPECT_EQ(plane[2], 7.0F);
    EXPECT_EQ(plane[3], 0.0F);
    EXPECT_EQ(plane[200], 0.0F);
  }
}

TEST_F(PartialFile, IsRefusedWhenItIsOfSomethingElse) {
  ASSERT_TRUE(write_partial(folder / "p.exr", PartialImage(layout(), rows, true), header).ok());
  PartialImage other(layout(), rows, true);
  EXPECT_FALSE(read_partial(folder / "p.exr", "somebody", other).ok());
  EXPECT_FALSE(read_partial(folder / "none.exr", "me", other).ok());
  PartialImage stereo(layout({"left", "right"}), rows, true);
  EXPECT_FALSE(read_partial(folder / "p.exr", "me", stereo).ok());
  PartialImage larger({{0, 0, 20, 30}, {0, 0, 20, 30}, layout().channels, {}}, rows, true);
  EXPECT_FALSE(read_partial(folder / "p.exr", "me", larger).ok());
  // An image that was finished is no partial one: it has no mask.
  ASSERT_TRUE(write_exr(folder / "whole.exr", Image(layout()), header).ok());
  EXPECT_FALSE(read_partial(folder / "whole.exr", "me", other).ok());
}

TEST_F(PartialFile, IsNotACompleteImage) {
  Image image(layout());
  ASSERT_TRUE(write_exr(folder / "a.exr", image, header).ok());
  EXPECT_TRUE(is_complete_image(folder / "a.exr", "me", PixelBox{2, 3, 12, 25}, ColourStorage::automatic));
  EXPECT_FALSE(is_complete_image(folder / "a.exr", "me", std::nullopt, ColourStorage::automatic));
  EXPECT_FALSE(is_complete_image(folder / "a.exr", "me", PixelBox{2, 3, 13, 25}, ColourStorage::automatic));
  EXPECT_FALSE(is_complete_image(folder / "a.exr", "you", PixelBox{2, 3, 12, 25}, ColourStorage::automatic));
  EXPECT_FALSE(is_complete_image(folder / "b.exr", "me", PixelBox{2, 3, 12, 25}, ColourStorage::automatic));
  EXPECT_FALSE(is_complete_image(folder, "me", PixelBox{2, 3, 12, 25}, ColourStorage::automatic));
  const auto is_complete = [&](ColourStorage storage) {
    return is_complete_image(folder / "a.exr", "me", PixelBox{2, 3, 12, 25}, storage);
  };
  EXPECT_FALSE(is_complete(ColourStorage::always_float));
  ASSERT_TRUE(write_exr(folder / "a.exr", image, header, ColourStorage::always_float).ok());
  EXPECT_TRUE(is_complete(ColourStorage::always_float));
  EXPECT_FALSE(is_complete(ColourStorage::automatic));
  image.at(0, 5, 5) = 70000.0F;
  ASSERT_TRUE(write_exr(folder / "a.exr", image, header).ok());
  EXPECT_TRUE(is_complete(ColourStorage::always_float));
  EXPECT_TRUE(is_complete(ColourStorage::automatic));
  ASSERT_TRUE(write_partial(folder / "a.exr", PartialImage(layout(), rows, true), header).ok());
  EXPECT_FALSE(is_complete_image(folder / "a.exr", "me", PixelBox{2, 3, 12, 25}, ColourStorage::automatic));
}

TEST(ImageFaults, AreCountedByPixel) {
  Image image(
      {{0, 0, 9, 9}, {1, 2, 9, 9}, {{"R", ChannelPrecision::half}, {"Z", ChannelPrecision::single}}, {}});
  image.at(0, 4, 5) = std::numeric_limits<float>::quiet_NaN();
  image.at(1, 4, 5) = std::numeric_limits<float>::infinity();
  image.at(1, 3, 4) = -std::numeric_limits<float>::infinity();
  image.at(0, 8, 8) = -70000.0F;
  image.at(1, 2, 2) = 70000.0F;
  image.at(1, 6, 6) = std::numeric_limits<float>::infinity();  // nothing is there: no fault
  const ImageFaults faults = faults_of(image);
  EXPECT_EQ(faults.non_finite, 2U);
  EXPECT_EQ(faults.first_non_finite, std::make_pair(3, 4));
  EXPECT_EQ(faults.beyond_half, 1U);
}

ImageFacts facts() {
  return {0.1, 2.0, "eye", {32, 20, 4, 7, {"Z"}}};
}

TEST(ImageIdentity, DependsOnEverythingThatDecidesTheBytes) {
  const ImageOrigin origin{"Backlight 1", "a.toml", "0123", {"c=2"}, {}};
  std::vector<std::string> all{image_identity(origin, {"d"}, facts())};
  const auto with_origin = [&](auto change) {
    ImageOrigin other = origin;
    change(other);
    all.push_back(image_identity(other, {"d"}, facts()));
  };
  with_origin([](ImageOrigin& o) { o.software = "Backlight 2"; });
  with_origin([](ImageOrigin& o) { o.scene_sha256 = "0124"; });
  with_origin([](ImageOrigin& o) { o.overrides = {}; });
  with_origin([](ImageOrigin& o) { o.overrides = {"c=2", "c=3"}; });
  with_origin([](ImageOrigin& o) { o.overrides = {"c=2\"\noverride \"c=3"}; });
  const auto with_facts = [&](auto change) {
    ImageFacts other = facts();
    change(other);
    all.push_back(image_identity(origin, {"d"}, other));
  };
  with_facts([](ImageFacts& f) { f.time = std::nextafter(0.1, 1.0); });
  with_facts([](ImageFacts& f) { f.frame = 3.0; });
  with_facts([](ImageFacts& f) { f.camera = "ear"; });
  with_facts([](ImageFacts& f) { f.film.width = 33; });
  with_facts([](ImageFacts& f) { f.film.height = 33; });
  with_facts([](ImageFacts& f) { f.film.samples = 33; });
  with_facts([](ImageFacts& f) { f.film.seed = 33; });
  with_facts([](ImageFacts& f) { f.film.aovs = {"Z", "N"}; });
  all.push_back(image_identity(origin, {"d", "d"}, facts()));
  all.push_back(image_identity(origin, {}, facts()));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());

  ImageOrigin renamed = origin;
  renamed.scene_file = "b.toml";
  EXPECT_EQ(image_identity(renamed, {"d"}, facts()), image_identity(origin, {"d"}, facts()));
}

}  // namespace
}  // namespace backlight
