#include "backlight/base/memory.h"

#include <gtest/gtest.h>

#include "backlight/base/files.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20U;

// Files as the system has them, in a folder of their own.
class Memory : public testing::Test {
 protected:
  void SetUp() override {
    root = fs::path(BACKLIGHT_BINARY_DIR) / "memory" /
           testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root);
    write("proc/meminfo", "MemTotal: 8192 kB\nMemFree: 100 kB\nMemAvailable: 4096 kB\nSwapFree: 1024 kB\n");
  }
  void write(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(write_file(root / name, text).ok());
  }

  fs::path root;
};

TEST_F(Memory, IsWhatTheMachineHas) {
  const auto left = memory_left(root);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->bytes, 5 * mebibyte);
  EXPECT_EQ(left->where, "free on this machine");
}

TEST_F(Memory, IsNotKnownWithoutFiles) {
  EXPECT_FALSE(memory_left(root / "none"));
}

TEST_F(Memory, IsLimitedByAGroupAbove) {
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  write("sys/fs/cgroup/outer/inner/memory.current", "1048576\n");
  write("sys/fs/cgroup/outer/memory.max", "4194304\n");
  write("sys/fs/cgroup/outer/memory.current", "2097152\n");
  write("sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 1048576\nactive_file 7\n");
  const auto left = memory_left(root);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->bytes, 3 * mebibyte);  // 4 - (2 - 1)
  EXPECT_EQ(left->where, "left in the control group");
}

TEST_F(Memory, IsLimitedByAGroupOfTheFirstVersion) {
  write("proc/self/cgroup", "5:cpu,memory:/unseen\n1:name=systemd:/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "2097152\n");  // a container sees its own alone
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3145728\n");
  write("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 2097152\n");
  const auto left = memory_left(root);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->bytes, mebibyte);
}

TEST(MemoryWords, HaveAFewDigits) {
  EXPECT_EQ(memory_words(0), "0 KiB");
  EXPECT_EQ(memory_words(640 * mebibyte), "640 MiB");
  EXPECT_EQ(memory_words(1536 * mebibyte), "1.5 GiB");
  EXPECT_EQ(memory_words(68ULL << 30U), "68 GiB");
}

}  // namespace
}  // namespace backlight
