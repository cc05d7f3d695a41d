#include "backlight/render/image_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "backlight/base/files.h"
#include "backlight/render/image_identity.h"
#include "backlight/render/partial_file.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

constexpr int rows = 16;  // of a band

class ImageFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "backlight-file-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
    header.attributes = {{identity_attribute, std::string("me")}, {"backlight/complete", std::int32_t{1}}};
    for (std::size_t channel = 0; channel < 2; ++channel) {
      for (std::size_t i = 0; i < picture.plane(channel).size(); ++i)
        picture.plane(channel)[i] = 1.0F / (float(i) + 0.3F) + 1e5F * float(channel);
    }
  }
  void TearDown() override { fs::remove_all(folder); }

  // The band is traced.
  void finish(PartialImage& partial, std::size_t number, std::size_t pixels = 10000) const {
    RowBand& band = *partial.begin(number);
    const std::size_t first = picture.offset(2, partial.band_window(number).y0);
    pixels = std::min(pixels, band.image.plane(0).size());
    for (std::size_t channel = 0; channel < 2; ++channel)
      std::ranges::copy(picture.plane(channel).subspan(first, pixels), band.image.plane(channel).begin());
    std::fill_n(band.done[0].begin(), pixels, std::uint8_t{1});
    band.missing -= pixels;
  }

  [[nodiscard]] std::string expected(ColourStorage storage = ColourStorage::automatic) const {
    EXPECT_TRUE(write_exr(folder / "expected.exr", picture, header, storage).ok());
    return read_file(folder / "expected.exr").value();
  }
  [[nodiscard]] std::string made() const { return read_file(folder / "a.exr").value(); }

  const ImageLayout layout{{0, 0, 20, 90},
                           {2, 3, 12, 76},  // five bands, of which the last has 9 rows
                           {{"R", ChannelPrecision::half}, {"Z", ChannelPrecision::single}},
                           {}};
  Image picture{layout};
  fs::path folder;
  ExrHeader header;
};

TEST_F(ImageFileTest, HasTheBytesOfTheWholePicture) {
  HelperThread helper;
  for (HelperThread* with : {static_cast<HelperThread*>(nullptr), &helper}) {
    PartialImage partial(layout, rows, false);
    ImageFile file(folder / "a.exr", header, ColourStorage::automatic, partial, with);
    for (const std::size_t band : {1U, 0U, 3U, 4U, 2U}) {  // as several threads may be done with them
      finish(partial, band);
      file.take_finished();
    }
    file.settle();
    EXPECT_TRUE(partial.is_complete());
    EXPECT_FALSE(file.is_to_begin_anew());
    for (std::size_t band = 0; band < 5; ++band) EXPECT_TRUE(partial.was_released(band)) << band;
    ASSERT_TRUE(file.commit().ok());
    EXPECT_EQ(made(), expected());
  }
}

TEST_F(ImageFileTest, TakesBandsFromSeveralThreads) {
  PartialImage partial(layout, rows, false);
  ImageFile file(folder / "a.exr", header, ColourStorage::automatic, partial, nullptr);
  {
    std::vector<std::jthread> threads;
    for (std::size_t band = 0; band < 5; ++band) {
      threads.emplace_back([&, band] {
        finish(partial, band);
        file.take_finished();
      });
    }
  }
  ASSERT_TRUE(file.commit().ok());
  EXPECT_EQ(made(), expected());
}

// What was rounded is traced again, or taken again where it was kept.
TEST_F(ImageFileTest, BeginsAnewInFloatWhereHalfIsNotEnough) {
  picture.at(0, 5, 40) = 70000.0F;
  picture.at(0, 6, 40) = std::numeric_limits<float>::infinity();
  for (const bool keeps_rows : {false, true}) {
    PartialImage partial(layout, rows, keeps_rows);
    ImageFile file(folder / "a.exr", header, ColourStorage::automatic, partial, nullptr);
    for (std::size_t band = 0; band < 5; ++band) {
      finish(partial, band);
      file.take_finished();
    }
    EXPECT_TRUE(file.is_to_begin_anew());
    EXPECT_EQ(file.has_use_for_pixels(), keeps_rows);
    file.begin_anew();
    EXPECT_EQ(partial.has_any(), keeps_rows);
    for (std::size_t band = 0; band < 5; ++band) {
      if (!keeps_rows) finish(partial, band);
      file.take_finished();
    }
    EXPECT_FALSE(file.is_to_begin_anew());
    EXPECT_EQ(file.faults().beyond_half, 1U);
    EXPECT_EQ(file.faults().non_finite, 1U);
    EXPECT_EQ(file.faults().first_non_finite, std::make_pair(6, 40));
    ASSERT_TRUE(file.commit().ok());
    EXPECT_EQ(made(), expected());
  }
}

TEST_F(ImageFileTest, LeavesNothingWithoutAllRows) {
  PartialImage partial(layout, rows, false);
  {
    ImageFile file(folder / "a.exr", header, ColourStorage::automatic, partial, nullptr);
    finish(partial, 0);
    file.take_finished();
    EXPECT_FALSE(file.commit().ok());
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(ImageFileTest, TellsAtTheCommitWhatWentWrong) {
  PartialImage partial(layout, rows, false);
  ImageFile file(folder / "x" / "a.exr", header, ColourStorage::automatic, partial, nullptr);
  ASSERT_TRUE(write_file(folder / "x", "not a folder").ok());
  finish(partial, 0);
  file.take_finished();
  EXPECT_TRUE(file.is_lost());
  EXPECT_FALSE(file.has_use_for_pixels());
  EXPECT_NE(file.commit().error().find("cannot"), std::string::npos) << file.commit().error();
}

// An image that is put aside: some rows in the file, some in memory, some not begun. A pixel that half cannot
// hold is not among those that are done, where others are rounded.
TEST_F(ImageFileTest, APartialImageGoesOnToTheSameBytes) {
  for (const auto& [value, storage] :
       {std::pair(1.0F, ColourStorage::automatic), std::pair(70000.0F, ColourStorage::automatic),
        std::pair(70000.0F, ColourStorage::always_float)}) {
    picture.at(0, 5, 36) = value;
    {
      PartialImage partial(layout, rows, false);
      ImageFile file(folder / "a.exr", header, storage, partial, nullptr);
      for (const std::size_t band : {0U, 1U}) finish(partial, band);
      file.take_finished();
      finish(partial, 2, 25);
      ASSERT_TRUE(write_partial(folder / "p.exr", partial, header, &file).ok());
    }
    const auto stored = read_exr(folder / "p.exr").value().image;
    const bool is_left_out = value > 65504.0F && storage == ColourStorage::automatic;
    const auto mask = static_cast<std::size_t>(stored.find_channel("rendered.V"));
    EXPECT_EQ(std::ranges::count(stored.plane(mask), 1.0F), 32 * 10 + 25 - (is_left_out ? 1 : 0));

    PartialImage partial(layout, rows, false);
    ImageFile file(folder / "a.exr", header, storage, partial, nullptr);
    ASSERT_TRUE(read_partial(folder / "p.exr", "me", partial, &file).ok());
    EXPECT_TRUE(partial.was_released(0) && partial.was_released(1));
    EXPECT_EQ(partial.find(2)->missing, 160U - 25U + (is_left_out ? 1U : 0U));
    const auto go_on = [&] {
      for (std::size_t band = 0; band < 5; ++band) {
        if (RowBand* begun = partial.begin(band)) {
          begun->missing = begun->image.plane(0).size();
          finish(partial, band);
        }
        file.take_finished();
      }
    };
    go_on();
    EXPECT_EQ(file.is_to_begin_anew(), is_left_out);
    if (is_left_out) {
      file.begin_anew();
      go_on();
    }
    ASSERT_TRUE(file.commit().ok());
    EXPECT_EQ(made(), expected(storage));
  }
}

}  // namespace
}  // namespace backlight
