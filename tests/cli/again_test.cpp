// Never lose, never repeat: what is skipped, and what is gone on with.
#include "again.h"

#include <half.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

namespace backlight::test {
namespace {

const Arguments skip{"scene.toml", "--skip-existing"};

TEST_F(Again, SkipsWhatIsMadeFromTheSame) {
  write_scene();
  expect_success(skip);
  const Outcome outcome = run(skip);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("scene.exr  is complete: skipped"), std::string::npos) << outcome.err;
  EXPECT_FALSE(writes_again(skip));
  EXPECT_FALSE(writes_again(skip + Arguments{"-t", "3", "-q"}));
  EXPECT_FALSE(writes_again({"--no-clobber", "scene.toml"}));
  EXPECT_FALSE(writes_again(skip + Arguments{"-r", "32x20"}));  // what the scene says too
  EXPECT_TRUE(writes_again({"scene.toml"}));
}

TEST_F(Again, EverySettingCounts) {
  write_scene();
  for (const Arguments& change : std::vector<Arguments>{{"-D", "camera.fov=50"},
                                                        {"-r", "33x20"},
                                                        {"-s", "2"},
                                                        {"--seed", "5"},
                                                        {"--crop", "1,1,9,9"},
                                                        {"--aov", "Z"},
                                                        {"--float"},
                                                        {"--time", "1"}}) {
    expect_success({"scene.toml"});
    EXPECT_TRUE(writes_again(skip + change)) << change[0];
    EXPECT_FALSE(writes_again(skip + change)) << change[0];
    EXPECT_TRUE(writes_again(skip)) << change[0];
  }
}

TEST_F(Again, EveryFileCounts) {
  const std::string stars = "right_ascension,declination,magnitude,b_minus_v\n";
  write("scene.toml",
        "include = [\"more.toml\"]\n[background]\nstars = \"stars.csv\"\n[camera]\n[film]\nresolution = [8, "
        "8]\n"
        "[material.m]\nspectrum = \"s.csv\"\n[[object]]\nshape = \"disk\"\nradius = 1\nmaterial = \"m\"\n");
  write("more.toml", "[[light]]\ntype = \"ambient\"\nradiance = 1\n");
  write("stars.csv", stars + "1,2,3,0.5\n");
  write("s.csv", "400,0.5\n700,0.6\n");
  expect_success(skip);
  EXPECT_FALSE(writes_again(skip));
  write("more.toml", "[[light]]\ntype = \"ambient\"\nradiance = 2\n");
  EXPECT_TRUE(writes_again(skip));
  write("stars.csv", stars + "1,2,3,0.6\n");
  EXPECT_TRUE(writes_again(skip));
  write("s.csv", "400,0.5\n700,0.7\n");
  EXPECT_TRUE(writes_again(skip));
  EXPECT_FALSE(writes_again(skip));
}

TEST_F(Again, WhatIsNotWholeIsMadeAgain) {
  write_scene();
  expect_success({"scene.toml", "-o", "right.exr"});
  const std::string right = read("right.exr");
  for (const std::string& wrong : {right.substr(0, right.size() - 1), right.substr(0, 200), std::string(),
                                   std::string("not an image at all")}) {
    write("scene.exr", wrong);
    EXPECT_TRUE(writes_again(skip)) << wrong.size();
    EXPECT_EQ(read("scene.exr"), right);
  }
}

TEST_F(Again, AMissingPngIsMadeFromTheImage) {
  write_scene();
  expect_success({"scene.toml", "--png"});
  const std::string png = read("scene.png");
  std::filesystem::remove(folder / "work" / "scene.png");
  EXPECT_FALSE(writes_again(skip + Arguments{"--png"}));
  EXPECT_EQ(read("scene.png"), png);
}

TEST_F(Again, DryRunsTellWhatWouldBeSkipped) {
  write_scene("scene.toml", "[animation]\nframes = [1, 3]\n");
  expect_success({"scene.toml", "-f", "2"});
  const Outcome files = run({"scene.toml", "--dry-run", "--skip-existing"});
  EXPECT_EQ(files.out, "scene.0001.exr\nscene.0003.exr\n");
  EXPECT_EQ(files.err, "scene.0002.exr  is complete: would be skipped\n");
  EXPECT_EQ(run({"scene.toml", "--list-frames", "--resume"}).out, "1\tscene.0001.exr\n3\tscene.0003.exr\n");
}

TEST_F(Again, StatisticsGoOn) {
  write_scene("scene.toml", "[animation]\nframes = [1, 3]\n");
  expect_success({"scene.toml", "-f", "2", "--stats", "s.json"});
  expect_success(skip + Arguments{"--stats", "s.json"});
  EXPECT_EQ(made("s.json"), (std::map<std::string, int>{
                                {"scene.0001.exr", 1}, {"scene.0002.exr", 1}, {"scene.0003.exr", 1}}));
}

// One image that takes a moment, with everything that a partial image must keep.
const Arguments slow{"scene.toml", "-r", "32x24", "--aov", "all", "-t", "2", "-q"};
constexpr const char* stereo_and_motion =
    "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [0, 1, 3]\nvelocity = [0.6, 0.2, 0]\n";

// On a quick machine an image may be done before one can look at its middle: then one of more samples is
// tried, up to these.
constexpr int few_samples = 1500;
constexpr int most_samples = 200'000;

TEST_F(Again, APartialImageIsFinishedToTheSameBytes) {
  write_scene("scene.toml", stereo_and_motion);
  for (const Arguments& kind :
       std::vector<Arguments>{{}, {"--float", "-D", "camera.stereo={separation=0.1}"}}) {
    Arguments job;
    int samples = few_samples;
    for (;; samples *= 2) {
      ASSERT_LT(samples, most_samples) << "no image could be stopped in its middle";
      job = slow + kind + Arguments{"-s", std::to_string(samples)};
      const Outcome stopped = run_and(job + Arguments{"-o", "a.exr"}, [&](int process) {
        if (snapshot_in_the_middle(process)) kill(process, SIGTERM);
      });
      if (stopped.code == 128 + SIGTERM) break;
      ASSERT_EQ(stopped.code, 0) << stopped.err;
      std::filesystem::remove(folder / "work" / "a.exr");
    }
    ASSERT_FALSE(exists("a.exr"));
    expect_success(job + Arguments{"-o", "whole.exr"});
    const ExrPicture partial = picture("a.partial.exr");
    EXPECT_EQ(*partial.header.find<std::int32_t>("backlight/complete"), 0);
    const std::string left = kind.empty() ? "rendered.V" : "rendered.left.V";
    const auto mask = static_cast<std::size_t>(partial.image.find_channel(left));
    const auto alpha = static_cast<std::size_t>(partial.image.find_channel("A"));
    // Alpha is 0 too where the image is empty: the mask alone tells what is missing.
    const Image whole = picture("whole.exr").image;
    const auto whole_alpha = whole.plane(static_cast<std::size_t>(whole.find_channel("A")));
    int done = 0;
    for (std::size_t i = 0; i < partial.image.plane(mask).size(); ++i) {
      const bool is_done = partial.image.plane(mask)[i] == 1.0F;
      const float expected = is_done ? whole_alpha[i] : 0.0F;  // rounded, where colour is stored as half
      EXPECT_EQ(half(partial.image.plane(alpha)[i]).bits(), half(expected).bits());
      done += partial.image.plane(mask)[i] == 1.0F ? 1 : 0;
    }
    EXPECT_GT(done, 0);
    EXPECT_LT(done, 32 * 24);
    // The work that was done is not done again.
    expect_success(job + Arguments{"-o", "a.exr", "--resume", "--stats", "s.json", "-t", "1"});
    EXPECT_EQ(read("a.exr"), read("whole.exr"));
    EXPECT_FALSE(exists("a.partial.exr"));
    const std::string line = read("s.json");
    const std::size_t at = line.find("\"cameraRays\":") + 13;
    const long rays = std::stol(line.substr(at));
    EXPECT_EQ(rays % samples, 0);
    EXPECT_LT(rays, 32L * 24L * samples * (kind.empty() ? 1 : 2));
    for (const char* name : {"s.json", "a.exr"}) std::filesystem::remove(folder / "work" / name);
  }
}

TEST_F(Again, ASnapshotIsWrittenAndTheImageFinished) {
  write_scene("scene.toml", stereo_and_motion);
  std::optional<Image> taken;
  Arguments job;
  for (int samples = few_samples; !taken; samples *= 2) {
    ASSERT_LT(samples, most_samples) << "no image could be looked at in its middle";
    job = slow + Arguments{"-s", std::to_string(samples)};
    const Outcome outcome = run_and(job + Arguments{"-o", "a.exr"}, [&](int process) {
      taken = snapshot_in_the_middle(process);
      if (taken) kill(process, SIGUSR1);
    });
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const Image& snapshot = *taken;
  expect_success(job + Arguments{"-o", "whole.exr"});
  EXPECT_EQ(read("a.exr"), read("whole.exr"));
  EXPECT_EQ(files(), (Files{"a.exr", "scene.toml", "whole.exr"}));
  // What it shows is final.
  const Image whole = picture("whole.exr").image;
  const auto mask = static_cast<std::size_t>(snapshot.find_channel("rendered.V"));
  const auto seen = static_cast<std::size_t>(snapshot.find_channel("Z"));
  const auto final = static_cast<std::size_t>(whole.find_channel("Z"));
  for (std::size_t i = 0; i < snapshot.plane(mask).size(); ++i) {
    if (snapshot.plane(mask)[i] == 1.0F) {
      EXPECT_EQ(snapshot.plane(seen)[i], whole.plane(final)[i]);
    }
  }
}

TEST_F(Again, APartialImageOfSomethingElseIsNotGoneOnWith) {
  write_scene();
  const Outcome stopped = run_and(slow + Arguments{"-o", "a.exr", "-s", "1000000"}, [&](int process) {
    wait_until_caught(process, SIGUSR1);
    kill(process, SIGUSR1);
    wait_for("a.partial.exr");
    kill(process, SIGINT);
  });
  ASSERT_EQ(stopped.code, 128 + SIGINT);
  const std::string partial = read("a.partial.exr");
  for (const std::string& file : {partial, partial.substr(0, partial.size() / 2)}) {
    write("a.partial.exr", file);
    const Outcome outcome = run({"scene.toml", "-o", "a.exr", "--resume"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("a.partial.exr"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("beginning anew"), std::string::npos) << outcome.err;
    expect_success({"scene.toml", "-o", "right.exr"});
    EXPECT_EQ(read("a.exr"), read("right.exr"));
    EXPECT_EQ(read("a.partial.exr"), file);  // it is another image's: not ours to remove
    std::filesystem::remove(folder / "work" / "a.exr");
  }
}

}  // namespace
}  // namespace backlight::test
