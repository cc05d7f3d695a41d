// backlight compare, info, view and assemble on files of other programs: several parts, tiles, whole numbers.
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "program.h"

namespace backlight::test {
namespace {

using Strings = std::vector<std::string>;
constexpr int size = 4;

// A part of `size` x `size` pixels with one channel; all values are `value`, but for the last one.
struct Part {
  std::string name;
  std::string channel = "Z";
  float value = 0.0F;
  float last = 0.0F;
  std::optional<std::uint32_t> number{};  // all of a channel of whole numbers
  int width = size;
};

Imf::Header header_of(const Part& part) {
  Imf::Header header(size, size);
  header.dataWindow().max.x = part.width - 1;
  header.setName(part.name);
  header.setType(Imf::SCANLINEIMAGE);
  header.channels().insert(part.channel, Imf::Channel(part.number ? Imf::UINT : Imf::FLOAT));
  return header;
}

class CompareParts : public ProgramTest {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder / "work" / name).string(); }

  void write_parts(const std::string& name, const std::vector<Part>& parts) const {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) headers.push_back(header_of(part));
    Imf::MultiPartOutputFile file(path(name).c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto count = static_cast<std::size_t>(parts[i].width * size);
      std::vector<float> floats(count, parts[i].value);
      floats.back() = parts[i].last;
      std::vector<std::uint32_t> numbers(count, parts[i].number.value_or(0));
      const void* data = parts[i].number ? static_cast<void*>(numbers.data()) : floats.data();
      Imf::FrameBuffer buffer;
      buffer.insert(parts[i].channel, Imf::Slice::Make(parts[i].number ? Imf::UINT : Imf::FLOAT, data,
                                                       Imath::V2i(0, 0), parts[i].width, size));
      Imf::OutputPart out(file, static_cast<int>(i));
      out.setFrameBuffer(buffer);
      out.writePixels(size);
    }
  }

  // One part of scanlines, and nothing special but what `change` does to the header.
  template <class Change>
  void write_single(const std::string& name, const Change& change) const {
    Imf::Header header = header_of({"", "Y"});
    change(header);
    std::vector<float> values(static_cast<std::size_t>(size * size), 0.5F);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), Imath::V2i(0, 0), size, size));
    Imf::OutputFile file(path(name).c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(size);
  }

  void write_tiles(const std::string& name, Imf::LevelMode mode, float level_1) const {
    Imf::Header header(size, size);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(2, 2, mode));
    Imf::TiledOutputFile file(path(name).c_str(), header);
    for (int level = 0; level < file.numLevels(); ++level) {
      const int width = file.levelWidth(level);
      std::vector<float> values(static_cast<std::size_t>(width * width), level == 0 ? 0.5F : level_1);
      Imf::FrameBuffer buffer;
      buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), Imath::V2i(0, 0), width, width));
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
  }

  void write_deep(const std::string& name) const {
    Imf::Header header(size, size);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    const std::vector<unsigned int> counts(static_cast<std::size_t>(size * size), 0);
    std::vector<float*> samples(counts.size(), nullptr);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), Imath::V2i(0, 0), size, size));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float*),
                                      sizeof(float*) * size, sizeof(float)));
    Imf::DeepScanLineOutputFile file(path(name).c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(size);
  }

  void expect(int code, const Strings& arguments, const Strings& in_output) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    for (const std::string& text : in_output) {
      EXPECT_NE((outcome.out + outcome.err).find(text), std::string::npos) << "no '" << text << "' in:\n"
                                                                           << outcome.out << outcome.err;
    }
  }
};

TEST_F(CompareParts, LooksAtAllOfThem) {
  write_parts("a.exr", {{"rgba", "R", 1.0F, 1.0F}, {"depth", "Z", 2.0F, 2.0F}, {"id", "V", 3.0F, 3.0F}});
  write_parts("b.exr", {{"rgba", "R", 1.0F, 1.0F}, {"depth", "Z", 2.0F, 2.5F}, {"id", "V", 3.0F, 3.0F}});
  expect(0, {"compare", "a.exr", "a.exr"}, {"part 'rgba': equal", "part 'depth': equal", "part 'id': equal"});
  expect(1, {"compare", "a.exr", "b.exr"},
         {"b.exr, part 'rgba': equal", "part 'depth': differs: 1 pixel", "worst Z by 0.5 at 3,3"});
  expect(1, {"compare", "a.exr", "b.exr", "--html", "report.html"}, {});
  EXPECT_NE(read("report.html").find("b.exr, part 'depth'"), std::string::npos);
  // Limits are of the parts that have such a channel; a name that none has is trouble.
  expect(0, {"compare", "a.exr", "b.exr", "--tolerance", "Z=1"}, {"part 'depth': equal"});
  expect(0, {"compare", "a.exr", "b.exr", "--channels", "R,V"}, {"part 'id': equal"});
  expect(2, {"compare", "a.exr", "b.exr", "--channels", "Y"}, {"there is no channel 'Y'"});
}

TEST_F(CompareParts, MatchesThemByName) {
  write_parts("a.exr", {{"left", "R", 1.0F, 1.0F}, {"right", "R", 2.0F, 2.0F}});
  write_parts("swapped.exr", {{"right", "R", 2.0F, 2.0F}, {"left", "R", 1.0F, 1.0F}});
  write_parts("named.exr", {{"left", "R", 1.0F, 1.0F}, {"middle", "R", 2.0F, 2.0F}});
  write_parts("less.exr", {{"left", "R", 1.0F, 1.0F}});
  write_parts("wide.exr", {{"left", "R", 1.0F, 1.0F}, {"right", "R", 2.0F, 2.0F, {}, 5}});
  write_parts("channel.exr", {{"left", "R", 1.0F, 1.0F}, {"right", "G", 2.0F, 2.0F}});
  expect(0, {"compare", "a.exr", "swapped.exr"}, {});
  expect(1, {"compare", "a.exr", "named.exr"},
         {"part 'right': missing: there is a reference, but no new part", "part 'middle': extra"});
  expect(1, {"compare", "a.exr", "less.exr"}, {"part 'right': missing"});
  expect(1, {"compare", "less.exr", "a.exr"}, {"part 'right': extra"});
  expect(2, {"compare", "a.exr", "wide.exr"}, {"part 'right'", "the data windows differ"});
  expect(2, {"compare", "a.exr", "channel.exr"}, {"part 'right'", "the channels differ"});
}

TEST_F(CompareParts, CountsAndUpdatesFilesNotParts) {
  std::filesystem::create_directories(folder / "work" / "ref");
  std::filesystem::create_directories(folder / "work" / "new");
  write_parts("ref/a.exr", {{"rgba", "R", 1.0F, 1.0F}, {"depth", "Z", 2.0F, 2.0F}});
  write_parts("new/a.exr", {{"rgba", "R", 1.0F, 1.0F}});
  write_parts("ref/b.exr", {{"rgba", "R", 1.0F, 1.0F}, {"depth", "Z", 2.0F, 2.0F}});
  write_parts("new/b.exr", {{"rgba", "R", 1.0F, 1.0F}, {"depth", "Z", 2.0F, 2.0F}});
  expect(1, {"compare", "ref", "new"}, {"2 images, 1 equal, 1 differs"});
  expect(0, {"compare", "ref", "new", "--update"}, {"updated ref/a.exr", "1 updated"});
  EXPECT_EQ(read("ref/a.exr"), read("new/a.exr"));
}

TEST_F(CompareParts, ComparesWholeNumbersExactly) {
  // 2^24 and 2^24 + 1 are the same float.
  write_parts("a.exr", {{"rgba", "R"}, {"id", "id", 0.0F, 0.0F, 16777216U}});
  write_parts("b.exr", {{"rgba", "R"}, {"id", "id", 0.0F, 0.0F, 16777217U}});
  expect(0, {"compare", "a.exr", "a.exr"}, {});
  expect(1, {"compare", "a.exr", "b.exr"}, {"16 pixels (100 %)", "worst id by 1", "16777216", "16777217"});
  write_parts("c.exr", {{"rgba", "R"}, {"id", "id", 0.0F, 0.0F, 4294967294U}});
  write_parts("d.exr", {{"rgba", "R"}, {"id", "id", 0.0F, 0.0F, 4294967295U}});
  expect(1, {"compare", "c.exr", "d.exr"}, {"worst id by 1", "4294967295"});
  expect(0, {"info", "a.exr"}, {"part 1 of 2, 'rgba'", "R:float", "part 2 of 2, 'id'", "id:uint"});
}

TEST_F(CompareParts, IsInTroubleWithWhatItCannotLookAt) {
  write_single("plain.exr", [](Imf::Header&) {});
  write_single("aspect.exr", [](Imf::Header& header) { header.pixelAspectRatio() = 2.0F; });
  write_single("colours.exr", [](Imf::Header& header) {
    Imf::addChromaticities(header, Imf::Chromaticities(Imath::V2f(0.7F, 0.3F)));
  });
  write_single("upwards.exr", [](Imf::Header& header) { header.lineOrder() = Imf::DECREASING_Y; });
  write_tiles("tiles.exr", Imf::ONE_LEVEL, 0.0F);
  write_tiles("levels.exr", Imf::MIPMAP_LEVELS, 0.25F);
  write_tiles("levels2.exr", Imf::MIPMAP_LEVELS, 0.75F);
  write_deep("deep.exr");
  expect(0, {"compare", "plain.exr", "upwards.exr"}, {});
  expect(0, {"compare", "plain.exr", "tiles.exr"}, {});
  expect(2, {"compare", "plain.exr", "aspect.exr"}, {"the pixels' aspect ratios differ: 1 and 2"});
  expect(2, {"compare", "plain.exr", "colours.exr"}, {"the chromaticities differ"});
  expect(2, {"compare", "levels.exr", "levels2.exr"}, {"the reference is mip-mapped"});
  expect(2, {"compare", "plain.exr", "levels.exr"}, {"the new picture is mip-mapped"});
  expect(2, {"compare", "deep.exr", "deep.exr"}, {"it is a deep picture"});
  expect(
      0, {"info", "deep.exr", "levels.exr", "aspect.exr"},
      {"deep scanlines", "it is a deep picture", "tiles of 2 x 2, and smaller levels", "pixel aspect ratio"});
}

TEST_F(CompareParts, AreNotPassedOverByOtherCommands) {
  write_parts("a.exr", {{"rgba", "R"}, {"depth", "Z"}});
  expect(4, {"view", "a.exr"}, {"a.exr: the picture has no channel G"});
  // An image of ours that was put into a file with another one is not the image that would be rendered.
  write_scene("scene.toml", "");
  ASSERT_EQ(run({"scene.toml", "-r", "8x6", "-o", "scene.exr"}).code, 0);
  if (std::system("oiiotool --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "oiiotool is not installed";
  const std::string file = path("scene.exr");
  const std::string two = "oiiotool '" + file + "' --attrib oiio:subimagename one '" + file +
                          "' --attrib oiio:subimagename two --siappend -o '" + path("two.exr") + "'";
  ASSERT_EQ(std::system(two.c_str()), 0);
  expect(0, {"view", "two.exr"}, {"of 2 parts, 'one' is shown"});
  expect(1, {"assemble", "two.exr", "-o", "whole.exr"}, {"two.exr has 2 parts"});
  std::filesystem::copy_file(path("two.exr"), file, std::filesystem::copy_options::overwrite_existing);
  expect(0, {"scene.toml", "-r", "8x6", "-o", "scene.exr", "--skip-existing"}, {});
  expect(0, {"info", "scene.exr"}, {"scene.exr: 8 x 6"});
}

}  // namespace
}  // namespace backlight::test
