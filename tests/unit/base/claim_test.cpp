#include "backlight/base/claim.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>
#include <vector>

#include "backlight/base/files.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Claims : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "backlight-claim-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
    file = folder / "a.exr.claim";
  }
  void TearDown() override { fs::remove_all(folder); }

  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }
  // As a machine far away would have it, which nobody can ask.
  void write_theirs(const std::string& number = "0") const {
    ASSERT_TRUE(write_file(file, "backlight claim\nhost far\nprocess 12\nspace elsewhere\nstart 1\nnumber " +
                                     number + "\n")
                    .ok());
  }
  // What the clock of another machine would have given it.
  void date(std::chrono::seconds from_now) const {
    fs::last_write_time(file, fs::file_time_type::clock::now() + from_now);
  }
  // Whether it is taken, looked at as often as those do who wait.
  static bool is_taken_within(std::chrono::milliseconds time, Claimant& claimant, const fs::path& file) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
      const auto attempt = claimant.attempt(file);
      EXPECT_TRUE(attempt.ok()) << attempt.error();
      if (attempt.ok() && attempt.value().claim) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  void expect_refusal(const std::string& why) const {
    Claimant claimant(200ms);
    const auto attempt = claimant.attempt(file);
    ASSERT_FALSE(attempt.ok());
    EXPECT_EQ(attempt.error(), "cannot claim " + file.string() + ": " + why);
  }

  fs::path folder;
  fs::path file;
};

TEST_F(Claims, OneHasItUntilItIsGivenUp) {
  Claimant claimant(60s);
  Claimant another(60s);
  {
    const auto first = claimant.attempt(file);
    ASSERT_TRUE(first.ok()) << first.error();
    ASSERT_TRUE(first.value().claim);
    EXPECT_FALSE(first.value().claim->is_lost());
    const auto second = another.attempt(file);
    ASSERT_TRUE(second.ok());
    EXPECT_FALSE(second.value().claim);
    EXPECT_EQ(second.value().holder.find("process " + std::to_string(::getpid()) + " on "), 0U)
        << second.value().holder;
    EXPECT_EQ(entries(), 1);
  }
  EXPECT_EQ(entries(), 0);
  EXPECT_TRUE(another.attempt(file).value().claim);
}

TEST_F(Claims, AreTakenByOneOfManyThreads) {
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> taken{0};
    std::vector<std::unique_ptr<Claimant>> claimants(8);
    std::vector<std::unique_ptr<Claim>> kept(claimants.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < claimants.size(); ++i) {
        claimants[i] = std::make_unique<Claimant>(60s);
        threads.emplace_back([&, i] {
          kept[i] = std::move(claimants[i]->attempt(file).value().claim);
          if (kept[i]) ++taken;
        });
      }
    }
    EXPECT_EQ(taken.load(), 1);
  }
}

// All of them see at the same time that it is stale.
TEST_F(Claims, ThatAreStaleAreTakenOverByOneOfManyThreads) {
  for (int round = 0; round < 20; ++round) {
    ASSERT_TRUE(write_file(file, "").ok());
    std::atomic<int> held{0};
    std::vector<std::unique_ptr<Claimant>> claimants(4);
    std::vector<std::unique_ptr<Claim>> kept(claimants.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < claimants.size(); ++i) {
        claimants[i] = std::make_unique<Claimant>(100ms);
        threads.emplace_back([&, i] {
          static_cast<void>(claimants[i]->attempt(file));
          std::this_thread::sleep_for(120ms);
          kept[i] = std::move(claimants[i]->attempt(file).value().claim);
        });
      }
    }
    for (const auto& claim : kept) held += claim && !claim->is_lost() ? 1 : 0;
    EXPECT_EQ(held.load(), 1);
    kept.clear();
    EXPECT_EQ(entries(), 0);
  }
}

TEST_F(Claims, OfADeadProcessAreStaleAtOnce) {
  const pid_t child = ::fork();
  if (child == 0) {
    Claimant claimant(3600s);
    auto attempt = claimant.attempt(file);
    ::_exit(attempt.ok() && attempt.value().claim ? 0 : 1);  // no destructor: as if it was killed
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(fs::exists(file));
  Claimant claimant(3600s);
  EXPECT_TRUE(claimant.attempt(file).value().claim);
  EXPECT_EQ(entries(), 0);
}

// The number of a process is given to another some time later; a clone of a machine has the same boot.
TEST_F(Claims, OfADeadProcessAreKnownByMoreThanItsNumber) {
  std::string own;
  Claimant claimant(3600s);
  {
    const auto attempt = claimant.attempt(file);
    own = read_file(file).value();
  }
  const auto changed = [&](const std::string& name, const std::string& value) {
    const std::size_t begin = own.find("\n" + name + " ") + name.size() + 2;
    return own.substr(0, begin) + value + own.substr(own.find('\n', begin));
  };
  ASSERT_TRUE(write_file(file, changed("start", "1")).ok());
  EXPECT_TRUE(claimant.attempt(file).value().claim);
  ASSERT_TRUE(write_file(file, changed("process", "999999999")).ok());
  EXPECT_TRUE(claimant.attempt(file).value().claim);
  for (const auto& [name, value] : {std::pair{"host", "clone"}, {"space", "another"}, {"start", ""}}) {
    ASSERT_TRUE(write_file(file, changed(name, value)).ok());
    EXPECT_FALSE(claimant.attempt(file).value().claim) << name;
  }
}

TEST_F(Claims, OfAnotherMachineAreStaleWhenSeenUnchangedForTheExpiryTime) {
  write_theirs();
  Claimant claimant(400ms);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(claimant.attempt(file).value().holder, "process 12 on far");
  EXPECT_TRUE(is_taken_within(10s, claimant, file));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 400ms);
  EXPECT_EQ(entries(), 0);
}

// An hour ahead, an hour late: neither is believed. An empty file is what a power cut leaves.
TEST_F(Claims, AreStaleWhateverTheirClocksAndContentsAre) {
  for (const auto from_now : {-3600s, 0s, 3600s, 1000000s}) {
    for (const std::string contents : {"", "backlight claim\nhost f", "\n\n\n"}) {
      ASSERT_TRUE(write_file(file, contents).ok());
      date(from_now);
      Claimant claimant(300ms);
      const auto begin = std::chrono::steady_clock::now();
      EXPECT_TRUE(is_taken_within(10s, claimant, file));
      EXPECT_GE(std::chrono::steady_clock::now() - begin, 300ms);
    }
  }
}

TEST_F(Claims, ThatChangeAreNotStale) {
  write_theirs();
  Claimant claimant(400ms);
  // Renewed by a clock that goes backwards, and then made anew by one that stands still.
  for (int i = 0; i < 10; ++i) {
    date(std::chrono::seconds(-i));
    EXPECT_FALSE(is_taken_within(100ms, claimant, file));
  }
  for (int i = 0; i < 10; ++i) {
    write_theirs(std::to_string(i));
    date(-100s);
    EXPECT_FALSE(is_taken_within(100ms, claimant, file));
  }
}

TEST_F(Claims, AreRenewed) {
  Claimant claimant(1s);
  const auto mine = claimant.attempt(file);
  ASSERT_TRUE(mine.value().claim);
  const auto first = fs::last_write_time(file);
  for (int i = 0; i < 400 && fs::last_write_time(file) == first; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_GT(fs::last_write_time(file), first);
}

TEST_F(Claims, ThatAreLostAreKnownToBe) {
  Claimant claimant(3600s);
  auto mine = claimant.attempt(file);
  write_theirs();
  EXPECT_TRUE(mine.value().claim->is_lost());
  mine.value().claim.reset();
  EXPECT_TRUE(fs::exists(file));  // another's is left alone

  fs::remove(file);
  auto again = claimant.attempt(file);
  EXPECT_FALSE(again.value().claim->is_lost());
  fs::remove(file);
  EXPECT_TRUE(again.value().claim->is_lost());
}

TEST_F(Claims, ThatCannotBeOnesAreRefused) {
  fs::create_directory(file);
  expect_refusal("a folder has that name");
  fs::remove(file);
  fs::create_symlink("nowhere", file);
  expect_refusal("a symbolic link has that name");
  fs::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0666), 0);
  expect_refusal("it is not a regular file");
}

TEST_F(Claims, AreClearedWhenTheyAreLeftBehind) {
  Claimant claimant(200ms);
  write_theirs();
  claimant.clear(file);
  EXPECT_TRUE(fs::exists(file));
  std::this_thread::sleep_for(220ms);
  claimant.clear(file);
  EXPECT_EQ(entries(), 0);
}

TEST_F(Claims, SayWhenTheFolderCannotBeMade) {
  ASSERT_TRUE(write_file(folder / "file", "").ok());
  Claimant claimant(60s);
  const auto attempt = claimant.attempt(folder / "file" / "x.claim");
  ASSERT_FALSE(attempt.ok());
  EXPECT_NE(attempt.error().find("cannot claim"), std::string::npos);
}

}  // namespace
}  // namespace backlight
