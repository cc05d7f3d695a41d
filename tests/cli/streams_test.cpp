// What the shell may have done with the standard streams and the signals before the program begins, and what
// it may be denied.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "again.h"

namespace backlight::test {
namespace {

class Streams : public Again {
 protected:
  void SetUp() override {
    Again::SetUp();
    write_scene("scene.toml", "[animation]\nframes = [1, 3]\n");
    expect_success(job + Arguments{"-o", "right/a.exr"});
  }

  // Descriptors of the program that are pipes whose reader has gone away, as `| head -0` leaves them.
  void with_broken_pipes(const std::vector<int>& descriptors) {
    in_child = [descriptors] {
      int ends[2];
      if (pipe(ends) != 0) _exit(126);
      for (const int descriptor : descriptors) dup2(ends[1], descriptor);
      close(ends[0]);
      close(ends[1]);
      signal(SIGPIPE, SIG_DFL);
    };
  }
  void with_closed(const std::vector<int>& descriptors) {
    in_child = [descriptors] {
      for (const int descriptor : descriptors) close(descriptor);
    };
  }

  void expect_images_and_nothing_else(const Files& besides = {}) const {
    Files expected{"scene.toml"};
    for (const std::string number : {"0001", "0002", "0003"}) {
      EXPECT_EQ(read("a." + number + ".exr"), read("right/a." + number + ".exr"));
      expected.push_back("a." + number + ".exr");
      expected.push_back("right/a." + number + ".exr");
    }
    expected.insert(expected.end(), besides.begin(), besides.end());
    std::ranges::sort(expected);
    EXPECT_EQ(files(), expected);
  }

  void remove_images() const {
    for (const char* name : {"a.0001.exr", "a.0002.exr", "a.0003.exr"})
      std::filesystem::remove(folder / "work" / name);
  }

  // Environment that loads what lets things go wrong.
  static std::vector<std::string> misfortune(const std::string& what) {
    return {"LD_PRELOAD=" BACKLIGHT_MISFORTUNE, what};
  }

  const Arguments job{"scene.toml", "-t", "2"};
  const Arguments claim = job + Arguments{"-o", "a.exr", "--claim"};
};

TEST_F(Streams, ProgressThatNobodyReadsIsNoReasonToStop) {
  for (const char* progress : {"lines", "json", "bar"}) {
    with_broken_pipes({STDERR_FILENO});
    EXPECT_EQ(run(claim + Arguments{"--progress", progress, "-v"}).code, 0);
    expect_images_and_nothing_else();
    remove_images();
  }
}

TEST_F(Streams, StatisticsThatAreLostAreAnErrorAtTheEnd) {
  for (const char* where : {"-", "/dev/stdout"}) {
    with_broken_pipes({STDOUT_FILENO});
    const Outcome outcome = run(claim + Arguments{"--progress", "none", "-q", "--stats", where});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_EQ(outcome.err, std::string("backlight: error: cannot write ") +
                               (where[0] == '-' ? "standard output" : where) +
                               ": Broken pipe; the images are made all the same\n");
    expect_images_and_nothing_else();
    remove_images();
  }
}

TEST_F(Streams, WhatIsOnlyPrintedEndsAsOtherProgramsDo) {
  for (const Arguments& printed :
       {Arguments{"schema"}, {"check", "scene.toml"}, job + Arguments{"--dry-run"}}) {
    with_broken_pipes({STDOUT_FILENO});
    const Outcome outcome = run(printed);
    EXPECT_EQ(outcome.code, 1000 + SIGPIPE);
    EXPECT_EQ(outcome.err, "");
  }
}

// An image that is opened must not get the number of a stream, or the program would write its words into it.
TEST_F(Streams, ThatAreClosedStayClosed) {
  for (const std::vector<int>& closed :
       {std::vector<int>{STDERR_FILENO}, {STDOUT_FILENO}, {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}}) {
    with_closed(closed);
    EXPECT_EQ(run(claim + Arguments{"--progress", "json", "-v", "--float", "--aov", "all"}).code, 0);
    in_child = nullptr;
    expect_success(job + Arguments{"--float", "--aov", "all", "-o", "float/a.exr"});
    for (int i = 1; i <= 3; ++i) {
      const std::string name = "a.000" + std::to_string(i) + ".exr";
      EXPECT_EQ(read(name), read("float/" + name));
      std::filesystem::remove(folder / "work" / name);
    }
  }
  with_closed({STDOUT_FILENO});
  EXPECT_EQ(run({"schema"}).code, 4);
  EXPECT_EQ(run(job + Arguments{"-o", "a.exr", "--stats", "-"}).code, 4);
  EXPECT_EQ(run(job + Arguments{"-o", "a.exr", "--stats", "/dev/stdout"}).code, 4);
}

// The signals come while the program is being loaded, long before it can look at its arguments.
TEST_F(Streams, SignalsThatComeAtOnceAreAnsweredLikeOthers) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers replace the same functions";
  Outcome outcome = run(claim, misfortune("MISFORTUNE_SIGNAL=" + std::to_string(SIGUSR1)));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_images_and_nothing_else();
  remove_images();
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    outcome = run(claim, misfortune("MISFORTUNE_SIGNAL=" + std::to_string(number)));
    EXPECT_EQ(outcome.code, 128 + number) << outcome.err;
    EXPECT_EQ(files().size(), 4U);
    in_child = [number] { signal(number, SIG_IGN); };
    outcome =
        run(job + Arguments{"-o", "right/a.exr"}, misfortune("MISFORTUNE_SIGNAL=" + std::to_string(number)));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    in_child = nullptr;
  }
  outcome = run({"schema"}, misfortune("MISFORTUNE_SIGNAL=" + std::to_string(SIGTERM)));
  EXPECT_EQ(outcome.code, 1000 + SIGTERM);
}

// Limits on processes (`ulimit -u`, a batch system's cgroup): from the N-th on, no thread can be begun.
TEST_F(Streams, ThreadsThatCannotBeBegunAreDoneWithout) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers replace the same functions";
  const std::string why = "Resource temporarily unavailable";
  for (int there = 0; there <= 6; ++there) {
    const std::string call = "MISFORTUNE=thread:" + std::to_string(there + 1) + "+:" + std::to_string(EAGAIN);
    const Outcome outcome = run(job + Arguments{"-t", "3", "-o", "a.exr", "-q"}, misfortune(call));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string told = "backlight: warning: " + std::to_string(std::max(there, 1)) +
                             " of 3 threads could be begun: " + why + "\n";
    EXPECT_EQ(outcome.err, there < 3 ? told : "");
    expect_images_and_nothing_else();
    const Outcome claiming = run(claim + Arguments{"-q"}, misfortune(call));
    EXPECT_EQ(claiming.code, there == 0 ? 1 : 0) << claiming.err;
    if (there == 0) {
      EXPECT_EQ(claiming.err, "backlight: error: cannot begin the thread that renews claims: " + why +
                                  "; without --claim none is needed\n");
    }
    expect_images_and_nothing_else();
  }
}

}  // namespace
}  // namespace backlight::test
