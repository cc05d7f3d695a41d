// What happens to pictures when the disk is full, and to readers when a file is damaged.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "backlight/base/files.h"
#include "backlight/film/exr.h"
#include "folder.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

using ExrDamage = InFolder;

/// Noise, which does not compress.
Image noise(int width, int height) {
  Image image({{0, 0, width, height},
               {0, 0, width, height},
               {{"R", ChannelPrecision::half}, {"Z", ChannelPrecision::single}},
               {}});
  std::uint32_t state = 1;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    for (float& value : image.plane(channel)) {
      state = 1664525 * state + 1013904223;
      value = static_cast<float>(state >> 8U) / 16777216.0F;
    }
  }
  return image;
}

/// Without the flush to the disk of write_file, which thousands of files would wait for.
void put(const fs::path& path, std::string_view bytes) {
  fs::remove(path);  // some file systems flush a file that is written over
  std::ofstream(path, std::ios::binary) << bytes;
  ASSERT_EQ(fs::file_size(path), bytes.size());
}

/// Limits the size of any file that this process writes, as a full disk does, for one scope.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uint64_t bytes) {
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST_F(ExrDamage, AFileThatWasCutShortIsNotWhole) {
  const Image image = noise(40, 50);  // four chunks
  ASSERT_TRUE(write_exr(folder / "whole.exr", image, {}).ok());
  ASSERT_TRUE(read_whole_exr_info(folder / "whole.exr").ok());
  const std::string bytes = read_file(folder / "whole.exr").value();
  for (const std::size_t length : {bytes.size() - 1, bytes.size() / 2, std::size_t{400}, std::size_t{3}}) {
    ASSERT_TRUE(write_file(folder / "cut.exr", bytes.substr(0, length)).ok());
    EXPECT_FALSE(read_whole_exr_info(folder / "cut.exr").ok()) << length;
  }
  // A copy of which a block is missing in the middle, as sparse copies leave them.
  std::string hole = bytes;
  const auto third = static_cast<std::ptrdiff_t>(bytes.size() / 3);
  std::fill(hole.begin() + third, hole.end() - third, '\0');
  ASSERT_TRUE(write_file(folder / "hole.exr", hole).ok());
  EXPECT_FALSE(read_whole_exr_info(folder / "hole.exr").ok());
}

TEST_F(ExrDamage, NoSpaceAtAnyByteIsAnErrorAndLeavesNothing) {
  const Image image = noise(40, 40);
  const fs::path path = folder / "a.exr";
  ASSERT_TRUE(write_exr(path, image, {}).ok());
  const std::uint64_t size = fs::file_size(path);
  const std::string whole = read_file(path).value();
  fs::remove(path);
  for (std::uint64_t limit = 0; limit < size; limit += limit < 1000 ? 13 : 211) {
    Result<void> written;
    {
      const FileSizeLimit full(limit);
      written = write_exr(path, image, {});
    }
    ASSERT_EQ(written.error(), "cannot write " + path.string() + ": File too large") << limit << " bytes";
    ASSERT_EQ(entries(), 0) << limit << " bytes";
  }
  for (const std::uint64_t limit : {size - 1, size}) {
    const FileSizeLimit full(limit);
    EXPECT_EQ(write_exr(path, image, {}).ok(), limit == size);
  }
  EXPECT_EQ(read_file(path).value(), whole);
}

TEST_F(ExrDamage, AFullDiskKeepsTheOldPicture) {
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=128k") != 0) {
    GTEST_SKIP() << "mounting needs root";
  }
  const Result<void> old = write_exr(disk / "a.exr", noise(20, 20), {});
  const std::string before = read_file(disk / "a.exr").value();
  const Result<void> written = write_exr(disk / "a.exr", noise(200, 200), {});
  const std::string after = read_file(disk / "a.exr").value();
  const auto left = std::distance(fs::directory_iterator(disk), fs::directory_iterator());
  ASSERT_EQ(::umount(disk.c_str()), 0);
  EXPECT_TRUE(old.ok());
  EXPECT_EQ(written.error(), "cannot write " + (disk / "a.exr").string() + ": No space left on device");
  EXPECT_EQ(after, before);
  EXPECT_EQ(left, 1);
}

TEST_F(ExrDamage, AnyTruncationIsAnError) {
  const fs::path path = folder / "a.exr";
  ASSERT_TRUE(write_exr(path, noise(40, 40), {}).ok());
  const std::string whole = read_file(path).value();
  for (std::size_t size = 0; size < whole.size(); size += size < 1000 ? 1 : 101) {
    put(path, std::string_view(whole).substr(0, size));
    const Result<ExrPicture> read = read_exr(path);
    ASSERT_FALSE(read.ok()) << size << " of " << whole.size() << " bytes";
    ASSERT_TRUE(read.error().starts_with("cannot read " + path.string() + ": ")) << read.error();
  }
}

TEST_F(ExrDamage, DamagedBytesNeverCrashTheReader) {
  const fs::path path = folder / "a.exr";
  ASSERT_TRUE(write_exr(path, noise(24, 40), {}).ok());
  const std::string whole = read_file(path).value();
  const std::size_t header_size = 400;
  std::uint32_t state = 5;
  int errors = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string damaged = whole;
    for (int change = 0; change <= round % 4; ++change) {
      state = 1664525 * state + 1013904223;
      const std::size_t range = round % 2 == 0 ? header_size : damaged.size();
      const std::size_t at = (state >> 8U) % range;
      state = 1664525 * state + 1013904223;
      damaged[at] = static_cast<char>(state >> 24U);
    }
    put(path, damaged);
    const Result<ExrPicture> read = read_exr(path);
    if (read.ok()) {
      const Image& image = read.value().image;
      for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        ASSERT_EQ(image.plane(channel).size(), static_cast<std::size_t>(image.layout().data.width()) *
                                                   static_cast<std::size_t>(image.layout().data.height()));
      }
    } else {
      ++errors;
    }
  }
  EXPECT_GT(errors, 1000);
}

TEST_F(ExrDamage, SaysWhatIsWrong) {
  const auto error_of = [&](const char* name) { return read_exr(folder / name).error(); };
  const std::string start = "cannot read " + folder.string() + "/";
  EXPECT_EQ(error_of("none.exr"), start + "none.exr: No such file or directory");
  put(folder / "text.exr", "not a picture at all");
  EXPECT_EQ(error_of("text.exr"), start + "text.exr: it is not an OpenEXR file");
  put(folder / "empty.exr", "");
  EXPECT_EQ(error_of("empty.exr"), start + "empty.exr: the file ends too early");
  EXPECT_EQ(read_exr(folder).error(), "cannot read " + folder.string() + ": Is a directory");
}

}  // namespace
}  // namespace backlight
