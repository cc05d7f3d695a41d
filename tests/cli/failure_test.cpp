// When things go wrong: the exit code, the message, and that nothing half-written stays behind.
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "program.h"

namespace backlight::test {
namespace {

using Files = std::vector<std::string>;

class FailureTest : public ProgramTest {
 protected:
  // Most test machines in containers run as root, whom no permission stops: the program then runs as a root
  // without that privilege. (Not as another user, who may not be allowed to run a program of root's.)
  void as_ordinary_user() {
    if (geteuid() != 0) return;
    in_child = [] {
      for (const unsigned privilege : {unsigned{CAP_DAC_OVERRIDE}, unsigned{CAP_DAC_READ_SEARCH}}) {
        if (prctl(PR_CAPBSET_DROP, privilege, 0, 0, 0) != 0) _exit(126);
      }
    };
  }

  // A picture that takes hours, and each of its tiles many seconds.
  void write_slow_scene() { write_scene("slow.toml"); }
  const std::vector<std::string> slow{"slow.toml", "-r", "1500x1500", "-s",          "2000",
                                      "-t",        "2",  "-o",        "out/slow.exr"};

  // Waits until the picture is being traced: its folder has been made.
  void wait_until_rendering() const {
    for (int i = 0; i < 1000 && !exists("out"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
};

TEST_F(FailureTest, MissingSceneIsFileTrouble) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"none.toml"},
                                                    {"check", "none.toml"},
                                                    {"render", "none.toml", "--dry-run"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("none.toml"), std::string::npos) << outcome.err;
  }
}

TEST_F(FailureTest, FilesWithoutAnEndAreNotRead) {
  ASSERT_EQ(mkfifo((folder / "work" / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(run({"check", "/dev/zero"}).code, 4);
  EXPECT_EQ(run({"check", "/dev/full"}).code, 4);
  EXPECT_EQ(run({"check", "pipe"}).code, 3);  // nobody writes to it: it is empty, and has no camera
  for (const char* command : {"info", "view"}) {
    for (const char* file : {"/dev/zero", "pipe", "."}) {
      const Outcome outcome = run({command, file});
      EXPECT_EQ(outcome.code, 4) << command << ' ' << file << outcome.err;
      EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
    }
  }
  EXPECT_EQ(run({"compare", "/dev/zero", "pipe"}).code, 2);
  EXPECT_EQ(run({"assemble", "/dev/zero", "pipe", "-o", "whole.exr"}).code, 4);
}

TEST_F(FailureTest, AnImageBeyondTheMemoryIsRefusedWithWhatToDo) {
  write_scene();
  const Outcome outcome =
      run({"scene.toml", "-r", "65536x65536", "-s", "4", "--aov", "all", "-o", "big.exr"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  for (const char* words : {"an image of 65536x65536 pixels with 24 channels takes 388 GiB of memory",
                            "--crop 0,0,65536,", "--aov none", "backlight assemble", "big.exr"}) {
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << '\n' << outcome.err;
  }
  EXPECT_FALSE(exists("big.exr"));
  EXPECT_LT(outcome.seconds, 10.0);
}

TEST_F(FailureTest, CheckTellsTheMemoryThatRenderingTakes) {
  write_scene("copies.toml",
              "[[object]]\nshape = \"sphere\"\nradius = 0.1\nrepeat = { count = [500, 100, 100], step = [1, "
              "1, 1] }\n");
  const Outcome outcome = run({"check", "copies.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("5000001"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("4.2 GiB for the surfaces"), std::string::npos) << outcome.out;
  EXPECT_LT(outcome.seconds, 10.0);
}

TEST_F(FailureTest, FolderInsteadOfASceneIsFileTrouble) {
  std::filesystem::create_directory(folder / "work" / "dir");
  EXPECT_EQ(run({"dir"}).code, 4);
}

TEST_F(FailureTest, MissingImageIsFileTrouble) {
  for (const char* command : {"info", "view"}) {
    const Outcome outcome = run({command, "none.exr"});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_NE(outcome.err.find("none.exr"), std::string::npos) << outcome.err;
  }
  write("broken.exr", "this is not an OpenEXR file");
  EXPECT_EQ(run({"info", "broken.exr"}).code, 4);
  EXPECT_EQ(run({"view", "broken.exr"}).code, 4);
  EXPECT_EQ(files(), Files{"broken.exr"});
}

TEST_F(FailureTest, WrongSceneIsToldAndNotRendered) {
  write_scene("scene.toml", "[[object]]\nshape = \"spere\"\n[[object]]\nshape = \"box\"\nsise = [1, 1, 1]\n");
  for (const char* command : {"render", "check"}) {
    const Outcome outcome = run({command, "scene.toml"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_NE(outcome.err.find("scene.toml:16:"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("sphere"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("scene.toml:19:"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("3 errors\n"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(files(), Files{"scene.toml"});
}

TEST_F(FailureTest, WrongTomlIsAWrongScene) {
  write("scene.toml", "c = = 1\n");
  const Outcome outcome = run({"scene.toml"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("scene.toml:1:"), std::string::npos) << outcome.err;
}

TEST_F(FailureTest, WrongOverrideIsAWrongScene) {
  write_scene();
  const Outcome outcome = run({"scene.toml", "-D", "camera.fof=40"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("fov"), std::string::npos) << outcome.err;
}

TEST_F(FailureTest, UnknownCameraIsAWrongScene) {
  write_scene();
  EXPECT_EQ(run({"scene.toml", "--camera", "nobody"}).code, 3);
}

TEST_F(FailureTest, FrameThatCannotBeLeavesTheOthers) {
  // At frame 3, t = 2 and the object would be as fast as light.
  write_scene("scene.toml",
              "[animation]\nfps = 1\nframes = [1, 4]\n"
              "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nvelocity = [\"0.5*image_time - 2*max(0, "
              "image_time - 2)\", 0, 0]\n");
  const Outcome outcome = run({"scene.toml"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_EQ(files(), (Files{"scene.0001.exr", "scene.0002.exr", "scene.0004.exr", "scene.toml"}));
  EXPECT_EQ(run({"check", "scene.toml"}).code, 3);
}

TEST_F(FailureTest, UnwritableFolderIsFoundBeforeRendering) {
  write_slow_scene();
  std::filesystem::create_directory(folder / "work" / "out");
  std::filesystem::permissions(folder / "work" / "out", std::filesystem::perms(0555));
  as_ordinary_user();
  const Outcome outcome = run(slow);
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("out/slow.exr"), std::string::npos) << outcome.err;
  EXPECT_LT(outcome.seconds, 10.0);
  EXPECT_EQ(files(), Files{"slow.toml"});
}

// Where nothing is to be done, nothing needs to be written.
TEST_F(FailureTest, AReadOnlyFolderOfCompleteImagesIsNoTrouble) {
  write_scene("scene.toml", "[animation]\nframes = [1, 3]\n");
  const std::vector<std::string> job{"scene.toml", "-o", "out/a.exr", "--png", "--stats", "out/s.json"};
  ASSERT_EQ(run(job).code, 0);
  write("out/a.0002.exr.claim", "left behind");
  const Files before = files();
  std::filesystem::permissions(folder / "work" / "out", std::filesystem::perms(0555));
  as_ordinary_user();
  for (const char* option : {"--skip-existing", "--resume", "--claim"}) {
    for (const char* statistics : {"out/s.json", "out/new.json", "-"}) {
      std::vector<std::string> again = job;
      again.insert(again.end(), {option, "--stats", statistics});
      const Outcome outcome = run(again);
      EXPECT_EQ(outcome.code, 0) << option << ": " << outcome.err;
      EXPECT_EQ(outcome.err.find("error"), std::string::npos) << outcome.err;
    }
    // Another image than that which is there.
    EXPECT_EQ(run({"scene.toml", "-o", "out/a.exr", "-s", "9", option}).code, 4);
  }
  EXPECT_EQ(files(), before);
  std::filesystem::permissions(folder / "work" / "out", std::filesystem::perms(0755));
}

TEST_F(FailureTest, WhatCanBeNoClaimIsFileTroubleAndIsNotWaitedFor) {
  write_scene();
  const std::vector<std::string> job{"scene.toml", "-o", "a.exr", "--claim"};
  std::filesystem::create_directory(folder / "work" / "a.exr.claim");
  EXPECT_EQ(run(job).code, 4);
  std::filesystem::remove(folder / "work" / "a.exr.claim");
  std::filesystem::create_symlink("nowhere", folder / "work" / "a.exr.claim");
  const Outcome link = run(job);
  EXPECT_EQ(link.code, 4);
  EXPECT_NE(link.err.find("cannot claim a.exr.claim: a symbolic link has that name"), std::string::npos)
      << link.err;
  std::filesystem::remove(folder / "work" / "a.exr.claim");
  write("a.exr.claim", "");
  std::filesystem::permissions(folder / "work" / "a.exr.claim", std::filesystem::perms(0));
  as_ordinary_user();
  const Outcome unreadable = run(job);
  EXPECT_EQ(unreadable.code, 4);
  EXPECT_NE(unreadable.err.find("it is there and cannot be read: Permission denied"), std::string::npos)
      << unreadable.err;
  EXPECT_FALSE(exists("a.exr"));
}

TEST_F(FailureTest, FileInTheWayOfAFolderIsFileTrouble) {
  write_scene();
  write("out", "a file");
  EXPECT_EQ(run({"scene.toml", "-o", "out/a.exr"}).code, 4);
  std::filesystem::create_directory(folder / "work" / "b.exr");
  EXPECT_EQ(run({"scene.toml", "-o", "b.exr/x/y.exr", "--stats", "/nowhere/s"}).code, 4);
}

TEST_F(FailureTest, FullDiskLeavesTheOldFile) {
  write_scene();
  ASSERT_EQ(run({"scene.toml", "-o", "a.exr"}).code, 0);
  const std::string before = read("a.exr");
  // Files may grow to 4 kB and no further: the kernel then refuses as a full disk does.
  in_child = [] {
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  const Outcome outcome = run({"scene.toml", "-r", "200x200", "-s", "2", "--float", "-o", "a.exr"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("a.exr"), std::string::npos) << outcome.err;
  EXPECT_EQ(read("a.exr"), before);
  EXPECT_EQ(files(), (Files{"a.exr", "scene.toml"}));
}

TEST_F(FailureTest, FullStandardOutputIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  in_child = [] {
    if (freopen("/dev/full", "w", stdout) == nullptr) _exit(126);
  };
  const Outcome outcome = run({"schema"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err, "backlight: error: cannot write to standard output\n");
}

TEST_F(FailureTest, SignalsStopItAtOnce) {
  write_slow_scene();
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    std::filesystem::remove_all(folder / "work" / "out");
    std::chrono::steady_clock::time_point sent;
    const Outcome outcome = run_and(slow, [&](int process) {
      wait_until_rendering();
      sent = std::chrono::steady_clock::now();
      kill(process, number);
    });
    const std::chrono::duration<double> reaction = std::chrono::steady_clock::now() - sent;
    EXPECT_EQ(outcome.code, 128 + number) << outcome.err;
    // The image would take minutes. Unloaded it stops within a second, most of which goes into the partial
    // image, but a test cannot know the load.
    EXPECT_LT(reaction.count(), 20.0);
    EXPECT_EQ(files(), (Files{"out/slow.partial.exr", "slow.toml"}));
  }
}

TEST_F(FailureTest, ASecondSignalEndsItAtOnce) {
  write_slow_scene();
  const Outcome outcome = run_and(slow, [&](int process) {
    wait_until_rendering();
    kill(process, SIGTERM);
    kill(process, SIGINT);
  });
  // The two may be delivered in either order, and the partial image may even be there already.
  EXPECT_TRUE(outcome.code == 128 + SIGTERM || outcome.code == 128 + SIGINT) << outcome.code;
  for (const std::string& file : files()) {
    EXPECT_TRUE(file == "slow.toml" || file == "out/slow.partial.exr") << file;
  }
}

TEST_F(FailureTest, IgnoredSignalsStayIgnored) {
  write_slow_scene();
  in_child = [] { signal(SIGHUP, SIG_IGN); };
  const Outcome outcome = run_and(slow, [&](int process) {
    wait_until_rendering();
    kill(process, SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(process, SIGTERM);
  });
  EXPECT_EQ(outcome.code, 128 + SIGTERM);
}

}  // namespace
}  // namespace backlight::test
