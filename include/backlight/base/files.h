// Reading whole files, and writing files that are never seen half written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "backlight/base/result.h"

namespace backlight {

/// A file being written. The bytes go to a temporary on the file system of `path`, without a name where that
/// file system can (O_TMPFILE), so that nothing is left of a killed process; hidden in the same folder
/// elsewhere. `commit` moves it to `path` in one step: a file under its final name is always whole, whatever
/// fails or is killed. Without a commit the destructor removes the temporary, and a file that was at `path`
/// before is untouched.
///
/// The first failure is kept: later calls do nothing and return it again. A caller behind an interface that
/// swallows errors may therefore look once, at the commit. Not for concurrent use of one object.
class AtomicFile {
 public:
  /// Makes missing parent folders and opens the temporary. Fails where the file could not be put in place
  /// either: the folder cannot be written, or `path` is a folder or a device.
  static Result<AtomicFile> create(const std::filesystem::path& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  /// Writes at the position and moves it on. Every byte is handed to the system before this returns.
  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);

  /// Reads back what was written, from `position` on. A failure is not kept.
  [[nodiscard]] Result<void> read_back(std::uint64_t position, std::span<char> bytes) const;

  /// The next write goes to `position`, bytes from the beginning; a gap left behind reads as zeros.
  void seek(std::uint64_t position) { position_ = position; }
  [[nodiscard]] std::uint64_t position() const { return position_; }

  /// Flushes the bytes to the disk, renames the temporary to `path`, and flushes the folder. On failure the
  /// temporary is gone and `path` is as it was (a failing flush of the folder excepted: the file is then in
  /// place and whole, but may not outlive a power cut).
  Result<void> commit();

  /// Removes the temporary. Further calls fail.
  void abandon();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The first failure, or success.
  [[nodiscard]] Result<void> status() const;

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor);
  Result<void> fail(int error_number);
  int give_name();

  std::filesystem::path path_;
  std::filesystem::path temporary_;  ///< empty while it has no name
  int descriptor_ = -1;
  std::uint64_t position_ = 0;
  std::string error_;
};

/// Writes `contents` to `path` through an AtomicFile.
Result<void> write_file(const std::filesystem::path& path, std::string_view contents);

/// No text that is read is longer (in bytes): what comes out of a pipe may have no end.
inline constexpr std::size_t longest_text = std::size_t{256} << 20U;

/// All bytes of a file or a pipe. Fails on a folder, a device, a missing or an unreadable file, on more than
/// `longest` bytes, and on a pipe from which nothing comes for 10 s.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t longest = longest_text);

/// A text without the mark of UTF-8 that some editors put before it.
std::string_view without_byte_order_mark(std::string_view text);

/// Why bytes are no text that can be read ("it is UTF-16 text; save it as UTF-8"), or empty.
std::string fault_of_encoding(std::string_view bytes);

/// The SHA-256 of a regular file of any size, in hexadecimal digits.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

/// Fails, with the reason, on anything that is no regular file: for files that are read out of order, by
/// libraries that would wait for a pipe or read a device without end.
Result<void> require_regular_file(const std::filesystem::path& path);

}  // namespace backlight
