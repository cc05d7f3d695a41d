// Every call to the system that a small animation makes fails in turn, and every piece of memory that it asks
// for: support/misfortune.cpp. Whatever fails, the exit status and a message say so, no image is there that
// is not whole and right, nothing else is left, and the same command again makes what is missing.
//
// There are some thousand requests for memory: here 40 of them are refused, spread evenly, and all of them
// where BACKLIGHT_EVERY_MISFORTUNE is set (scripts/night.sh).
#include <signal.h>
#include <stdlib.h>

#include <cerrno>
#include <set>
#include <string>

#include "again.h"

namespace backlight::test {
namespace {

namespace fs = std::filesystem;

class Misfortune : public Again {
 protected:
  // One image is there of another scene, and is to be replaced; the other is there in part.
  void SetUp() override {
    if (is_sanitized) GTEST_SKIP() << "sanitizers replace the same functions";
    Again::SetUp();
    write_scene("scene.toml", "[animation]\nframes = [1, 2]\n");
    expect_success(job + Arguments{"-o", "right/a.exr"});
    expect_success(job + Arguments{"-o", "before/a.exr", "-f", "2", "--seed", "7"});
    make_partial();
  }

  void make_partial() {
    // Tracing begins some milliseconds after the signal is caught, and is over soon.
    for (int i = 0; i < 400 && !exists("before/a.0001.partial.exr"); ++i) {
      const int process = start(job + Arguments{"-f", "1", "-o", "before/a.exr"}, "stopped");
      wait_until_caught(process, SIGTERM);
      std::this_thread::sleep_for(std::chrono::microseconds(100 * i));
      kill(process, SIGTERM);
      finish(process, "stopped");
      fs::remove(folder / "work/before/a.0001.exr");
    }
    ASSERT_TRUE(exists("before/a.0001.partial.exr"));
  }

  void prepare() const {
    fs::remove_all(folder / "work/out");
    fs::remove(folder / "work/s.json");
    fs::copy(folder / "work/before", folder / "work/out");
  }

  Outcome run_with(const std::string& what) {
    std::vector<std::string> environment{"LD_PRELOAD=" BACKLIGHT_MISFORTUNE};
    if (!what.empty()) environment.push_back(what);
    return run(claim, environment);
  }

  // How many calls of a kind there are when nothing fails.
  long count(const std::string& kind) {
    prepare();
    const Outcome outcome = run_with("MISFORTUNE_COUNTS=" + (folder / "counts").string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::ifstream counts(folder / "counts");
    std::string name;
    long number = 0;
    while (counts >> name >> number && name != kind) {
    }
    EXPECT_EQ(name, kind);
    return number;
  }

  void expect_right(const std::string& file, bool may_be_as_before) const {
    const std::string bytes = read("out/" + file);
    const bool as_before = may_be_as_before && bytes == read("before/" + file);
    EXPECT_TRUE(as_before || bytes == read("right/" + file)) << file;
  }

  // `may_leave`: what cannot be removed stays.
  void expect_nothing_else(bool may_leave, bool complete) const {
    for (const std::string& path : files()) {
      if (!path.starts_with("out/")) continue;
      const std::string file = path.substr(4);
      const bool image = file == "a.0001.exr" || file == "a.0002.exr";
      const bool partial = file == "a.0001.partial.exr" && !complete;
      EXPECT_TRUE(image || partial || may_leave) << "left behind: " << file;
    }
  }

  void expect_told(const Outcome& outcome) const {
    if (outcome.code != 0) {
      EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
      return;
    }
    expect_right("a.0001.exr", false);
    expect_right("a.0002.exr", false);
    EXPECT_EQ(made("s.json").size(), 2U);
  }

  void fail_one(const std::string& kind, long number, const std::string& how, const std::set<int>& codes) {
    const std::string what = "MISFORTUNE=" + kind + ":" + std::to_string(number) + ":" + how;
    SCOPED_TRACE(what);
    prepare();
    const Outcome outcome = run_with(what);
    EXPECT_TRUE(codes.contains(outcome.code)) << outcome.code << ": " << outcome.err;
    expect_told(outcome);
    const bool may_leave = kind == "unlink" || kind == "rename";
    if (exists("out/a.0001.exr")) expect_right("a.0001.exr", false);
    if (fs::exists(folder / "work/out")) expect_right("a.0002.exr", true);
    expect_nothing_else(may_leave, false);
    const Outcome again = run(claim);
    EXPECT_EQ(again.code, 0) << again.err;
    expect_right("a.0001.exr", false);
    expect_right("a.0002.exr", false);
    expect_nothing_else(may_leave, true);
  }

  void fail_each(const std::string& kind, int error_number, const std::set<int>& codes, long most = 0) {
    if (getenv("BACKLIGHT_EVERY_MISFORTUNE") != nullptr) most = 0;
    const long all = count(kind);
    if (all == 0 && kind == "memory") GTEST_SKIP() << "something else replaces malloc()";
    ASSERT_GT(all, 0);
    const long tries = most > 0 ? std::min(most, all) : all;
    for (long i = 0; i < tries && !HasFailure(); ++i)
      fail_one(kind, 1 + i * all / tries, std::to_string(error_number), codes);
  }

  const Arguments job{"scene.toml", "-r", "16x12", "-s", "500", "-t", "2", "-q"};
  const Arguments claim =
      job + Arguments{"-o", "out/a.exr", "--claim", "--resume", "--stats", "s.json", "--claim-expires", "1"};
};

TEST_F(Misfortune, OpenFails) {
  fail_each("open", EIO, {0, 4});
}
TEST_F(Misfortune, OpenFailsForWantOfDescriptors) {
  fail_each("open", EMFILE, {0, 4});
}
TEST_F(Misfortune, ReadFails) {
  fail_each("read", EIO, {0, 4});
}
TEST_F(Misfortune, WriteFails) {
  fail_each("write", ENOSPC, {4});
}
TEST_F(Misfortune, CloseFails) {
  fail_each("close", EIO, {0, 4});
}
TEST_F(Misfortune, FsyncFails) {
  fail_each("fsync", EDQUOT, {4});
}
TEST_F(Misfortune, RenameFails) {
  fail_each("rename", EIO, {4});
}
TEST_F(Misfortune, LinkFails) {
  fail_each("link", EIO, {0, 4});  // of an image that replaces another, the first is only tried
}
TEST_F(Misfortune, UnlinkFails) {
  fail_each("unlink", EIO, {0});
}
TEST_F(Misfortune, StatFails) {
  fail_each("stat", EIO, {0, 4});
}
TEST_F(Misfortune, MkdirFails) {
  fs::remove_all(folder / "work/before");
  fs::create_directory(folder / "work/before");
  for (const int error_number : {EIO, ENOSPC}) {
    fs::remove_all(folder / "work/out");
    const Outcome outcome = run_with("MISFORTUNE=mkdir:1:" + std::to_string(error_number));
    EXPECT_EQ(outcome.code, 4);
    EXPECT_FALSE(exists("out"));
  }
}
TEST_F(Misfortune, ThreadFails) {
  fail_each("thread", EAGAIN, {0, 1});
}
TEST_F(Misfortune, MemoryFails) {
  fail_each("memory", ENOMEM, {0, 1}, 40);
}

// A signal in between, a disk that takes a part: no reason to give up.
TEST_F(Misfortune, CallsAreInterrupted) {
  for (const char* kind : {"open", "read", "write", "fsync"}) fail_each(kind, EINTR, {0});
}
TEST_F(Misfortune, WritesAreShort) {
  fail_each("write", 0, {0});
}

}  // namespace
}  // namespace backlight::test
