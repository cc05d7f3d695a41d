// Never lose, never repeat: what is skipped, what is gone on with, and several processes in one folder.
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "backlight/film/exr.h"
#include "program.h"

namespace backlight::test {
namespace {

using Arguments = std::vector<std::string>;
using Files = std::vector<std::string>;

Arguments operator+(Arguments left, const Arguments& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

class Again : public ProgramTest {
 protected:
  void expect_success(const Arguments& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }

  // A file that is written anew is another file: it was renamed into its place.
  [[nodiscard]] ino_t number_of(const std::string& name) const {
    struct stat status {};
    EXPECT_EQ(stat((folder / "work" / name).c_str(), &status), 0) << name;
    return status.st_ino;
  }

  // Whether this command writes scene.exr, where a file is already. The old one is kept under another name
  // meanwhile, since its number might be given to the new one.
  bool writes_again(const Arguments& arguments) {
    const auto path = folder / "work" / "scene.exr";
    std::filesystem::create_hard_link(path, folder / "work" / "old");
    const ino_t before = number_of("scene.exr");
    expect_success(arguments);
    const bool anew = number_of("scene.exr") != before;
    std::filesystem::remove(folder / "work" / "old");
    return anew;
  }

  [[nodiscard]] ExrPicture picture(const std::string& name) const {
    auto picture = read_exr(folder / "work" / name);
    if (!picture.ok()) ADD_FAILURE() << picture.error();
    return std::move(picture).value();
  }

  // Waits for a file, or for a minute.
  void wait_for(const std::string& name) const {
    for (int i = 0; i < 6000 && !exists(name); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_TRUE(exists(name)) << name;
  }

  // Whether a process that start() began has come to its end; finish() tells how.
  [[nodiscard]] static bool has_ended(int process) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process;
  }

  // Waits until the program catches a signal, which would end it before.
  static void wait_until_caught(int process, int signal) {
    while (!has_ended(process)) {
      std::ifstream status("/proc/" + std::to_string(process) + "/status");
      for (std::string line; std::getline(status, line);) {
        if (!line.starts_with("SigCgt:")) continue;
        if ((std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1U) != 0) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  // Asks for snapshots of a.exr until one shows some pixels; nothing if the image is done before. A tile that
  // is not about to be done begins anew after a snapshot: the pauses get longer until one is long enough.
  [[nodiscard]] std::optional<Image> snapshot_in_the_middle(int process) const {
    wait_until_caught(process, SIGUSR1);
    for (int pause = 10; !has_ended(process); pause += 1 + pause / 4) {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause));
      kill(process, SIGUSR1);
      auto read = read_exr(folder / "work" / "a.partial.exr");
      if (!read.ok()) continue;
      Image& image = read.value().image;
      const auto alpha = image.plane(static_cast<std::size_t>(image.find_channel("A")));
      if (std::ranges::count(alpha, 1.0F) > 0) return std::move(image);
    }
    return std::nullopt;
  }

  // How often each file was made, by the lines of --stats.
  [[nodiscard]] std::map<std::string, int> made(const std::string& statistics) const {
    std::map<std::string, int> counts;
    std::ifstream file(folder / "work" / statistics);
    for (std::string line; std::getline(file, line);) {
      const std::size_t begin = line.find("\"file\":\"") + 8;
      ++counts[line.substr(begin, line.find('"', begin) - begin)];
    }
    return counts;
  }
};

using namespace std::chrono_literals;
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
    int done = 0;
    for (std::size_t i = 0; i < partial.image.plane(mask).size(); ++i) {
      EXPECT_EQ(partial.image.plane(alpha)[i], partial.image.plane(mask)[i]);
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

constexpr const char* moving =
    "[animation]\nfps = 10\nframes = [1, 12]\n"
    "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [0, 1, \"3 + t\"]\nvelocity = [0.5, 0, 0]\n";

class Sharing : public Again {
 protected:
  void SetUp() override {
    Again::SetUp();
    write_scene("scene.toml", moving);
    expect_success(job + Arguments{"-o", "right/a.exr"});
  }

  void expect_all_right() const {
    for (int frame = 1; frame <= 12; ++frame) {
      const std::string number = (frame < 10 ? "000" : "00") + std::to_string(frame);
      EXPECT_EQ(read("a." + number + ".exr"), read("right/a." + number + ".exr")) << frame;
    }
    for (const std::string& file : files()) {
      EXPECT_TRUE(file.ends_with(".exr") || file == "scene.toml" || file == "s.json") << file;
    }
  }

  const Arguments job{"scene.toml", "-s", "60", "-t", "1", "-q"};
  const Arguments claim = job + Arguments{"-o", "a.exr", "--claim", "--stats", "s.json"};
};

TEST_F(Sharing, EachImageIsMadeOnce) {
  std::vector<int> processes;
  for (int i = 0; i < 3; ++i) processes.push_back(start(claim, std::to_string(i)));
  for (int i = 0; i < 3; ++i) {
    const Outcome outcome = finish(processes[static_cast<std::size_t>(i)], std::to_string(i));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  const auto counts = made("s.json");
  EXPECT_EQ(counts.size(), 12U);
  for (const auto& [file, count] : counts) EXPECT_EQ(count, 1) << file;
  expect_all_right();
}

TEST_F(Sharing, TheImagesOfAKilledProcessAreTakenOver) {
  // It would take hours for its first image, and is killed for certain before it is done.
  const int victim = start(claim + Arguments{"-s", "1000000"}, "victim");
  wait_for("a.0001.exr.claim");
  const int other = start(claim, "other");
  wait_for("a.0012.exr");
  EXPECT_FALSE(exists("a.0001.exr"));
  kill(victim, SIGKILL);
  EXPECT_EQ(finish(victim, "victim").code, 1000 + SIGKILL);
  const Outcome outcome = finish(other, "other");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto counts = made("s.json");
  EXPECT_EQ(counts.size(), 12U);
  for (const auto& [file, count] : counts) EXPECT_EQ(count, 1) << file;
  expect_all_right();
}

TEST_F(Sharing, AClaimOfAnotherMachineHoldsUntilItExpires) {
  const std::string theirs = "backlight claim\nhost far\nprocess 1\nsince x\nspace y\nstart 5\nnumber 0\n";
  write("a.0003.exr.claim", theirs);
  const int process = start(claim, "waiting");
  wait_for("a.0012.exr");
  std::this_thread::sleep_for(300ms);
  EXPECT_FALSE(exists("a.0003.exr"));
  kill(process, SIGTERM);
  const Outcome stopped = finish(process, "waiting");
  EXPECT_EQ(stopped.code, 128 + SIGTERM) << stopped.err;
  EXPECT_EQ(read("a.0003.exr.claim"), theirs);

  std::this_thread::sleep_for(2100ms);
  expect_success(claim + Arguments{"--claim-expires", "1"});
  for (const auto& [file, count] : made("s.json")) EXPECT_EQ(count, 1) << file;
  expect_all_right();
}

TEST_F(Sharing, WithoutClaimsEveryImageIsWholeAllTheSame) {
  const Arguments alone = job + Arguments{"-o", "a.exr", "--skip-existing"};
  const int one = start(alone, "one");
  const int two = start(alone, "two");
  EXPECT_EQ(finish(one, "one").code, 0);
  EXPECT_EQ(finish(two, "two").code, 0);
  expect_all_right();
}

// scripts/soak.sh does this for as long as one likes. How long to wait before a kill, so that there is a
// middle to kill in, is found by trying: longer after a process that had not begun, shorter after one that
// was done.
TEST_F(Sharing, KillsAtAnyMomentLoseNothing) {
  std::mt19937 random(20261124);
  const Arguments run_on = claim + Arguments{"--resume"};
  const std::set<int> signals{SIGKILL, SIGTERM, SIGHUP};
  const auto expect_each_once = [&] {
    for (const auto& [file, count] : made("s.json")) EXPECT_EQ(count, 1) << file;
    expect_all_right();
  };
  const auto begin_again = [&] {
    for (const std::string& file : files()) {
      if (file.starts_with("a.") || file == "s.json") std::filesystem::remove(folder / "work" / file);
    }
  };
  int in_the_middle = 0;
  unsigned longest = 100'000;  // microseconds
  for (int i = 0; i < 100 && in_the_middle < 8; ++i) {
    const Files before = files();
    const int process = start(run_on, "killed");
    std::this_thread::sleep_for(std::chrono::microseconds(random() % longest));
    kill(process, *std::next(signals.begin(), static_cast<int>(random() % 3)));
    const int code = finish(process, "killed").code;
    if (code == 0) {
      expect_each_once();
      begin_again();
      longest = std::max(longest / 2, 1000U);
      continue;
    }
    EXPECT_TRUE(code == 1000 + SIGKILL || code == 128 + SIGTERM || code == 128 + SIGHUP ||
                code == 1000 + SIGTERM || code == 1000 + SIGHUP)  // before it catches signals
        << code;
    if (files() == before) {
      longest = std::min(longest * 2, 10'000'000U);
    } else {
      ++in_the_middle;
    }
  }
  EXPECT_EQ(in_the_middle, 8);
  expect_success(run_on);
  expect_each_once();
}

TEST_F(Sharing, AFullDiskStopsItAndNothingIsLost) {
  in_child = [] {
    const rlimit limit{3000, 3000};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  const Arguments big = claim + Arguments{"--float", "--aov", "all"};
  const Outcome full = run(big);
  in_child = nullptr;
  EXPECT_EQ(full.code, 4);
  EXPECT_NE(full.err.find("a.0001.exr"), std::string::npos) << full.err;
  EXPECT_FALSE(exists("a.0001.exr"));
  EXPECT_FALSE(exists("a.0001.exr.claim"));
  expect_success(job + Arguments{"--float", "--aov", "all", "-o", "right/a.exr"});
  expect_success(big);
  expect_all_right();
}

}  // namespace
}  // namespace backlight::test
