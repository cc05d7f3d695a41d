// Which files a render writes, and what is in them.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "backlight/film/exr.h"
#include "program.h"

namespace backlight::test {
namespace {

using Files = std::vector<std::string>;

class Output : public ProgramTest {
 protected:
  [[nodiscard]] ExrPicture picture(const std::string& name) const {
    auto picture = read_exr(folder / "work" / name);
    if (!picture.ok()) ADD_FAILURE() << picture.error();
    return std::move(picture).value();
  }
  void expect_success(const std::vector<std::string>& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
};

constexpr const char* animation = "[animation]\nfps = 10\nframes = [1, 3]\n";

TEST_F(Output, IsNamedAfterTheScene) {
  write_scene();
  expect_success({"scene.toml"});
  EXPECT_EQ(files(), (Files{"scene.exr", "scene.toml"}));
}

TEST_F(Output, GoesToTheCurrentFolderFromASceneElsewhere) {
  std::filesystem::create_directory(folder / "work" / "scenes");
  write_scene("scenes/one.toml");
  expect_success({"scenes/one.toml"});
  EXPECT_EQ(files(), (Files{"one.exr", "scenes/one.toml"}));
}

TEST_F(Output, OfAnAnimationIsNumbered) {
  write_scene("scene.toml", animation);
  expect_success({"scene.toml"});
  EXPECT_EQ(files(), (Files{"scene.0001.exr", "scene.0002.exr", "scene.0003.exr", "scene.toml"}));
}

TEST_F(Output, OfOneFrameOfAnAnimationIsNumberedToo) {
  write_scene("scene.toml", animation);
  expect_success({"scene.toml", "-f", "2"});
  EXPECT_EQ(files(), (Files{"scene.0002.exr", "scene.toml"}));
}

TEST_F(Output, OfOneInstantIsNotNumbered) {
  write_scene("scene.toml", animation);
  expect_success({"scene.toml", "--time", "0.1"});
  EXPECT_EQ(files(), (Files{"scene.exr", "scene.toml"}));
}

TEST_F(Output, OfAFrameIsThatOfItsTime) {
  write_scene("scene.toml",
              std::string(animation) +
                  "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [\"20*image_time\", 0, 0]\n");
  expect_success({"scene.toml", "-f", "2", "-s", "2", "-o", "frame.exr"});
  expect_success({"scene.toml", "--time", "0.1", "-s", "2", "-o", "time.exr"});
  expect_success({"scene.toml", "--time", "0.2", "-s", "2", "-o", "later.exr"});
  const std::string frame = read("frame.0002.exr");
  EXPECT_GT(frame.size(), 500U);
  EXPECT_EQ(frame, read("time.exr"));
  EXPECT_NE(frame, read("later.exr"));
}

TEST_F(Output, IsThatOfTheChosenCamera) {
  write("two.toml",
        "[film]\nresolution = [8, 8]\n[[camera]]\nname = \"left\"\n[[camera]]\nname = \"right\"\n"
        "velocity = [0.5, 0, 0]\n[background]\ncolor = [1, 1, 1]\n");
  expect_success({"two.toml", "--camera", "right"});
  EXPECT_EQ(*picture("two.exr").header.find<std::string>("backlight/camera"), "right");
  EXPECT_NEAR(picture("two.exr").header.find<Vec3>("backlight/cameraVelocity")->x, 0.5, 1e-15);
  expect_success({"two.toml"});
  EXPECT_EQ(*picture("two.exr").header.find<std::string>("backlight/camera"), "left");
}

TEST_F(Output, FollowsThePattern) {
  write_scene();
  expect_success({"scene.toml", "-f", "1-5x2", "-o", "shots/take##/a.%03d.exr"});
  EXPECT_EQ(files(), (Files{"scene.toml", "shots/take##/a.001.exr", "shots/take##/a.003.exr",
                            "shots/take##/a.005.exr"}));
}

TEST_F(Output, MayBeAFolder) {
  write_scene();
  std::filesystem::create_directory(folder / "work" / "there");
  expect_success({"scene.toml", "-o", "there"});
  expect_success({"scene.toml", "-o", "new/"});
  EXPECT_EQ(files(), (Files{"new/scene.exr", "scene.toml", "there/scene.exr"}));
}

// Hashes and percent signs stand for numbers in the file's name only.
TEST_F(Output, MayBeAFolderOfAnyName) {
  write_scene();
  for (const std::string name : {"take#2", "50%", "a%d##", "%s{}"}) {
    std::filesystem::create_directory(folder / "work" / name);
    EXPECT_EQ(run({"scene.toml", "-o", name}).code, 0);
    EXPECT_EQ(run({"scene.toml", "-o", name + "/new/"}).code, 0);
    EXPECT_EQ(run({"scene.toml", "-o", name + "/b.####.exr", "-f", "3,4"}).code, 0);
    Files expected{name + "/b.0003.exr", name + "/b.0004.exr", name + "/new/scene.exr", name + "/scene.exr",
                   "scene.toml"};
    std::ranges::sort(expected);
    EXPECT_EQ(files(), expected);
    std::filesystem::remove_all(folder / "work" / name);
  }
}

TEST_F(Output, DryRunsTellItAndWriteNothing) {
  write_scene("scene.toml", animation);
  EXPECT_EQ(run({"scene.toml", "--dry-run"}).out, "scene.0001.exr\nscene.0002.exr\nscene.0003.exr\n");
  EXPECT_EQ(run({"scene.toml", "--list-frames", "-f", "7,9", "-o", "d/a.#.exr"}).out,
            "7\td/a.0007.exr\n9\td/a.0009.exr\n");
  EXPECT_EQ(run({"scene.toml", "--dry-run", "--png", "-f", "2"}).out, "scene.0002.exr\nscene.0002.png\n");
  EXPECT_EQ(run({"scene.toml", "--dry-run"}).err, "");
  EXPECT_EQ(files(), Files{"scene.toml"});
}

TEST_F(Output, PngStandsBesideTheExr) {
  write_scene();
  expect_success({"scene.toml", "--png", "-o", "a.exr"});
  EXPECT_EQ(files(), (Files{"a.exr", "a.png", "scene.toml"}));
  EXPECT_EQ(read("a.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(Output, FilmFlagsOverrideTheScene) {
  write_scene();
  expect_success(
      {"scene.toml", "-r", "24x10", "-s", "4", "--seed", "7", "--aov", "Z,objectId", "-D", "camera.fov=40"});
  const ExrPicture made = picture("scene.exr");
  EXPECT_EQ(made.image.layout().display, (PixelBox{0, 0, 24, 10}));
  EXPECT_EQ(*made.header.find<std::int32_t>("backlight/samples"), 4);
  EXPECT_EQ(*made.header.find<double>("backlight/seed"), 7.0);
  EXPECT_EQ(*made.header.find<std::vector<std::string>>("backlight/overrides"), Files{"camera.fov=40"});
  EXPECT_EQ(*made.header.find<std::string>("backlight/scene"), "scene.toml");
  EXPECT_EQ(made.header.find<std::string>("backlight/sceneSha256")->size(), 64U);
  EXPECT_EQ(*made.header.find<std::int32_t>("backlight/complete"), 1);
  EXPECT_GE(made.image.find_channel("Z"), 0);
  EXPECT_GE(made.image.find_channel("objectId.V"), 0);
  EXPECT_LT(made.image.find_channel("doppler.D"), 0);
}

TEST_F(Output, ColourIsHalfUnlessAskedFor) {
  write_scene();
  expect_success({"scene.toml", "-o", "half.exr"});
  expect_success({"scene.toml", "-o", "float.exr", "--float"});
  const ImageLayout half = picture("half.exr").image.layout();
  const ImageLayout single = picture("float.exr").image.layout();
  for (const ChannelInfo& channel : half.channels)
    EXPECT_EQ(channel.precision, ChannelPrecision::half) << channel.name;
  for (const ChannelInfo& channel : single.channels) {
    EXPECT_EQ(channel.precision, ChannelPrecision::single) << channel.name;
  }
}

TEST_F(Output, CropHasThePixelsOfTheWhole) {
  write_scene();
  const Files common{"scene.toml", "--float", "-s", "3", "--aov", "all"};
  auto whole = common;
  whole.insert(whole.end(), {"-o", "whole.exr"});
  auto crop = common;
  crop.insert(crop.end(), {"-o", "crop.exr", "--crop", "10,4,27,17"});
  expect_success(whole);
  expect_success(crop);
  const Image all = picture("whole.exr").image;
  const Image part = picture("crop.exr").image;
  EXPECT_EQ(part.layout().display, all.layout().display);
  ASSERT_EQ(part.layout().data, (PixelBox{10, 4, 27, 17}));
  ASSERT_EQ(part.channel_count(), all.channel_count());
  for (std::size_t channel = 0; channel < all.channel_count(); ++channel) {
    for (int j = 4; j < 17; ++j) {
      for (int i = 10; i < 27; ++i) ASSERT_EQ(part.at(channel, i, j), all.at(channel, i, j)) << i << "," << j;
    }
  }
}

TEST_F(Output, IsTheSameToTheByteForAnyNumberOfThreads) {
  write_scene();
  expect_success({"scene.toml", "-s", "5", "--aov", "all", "-t", "1", "-o", "one.exr"});
  expect_success({"scene.toml", "-s", "5", "--aov", "all", "-t", "5", "-o", "five.exr"});
  EXPECT_EQ(read("one.exr"), read("five.exr"));
  EXPECT_GT(read("one.exr").size(), 1000U);
}

TEST_F(Output, HasNoClockUnlessItIsGiven) {
  write_scene();
  expect_success({"scene.toml", "-o", "a.exr"});
  EXPECT_EQ(read("a.exr").find("capDate"), std::string::npos);
  EXPECT_EQ(run({"scene.toml", "-o", "b.exr"}, {"SOURCE_DATE_EPOCH=1700000000"}).code, 0);
  EXPECT_NE(read("b.exr").find("2023:11:14 22:13:20"), std::string::npos);
}

TEST_F(Output, StatisticsAreOneObjectAnImage) {
  write_scene("scene.toml", animation);
  expect_success({"scene.toml", "--stats", "stats.json", "-t", "1"});
  std::ifstream file(folder / "work" / "stats.json");
  int lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    EXPECT_EQ(line.find("{\"frame\":" + std::to_string(lines + 1) + ","), 0U) << line;
    EXPECT_NE(line.find("\"cameraRays\":640,"), std::string::npos) << line;
    EXPECT_NE(line.find("\"nonFinitePixels\":0"), std::string::npos) << line;
    EXPECT_EQ(line.back(), '}');
  }
  EXPECT_EQ(lines, 3);
}

TEST_F(Output, TellsOfUnresolvedRoots) {
  // Everywhere a root of multiplicity two.
  write("scene.toml",
        "[film]\nresolution = [16, 16]\n[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n"
        "[[object]]\nshape = \"implicit\"\nf = \"(x^2 + y^2 + z^2 - 1)^2\"\n"
        "bounds = [[-1.5, -1.5, -1.5], [1.5, 1.5, 1.5]]\n");
  const Outcome outcome = run({"scene.toml", "--stats", "stats.json", "--aov", "unresolved"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto picture = read_exr(folder / "work" / "scene.exr");
  ASSERT_TRUE(picture.ok()) << picture.error();
  const Image& image = picture.value().image;
  const auto channel = image.find_channel("unresolved.V");
  ASSERT_GE(channel, 0);
  const auto shown = std::ranges::count(image.plane(static_cast<std::size_t>(channel)), 1.0F);
  EXPECT_GT(shown, 10);
  EXPECT_NE(read("stats.json").find("\"unresolvedHits\":" + std::to_string(shown) + "}"), std::string::npos)
      << read("stats.json");
  EXPECT_NE(outcome.err.find(std::to_string(shown) + " of 256 camera rays meet a surface where its root"),
            std::string::npos)
      << outcome.err;
}

TEST_F(Output, CountsTheRootsOfFormulas) {
  const auto roots = [&](const std::string& object) {
    write("scene.toml",
          "[film]\nresolution = [16, 16]\n[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n"
          "[[object]]\n" +
              object);
    expect_success({"scene.toml", "--stats", "stats.json", "--aov", "Z", "-s", "1"});
    const std::string line = read("stats.json");
    const std::string name = "\"rootsSolved\":";
    const std::size_t at = line.find(name);
    return at == std::string::npos ? -1L : std::stol(line.substr(at + name.size()));
  };
  EXPECT_EQ(roots("shape = \"sphere\"\nradius = 1\n"), 0);
  const long ball = roots(
      "shape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 1\"\n"
      "bounds = [[-1.5, -1.5, -1.5], [1.5, 1.5, 1.5]]\n");
  const Image depth = picture("scene.exr").image;
  const auto plane = depth.plane(static_cast<std::size_t>(depth.find_channel("Z")));
  // One for each ray that sees it; nothing casts a shadow.
  EXPECT_EQ(ball, std::ranges::count_if(plane, [](float z) { return std::isfinite(z) && z > 0.0F; }));
  EXPECT_GT(ball, 10);
}

TEST_F(Output, ProgressIsOnStandardErrorAlone) {
  write_scene();
  const Outcome quiet = run({"scene.toml", "-q"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  const Outcome lines = run({"scene.toml", "--progress", "lines"});
  EXPECT_NE(lines.err.find("Progress: 100% (scene.exr"), std::string::npos) << lines.err;
  const Outcome json = run({"scene.toml", "--progress", "json"});
  EXPECT_NE(json.err.find("{\"event\":\"progress\",\"fraction\":1,"), std::string::npos) << json.err;
  EXPECT_NE(json.err.find("{\"event\":\"image\",\"frame\":1,"), std::string::npos) << json.err;
  const Outcome none = run({"scene.toml", "--progress", "none"});
  EXPECT_EQ(none.err.find("Progress"), std::string::npos) << none.err;
  for (const Outcome* outcome : {&lines, &json, &none}) EXPECT_EQ(outcome->out, "");
}

TEST_F(Output, IsToldByInfoAndShownByView) {
  write_scene();
  expect_success({"scene.toml", "-D", "camera.fov=50"});
  const Outcome info = run({"info", "scene.exr"});
  EXPECT_EQ(info.code, 0) << info.err;
  for (const char* text :
       {"scene.exr: 32 x 20", "R:half", "backlight/scene ", "scene.toml", "camera.fov=50", "Backlight "}) {
    EXPECT_NE(info.out.find(text), std::string::npos) << text << "\n" << info.out;
  }
  expect_success({"view", "scene.exr", "--exposure", "1", "-o", "v.png"});
  expect_success({"view", "scene.exr", "scene.exr", "scene.exr", "-o", "sheet.png"});
  expect_success({"view", "scene.exr", "--tone", "reinhard", "--white", "4"});
  EXPECT_EQ(files(), (Files{"scene.exr", "scene.png", "scene.toml", "sheet.png", "v.png"}));
  // The PNG header's width and height: three pictures make a sheet of 2 x 2.
  const std::string sheet = read("sheet.png");
  EXPECT_EQ(sheet.substr(16, 8), std::string("\0\0\0\x40\0\0\0\x28", 8));
}

TEST_F(Output, PngIsShownAsViewShowsIt) {
  write_scene();
  const std::vector<std::string> shown{"--tone", "reinhard", "--exposure", "1.5", "--white", "4"};
  std::vector<std::string> render{"scene.toml", "--png"};
  std::vector<std::string> view{"view", "scene.exr", "-o", "view.png"};
  render.insert(render.end(), shown.begin(), shown.end());
  view.insert(view.end(), shown.begin(), shown.end());
  expect_success(render);
  expect_success(view);
  EXPECT_EQ(read("scene.png"), read("view.png"));
  expect_success({"scene.toml", "--png"});
  EXPECT_NE(read("scene.png"), read("view.png"));
  EXPECT_EQ(run({"scene.toml", "--tone", "drago"}).code, 2);
  EXPECT_EQ(run({"scene.toml", "--png", "--white", "0"}).code, 2);
}

TEST_F(Output, StatisticsTellWhatWasReused) {
  write_scene("scene.toml", animation);
  expect_success({"scene.toml", "--stats", "s.json", "-f", "1-3"});
  const std::string lines = read("s.json");
  EXPECT_NE(lines.find("\"surfacesReused\":0,"), std::string::npos) << lines;
  EXPECT_NE(lines.rfind("\"surfacesMade\":0,"), std::string::npos) << lines;
  const Outcome outcome = run({"scene.toml", "-v", "-f", "1-3"});
  EXPECT_NE(outcome.err.find("from the first tile to the last"), std::string::npos) << outcome.err;
}

// Rows leave the memory for the file while others are traced: all pixels would take 200 MB.
TEST_F(Output, AnImageOfOneSampleIsNotInMemoryAsAWhole) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take more memory";
  write_scene();
  in_child = [] {
    const rlimit limit{120 << 20, 120 << 20};  // of memory that is written to, stacks of threads among it
    setrlimit(RLIMIT_DATA, &limit);
  };
  expect_success({"scene.toml", "-r", "6000x2000", "-s", "1", "-t", "1", "-o", "large.exr", "-q"});
  const auto info = read_whole_exr_info(folder / "work" / "large.exr");
  ASSERT_TRUE(info.ok()) << info.error();
  EXPECT_EQ(info.value().layout.data, (PixelBox{0, 0, 6000, 2000}));
  EXPECT_NE(run({"scene.toml", "-r", "6000x2000", "-s", "2", "-t", "1", "-o", "more.exr"}).code, 0);
}

// Of one sample, what was rounded to half is traced again; of more it was kept.
TEST_F(Output, ColourThatPassesHalfOnlyAtTheEndIsFloatEverywhere) {
  write_scene(
      "scene.toml",
      "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [0, -2, 0]\nmaterial = { emission = 1e6 }\n");
  for (const char* samples : {"1", "3"}) {
    const std::vector<std::string> job{"scene.toml", "-r", "200x300", "-s", samples, "-t", "2", "-q", "-o"};
    const auto made = [&](const std::string& name, const std::string& storage) {
      std::vector<std::string> arguments = job;
      arguments.insert(arguments.end(), {name, storage, "--stats", name + ".json"});
      expect_success(arguments);
      return read(name);
    };
    EXPECT_EQ(made("half.exr", "--half"), made("float.exr", "--float"));
    EXPECT_EQ(picture("half.exr").image.layout().channels[0].precision, ChannelPrecision::single);
    const std::string rays = "\"cameraRays\":" + std::to_string(200 * 300 * std::stoi(samples)) + ",";
    EXPECT_NE(read("half.exr.json").find(rays), std::string::npos) << read("half.exr.json");
    EXPECT_EQ(read("half.exr.json").find("\"beyondHalfPixels\":0,"), std::string::npos);
  }
}

TEST_F(Output, SchemaIsJson) {
  const Outcome outcome = run({"schema"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out.front(), '{');
  EXPECT_NE(outcome.out.find("\"$schema\""), std::string::npos);
}

TEST_F(Output, CheckExplainsAndRendersNothing) {
  write_scene("scene.toml", animation);
  const Outcome outcome = run({"check", "scene.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out, "");
  EXPECT_EQ(run({"check", "-q", "scene.toml"}).out, "");
  EXPECT_EQ(files(), Files{"scene.toml"});
}

}  // namespace
}  // namespace backlight::test
