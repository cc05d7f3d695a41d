#include "backlight/base/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "backlight/base/sha256.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "backlight-files-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }

  /// How many entries the folder has, hidden ones too.
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }

  [[nodiscard]] bool supports_nameless_files() const {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY, 0600);
    if (descriptor >= 0) ::close(descriptor);
    return descriptor >= 0;
  }

  fs::path folder;
};

TEST_F(Files, HasTheModeOfAnOrdinaryFile) {
  const mode_t before = ::umask(027);
  ASSERT_TRUE(write_file(folder / "file", "x").ok());
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "file").permissions(), fs::perms(0640));
}

TEST_F(Files, WritesAndReadsAnyBytes) {
  const std::string bytes("a\0b\xFF\n", 5);
  ASSERT_TRUE(write_file(folder / "file", bytes).ok());
  const Result<std::string> read = read_file(folder / "file");
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_EQ(read.value(), bytes);
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, ReadsFilesLongerThanABlock) {
  std::string bytes;
  for (int i = 0; i < 200000; ++i) {
    bytes += static_cast<char>(i * 31);
  }
  ASSERT_TRUE(write_file(folder / "file", bytes).ok());
  EXPECT_EQ(read_file(folder / "file").value(), bytes);
}

TEST_F(Files, MakesParentFolders) {
  ASSERT_TRUE(write_file(folder / "a" / "b" / "file", "x").ok());
  EXPECT_EQ(read_file(folder / "a" / "b" / "file").value(), "x");
}

TEST_F(Files, WritesANameOfTheGreatestLength) {
  const fs::path path = folder / std::string(255, 'n');
  ASSERT_TRUE(write_file(path, "x").ok());
  EXPECT_EQ(read_file(path).value(), "x");
}

TEST_F(Files, ShowsNothingUnderTheFinalNameBeforeTheCommit) {
  ASSERT_TRUE(write_file(folder / "file", "old").ok());
  Result<AtomicFile> file = AtomicFile::create(folder / "file");
  ASSERT_TRUE(file.ok()) << file.error();
  ASSERT_TRUE(file.value().write("new").ok());
  EXPECT_EQ(read_file(folder / "file").value(), "old");
  ASSERT_TRUE(file.value().commit().ok());
  EXPECT_EQ(read_file(folder / "file").value(), "new");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, LeavesNothingWithoutACommit) {
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "file");
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE(file.value().write("x").ok());
    EXPECT_FALSE(fs::exists(folder / "file"));
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, LeavesNothingOfAKilledWriter) {
  if (!supports_nameless_files()) GTEST_SKIP() << "the file system has no files without a name";
  const pid_t child = ::fork();
  if (child == 0) {
    Result<AtomicFile> file = AtomicFile::create(folder / "file");
    if (!file.ok() || !file.value().write("half of i").ok()) ::_exit(1);
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, WritesWhereItIsToldTo) {
  Result<AtomicFile> file = AtomicFile::create(folder / "file");
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file.value().write("abcdef").ok());
  file.value().seek(2);
  ASSERT_TRUE(file.value().write("XY").ok());
  EXPECT_EQ(file.value().position(), 4U);
  ASSERT_TRUE(file.value().commit().ok());
  EXPECT_EQ(read_file(folder / "file").value(), "abXYef");
}

TEST_F(Files, TwoWritersOfOneNameDoNotMix) {
  Result<AtomicFile> first = AtomicFile::create(folder / "file");
  Result<AtomicFile> second = AtomicFile::create(folder / "file");
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_TRUE(first.value().write("first").ok());
  ASSERT_TRUE(second.value().write("second").ok());
  ASSERT_TRUE(second.value().commit().ok());
  ASSERT_TRUE(first.value().commit().ok());
  EXPECT_EQ(read_file(folder / "file").value(), "first");
}

TEST_F(Files, AMovedWriterGoesOn) {
  Result<AtomicFile> file = AtomicFile::create(folder / "file");
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file.value().write("ab").ok());
  AtomicFile other = std::move(file).value();
  ASSERT_TRUE(other.write("cd").ok());
  ASSERT_TRUE(other.commit().ok());
  EXPECT_EQ(read_file(folder / "file").value(), "abcd");
}

TEST_F(Files, RefusesWhatIsNotAFile) {
  EXPECT_EQ(AtomicFile::create(folder).error(), "cannot write " + folder.string() + ": Is a directory");
  EXPECT_EQ(AtomicFile::create("/dev/null").error(), "cannot write /dev/null: not a regular file");
  EXPECT_EQ(AtomicFile::create("").error(), "cannot write : not the name of a file");
  EXPECT_EQ(AtomicFile::create(folder.string() + "/").error(),
            "cannot write " + folder.string() + "/: not the name of a file");
}

TEST_F(Files, SaysWhyAFolderCannotBeMade) {
  ASSERT_TRUE(write_file(folder / "file", "x").ok());
  const fs::path path = folder / "file" / "below";
  EXPECT_EQ(write_file(path, "x").error(), "cannot write " + path.string() + ": cannot make the folder " +
                                               (folder / "file").string() + ": Not a directory");
}

TEST_F(Files, SaysThatAFolderIsNotWritable) {
  ASSERT_EQ(::chmod(folder.c_str(), 0555), 0);
  const bool root = ::geteuid() == 0;
  if (root) {
    ASSERT_EQ(::seteuid(65534), 0);  // root may write anywhere
  }
  const Result<void> written = write_file(folder / "file", "x");
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
  EXPECT_EQ(written.error(), "cannot write " + (folder / "file").string() + ": Permission denied");
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, SaysWhyAFileCannotBeRead) {
  EXPECT_EQ(read_file(folder / "none").error(),
            "cannot read " + (folder / "none").string() + ": No such file or directory");
  EXPECT_EQ(read_file(folder).error(), "cannot read " + folder.string() + ": Is a directory");
}

TEST_F(Files, ReadsNothingThatHasNoEnd) {
  EXPECT_EQ(read_file("/dev/zero").error(), "cannot read /dev/zero: it is neither a file nor a pipe");
  EXPECT_EQ(read_file("/dev/null").error(), "cannot read /dev/null: it is neither a file nor a pipe");
  const fs::path file = folder / "file";
  ASSERT_TRUE(write_file(file, "123456").ok());
  EXPECT_EQ(read_file(file, 6).value(), "123456");
  EXPECT_EQ(read_file(file, 5).error(), "cannot read " + file.string() + ": it is longer than 0 MiB");
  fs::resize_file(file, std::uintmax_t{1} << 40U);  // takes no room on the disk
  EXPECT_EQ(read_file(file).error(), "cannot read " + file.string() + ": it is longer than 256 MiB");
}

TEST_F(Files, ReadsAPipeToItsEnd) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_file(pipe).value(), "");  // nobody writes: not waited for
  const int both = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(both, 0);
  ASSERT_EQ(::write(both, "text", 4), 4);
  std::thread writer([both] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::close(both);
  });
  EXPECT_EQ(read_file(pipe).value(), "text");
  writer.join();
}

TEST_F(Files, TellsWhatIsNoRegularFile) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(require_regular_file(pipe).error(), "cannot read " + pipe.string() + ": not a regular file");
  EXPECT_EQ(require_regular_file("/dev/zero").error(), "cannot read /dev/zero: not a regular file");
  EXPECT_EQ(require_regular_file(folder).error(), "cannot read " + folder.string() + ": Is a directory");
  EXPECT_EQ(require_regular_file(folder / "none").error(),
            "cannot read " + (folder / "none").string() + ": No such file or directory");
}

TEST_F(Files, KnowsTheDigestOfAFile) {
  ASSERT_TRUE(write_file(folder / "file", "abc").ok());
  EXPECT_EQ(sha256_of_file(folder / "file").value(), sha256_hex("abc"));
  EXPECT_FALSE(sha256_of_file("/dev/zero").ok());
}

TEST(Encoding, OfATextIsFoundOut) {
  using namespace std::string_literals;
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBFtext"), "text");
  EXPECT_EQ(without_byte_order_mark("text"), "text");
  EXPECT_EQ(fault_of_encoding("a = 1 # \xC3\xA4"), "");
  EXPECT_EQ(fault_of_encoding(""), "");
  EXPECT_EQ(fault_of_encoding("\xFF\xFE" + "a\0"s), "it is UTF-16 or UTF-32 text; save it as UTF-8");
  EXPECT_EQ(fault_of_encoding("a\0=\0"s), "it is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(fault_of_encoding("\0a\0="s), "it is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(fault_of_encoding("abc\0def"s), "it is not text: it has null bytes");
}

TEST_F(Files, KeepsTheFirstFailure) {
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_TRUE(write_file(folder / "file", "old").ok());
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Result<AtomicFile> file = AtomicFile::create(folder / "file");
  const Result<void> first = file.value().write(std::string(1000, 'x'));
  const Result<void> second = file.value().write("x");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_TRUE(first.ok()) << first.error();
  const std::string expected = "cannot write " + (folder / "file").string() + ": File too large";
  EXPECT_EQ(second.error(), expected);
  EXPECT_EQ(file.value().write("y").error(), expected);
  EXPECT_EQ(file.value().commit().error(), expected);
  EXPECT_EQ(read_file(folder / "file").value(), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, SaysThatTheDiskIsFull) {
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "mounting needs root";
  }
  const Result<void> written = write_file(disk / "file", std::string(100000, 'x'));
  const bool left = !fs::is_empty(disk);
  const Result<void> smaller = write_file(disk / "file", std::string(30000, 'x'));
  ASSERT_EQ(::umount(disk.c_str()), 0);
  EXPECT_EQ(written.error(), "cannot write " + (disk / "file").string() + ": No space left on device");
  EXPECT_FALSE(left);
  EXPECT_TRUE(smaller.ok()) << smaller.error();
}

}  // namespace
}  // namespace backlight
