// Several processes in one folder, and processes that are killed.
#include "again.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <sstream>
#include <thread>

namespace backlight::test {
namespace {

using namespace std::chrono_literals;

constexpr const char* moving =
    "[animation]\nfps = 10\nframes = [1, 12]\n"
    "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [0, 1, \"3 + image_time\"]\nvelocity = [0.5, "
    "0, 0]\n";

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

  expect_success(claim + Arguments{"--claim-expires", "1"});
  for (const auto& [file, count] : made("s.json")) EXPECT_EQ(count, 1) << file;
  expect_all_right();
}

// What a power cut, a clock that is an hour ahead, and a machine that is gone leave behind.
TEST_F(Sharing, ClaimsThatNobodyRenewsAreTakenOver) {
  write("a.0003.exr.claim", "");
  write("a.0004.exr.claim", "backlight claim\nhost far\nprocess 1\nsince x\nspace y\nstart 5\nnumber 0\n");
  std::filesystem::last_write_time(folder / "work" / "a.0004.exr.claim",
                                   std::filesystem::file_time_type::clock::now() + 1h);
  expect_success(claim + Arguments{"--claim-expires", "0.4"});
  for (const auto& [file, count] : made("s.json")) EXPECT_EQ(count, 1) << file;
  expect_all_right();
}

// It is stopped with a claim, another takes the image over, and it comes back: the image is made once.
TEST_F(Sharing, AProcessThatComesBackFindsItsClaimGone) {
  const Arguments brief = claim + Arguments{"--claim-expires", "0.4"};
  const int sleeper = start(brief + Arguments{"-s", "20000"}, "sleeper");
  wait_for("a.0001.exr.claim");
  kill(sleeper, SIGSTOP);
  expect_success(brief);
  expect_all_right();
  kill(sleeper, SIGCONT);
  std::this_thread::sleep_for(50ms);
  kill(sleeper, SIGTERM);
  EXPECT_EQ(finish(sleeper, "sleeper").code, 128 + SIGTERM);
  // Not even a partial image, which nobody would finish.
  expect_all_right();
  for (const auto& [file, count] : made("s.json")) EXPECT_EQ(count, 1) << file;
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

// The template of docs/farm.md, with the frames as managers put them in: tasks of a few images each, one of
// them tried twice.
TEST_F(Sharing, TheCommandForOtherManagersRuns) {
  std::ifstream page(BACKLIGHT_SOURCE_DIR "/docs/farm.md");
  const std::string begin = "backlight render /shared/shot.toml -o /shared/frames/shot.####.exr ";
  std::string line;
  while (std::getline(page, line) && !line.starts_with(begin + "-f FRAMES")) {
  }
  ASSERT_TRUE(page) << "the template is gone";
  std::istringstream words(line.substr(begin.size()));
  const Arguments options{std::istream_iterator<std::string>(words), {}};
  for (const char* frames : {"1-4", "5-8", "1-4", "9-12"}) {
    Arguments task{"render", "scene.toml", "-o", "a.####.exr"};
    for (const std::string& option : options) task.push_back(option == "FRAMES" ? frames : option);
    expect_success(task + Arguments{"-s", "60", "-t", "1"});
  }
  expect_all_right();
}

}  // namespace
}  // namespace backlight::test
