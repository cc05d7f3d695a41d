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
  // As if its last touch had been so long ago.
  void age(std::chrono::seconds seconds) const {
    fs::last_write_time(file, fs::last_write_time(file) - seconds);
  }

  fs::path folder;
  fs::path file;
};

TEST_F(Claims, OneHasItUntilItIsGivenUp) {
  {
    const auto first = Claim::attempt(file, 60s);
    ASSERT_TRUE(first.ok()) << first.error();
    ASSERT_TRUE(first.value().claim);
    EXPECT_TRUE(first.value().claim->is_held());
    const auto second = Claim::attempt(file, 60s);
    ASSERT_TRUE(second.ok());
    EXPECT_FALSE(second.value().claim);
    EXPECT_EQ(second.value().holder.find("process " + std::to_string(::getpid()) + " on "), 0U)
        << second.value().holder;
    EXPECT_EQ(entries(), 1);
  }
  EXPECT_EQ(entries(), 0);
  EXPECT_TRUE(Claim::attempt(file, 60s).value().claim);
}

TEST_F(Claims, AreTakenByOneOfManyThreads) {
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> taken{0};
    std::vector<std::unique_ptr<Claim>> kept(8);
    {
      std::vector<std::jthread> threads;
      for (auto& place : kept) {
        threads.emplace_back([&] {
          place = std::move(Claim::attempt(file, 60s).value().claim);
          if (place) ++taken;
        });
      }
    }
    EXPECT_EQ(taken.load(), 1);
  }
}

TEST_F(Claims, OfADeadProcessAreStaleAtOnce) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto attempt = Claim::attempt(file, 3600s);
    ::_exit(attempt.ok() && attempt.value().claim ? 0 : 1);  // no destructor: as if it was killed
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(fs::exists(file));
  EXPECT_TRUE(Claim::attempt(file, 3600s).value().claim);
  EXPECT_EQ(entries(), 0);
}

TEST_F(Claims, OfAnotherMachineAreStaleWhenTheyExpire) {
  ASSERT_TRUE(write_file(file, "backlight claim\nhost far\nprocess 12\nspace elsewhere\nstart 1\n").ok());
  EXPECT_EQ(Claim::attempt(file, 60s).value().holder, "process 12 on far");
  age(50s);
  EXPECT_FALSE(Claim::attempt(file, 60s).value().claim);
  age(12s);
  EXPECT_TRUE(Claim::attempt(file, 60s).value().claim);
}

TEST_F(Claims, AreRenewed) {
  const auto mine = Claim::attempt(file, 1s);
  ASSERT_TRUE(mine.value().claim);
  const auto first = fs::last_write_time(file);
  for (int i = 0; i < 400 && fs::last_write_time(file) == first; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_GT(fs::last_write_time(file), first);
}

TEST_F(Claims, ThatAreLostAreKnownToBe) {
  auto mine = Claim::attempt(file, 3600s);
  ASSERT_TRUE(write_file(file, "backlight claim\nhost far\nprocess 12\nspace elsewhere\nstart 1\n").ok());
  EXPECT_FALSE(mine.value().claim->is_held());
  mine.value().claim.reset();
  EXPECT_TRUE(fs::exists(file));  // another's is left alone
}

TEST_F(Claims, SayWhenTheFolderCannotBeMade) {
  ASSERT_TRUE(write_file(folder / "file", "").ok());
  const auto attempt = Claim::attempt(folder / "file" / "x.claim", 60s);
  ASSERT_FALSE(attempt.ok());
  EXPECT_NE(attempt.error().find("cannot claim"), std::string::npos);
}

}  // namespace
}  // namespace backlight
