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

  static PartialImage empty(const std::vector<std::string>& views = {}) {
    const std::vector<ChannelInfo> channels{{"R", ChannelPrecision::half}, {"Z", ChannelPrecision::single}};
    PartialImage partial{Image({{0, 0, 20, 30}, {2, 3, 12, 25}, channels_of_views(channels, views), views}),
                         {}};
    partial.done.assign(std::max<std::size_t>(views.size(), 1), std::vector<std::uint8_t>(10 * 22, 0));
    return partial;
  }

  fs::path folder;
  ExrHeader header;
};

TEST_F(PartialFile, StandsBesideTheImage) {
  EXPECT_EQ(partial_path("x/shot.0007.exr"), fs::path("x/shot.0007.partial.exr"));
}

TEST_F(PartialFile, GivesEveryBitBack) {
  for (const std::vector<std::string>& views : {std::vector<std::string>{}, {"left", "right"}}) {
    PartialImage partial = empty(views);
    for (std::size_t channel = 0; channel < partial.image.channel_count(); ++channel) {
      for (std::size_t i = 0; i < 100; ++i) {
        partial.image.plane(channel)[i] = 1.0F / (static_cast<float>(i) + 0.3F) + 1e6F * float(channel);
      }
      partial.image.plane(channel)[5] = std::numeric_limits<float>::infinity();
      partial.image.plane(channel)[6] = -0.0F;
      partial.image.plane(channel)[7] = std::numeric_limits<float>::denorm_min();
    }
    for (auto& plane : partial.done) std::fill(plane.begin(), plane.begin() + 100, std::uint8_t{1});
    partial.done.back()[3] = 0;
    ASSERT_TRUE(write_partial(folder / "p.exr", partial, header).ok());
    EXPECT_EQ(*read_exr_info(folder / "p.exr").value().header.find<std::int32_t>("backlight/complete"), 0);

    PartialImage back = empty(views);
    const auto read = read_partial(folder / "p.exr", "me", back);
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_EQ(back.done, partial.done);
    for (std::size_t channel = 0; channel < partial.image.channel_count(); ++channel) {
      const auto wrote = partial.image.plane(channel);
      EXPECT_EQ(std::memcmp(wrote.data(), back.image.plane(channel).data(), wrote.size_bytes()), 0)
          << channel;
    }
    EXPECT_EQ(back.image.layout().channels, partial.image.layout().channels);
  }
}

TEST_F(PartialFile, IsRefusedWhenItIsOfSomethingElse) {
  ASSERT_TRUE(write_partial(folder / "p.exr", empty(), header).ok());
  PartialImage other = empty();
  EXPECT_FALSE(read_partial(folder / "p.exr", "somebody", other).ok());
  EXPECT_FALSE(read_partial(folder / "none.exr", "me", other).ok());
  PartialImage stereo = empty({"left", "right"});
  EXPECT_FALSE(read_partial(folder / "p.exr", "me", stereo).ok());
  PartialImage larger{Image({{0, 0, 20, 30}, {0, 0, 20, 30}, other.image.layout().channels, {}}),
                      {std::vector<std::uint8_t>(600, 0)}};
  EXPECT_FALSE(read_partial(folder / "p.exr", "me", larger).ok());
  // An image that was finished is no partial one: it has no mask.
  ASSERT_TRUE(write_exr(folder / "whole.exr", other.image, header).ok());
  EXPECT_FALSE(read_partial(folder / "whole.exr", "me", other).ok());
}

TEST_F(PartialFile, IsNotACompleteImage) {
  PartialImage partial = empty();
  ASSERT_TRUE(write_exr(folder / "a.exr", partial.image, header).ok());
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
  ASSERT_TRUE(write_exr(folder / "a.exr", partial.image, header, ColourStorage::always_float).ok());
  EXPECT_TRUE(is_complete(ColourStorage::always_float));
  EXPECT_FALSE(is_complete(ColourStorage::automatic));
  partial.image.at(0, 5, 5) = 70000.0F;
  ASSERT_TRUE(write_exr(folder / "a.exr", partial.image, header).ok());
  EXPECT_TRUE(is_complete(ColourStorage::always_float));
  EXPECT_TRUE(is_complete(ColourStorage::automatic));
  ASSERT_TRUE(write_partial(folder / "a.exr", partial, header).ok());
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
