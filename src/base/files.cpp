#include "backlight/base/files.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "backlight/base/interrupted.h"
#include "backlight/base/sha256.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

Failure cannot_write(const fs::path& path, const std::string& why) {
  return {"cannot write " + path.string() + ": " + why};
}

Failure cannot_read(const fs::path& path, const std::string& why) {
  return {"cannot read " + path.string() + ": " + why};
}

/// An open file, closed at the end.
class Descriptor {
 public:
  /// Of a regular file, or of a pipe (a shell's `<(...)`). Devices are refused: they have no end. No pipe is
  /// waited for that nobody writes to.
  static Result<Descriptor> open(const fs::path& path) {
    Descriptor file(unless_interrupted(
        [&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY); }));
    struct stat status {};
    if (file.number_ < 0 || ::fstat(file.number_, &status) != 0) return cannot_read(path, reason(errno));
    if (S_ISDIR(status.st_mode)) return cannot_read(path, reason(EISDIR));
    if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
      return cannot_read(path, "it is neither a file nor a pipe");
    }
    return file;
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  explicit Descriptor(int number) : number_(number) {}
  int number_;
};

constexpr int longest_wait = 10;  // seconds for the next bytes of a pipe

/// Hands the file to `take` block by block, as long as that wants more.
template <typename Take>
Result<void> for_each_block(const Descriptor& file, const fs::path& path, const Take& take) {
  std::array<char, std::size_t{1} << 16U> block;
  for (;;) {
    const ssize_t count =
        unless_interrupted([&] { return ::read(file.number(), block.data(), block.size()); });
    if (count == 0) return {};
    if (count > 0) {
      if (!take(std::string_view(block.data(), static_cast<std::size_t>(count)))) return {};
      continue;
    }
    if (errno == EAGAIN) {
      pollfd waiting{file.number(), POLLIN, 0};
      if (::poll(&waiting, 1, 1000 * longest_wait) != 0) continue;
      return cannot_read(path, "nothing has come from the pipe for " + std::to_string(longest_wait) + " s");
    }
    return cannot_read(path, reason(errno));
  }
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Short, so that a name of the greatest allowed length still has a temporary.
fs::path temporary_name(const fs::path& folder) {
  static std::atomic<unsigned> counter{0};
  return folder / (".backlight-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
}

/// A file without a name in `folder`, or -1: it vanishes with the process. It is given a name through /proc.
int open_nameless(const fs::path& folder) {
  static const bool can_be_named = ::access("/proc/self/fd", X_OK) == 0;
  if (!can_be_named) return -1;
  return unless_interrupted([&] { return ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666); });
}

/// Flushes a folder's entries. File systems without such a flush (EINVAL) need none.
int flush_folder(const fs::path& folder) {
  const int descriptor =
      unless_interrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) {
    return errno == EACCES ? 0 : errno;  // a folder may be written to without being readable
  }
  const int error_number = unless_interrupted([&] { return ::fsync(descriptor); }) == 0 ? 0 : errno;
  ::close(descriptor);
  return error_number == EINVAL ? 0 : error_number;
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
  if (path.filename().empty() || path.filename() == "." || path.filename() == "..") {
    return cannot_write(path, "not the name of a file");
  }
  std::error_code status_error;
  const fs::file_status status = fs::status(path, status_error);
  // Renaming over a folder fails at the very end; renaming over /dev/null, as root, succeeds.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return cannot_write(path, fs::is_directory(status) ? reason(EISDIR) : "not a regular file");
  }
  const fs::path folder = folder_of(path);
  std::error_code folder_error;
  fs::create_directories(folder, folder_error);
  if (folder_error) {
    return cannot_write(path, "cannot make the folder " + folder.string() + ": " + folder_error.message());
  }
  if (const int descriptor = open_nameless(folder); descriptor >= 0) return AtomicFile(path, {}, descriptor);
  for (;;) {
    fs::path temporary = temporary_name(folder);
    const int descriptor = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      return AtomicFile(path, std::move(temporary), descriptor);
    }
    // EEXIST: left behind by a killed process, or another machine's process with our number.
    if (errno != EEXIST && errno != EINTR) {
      return cannot_write(path, reason(errno));
    }
  }
}

AtomicFile::AtomicFile(fs::path path, fs::path temporary, int descriptor)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      position_(other.position_),
      error_(std::move(other.error_)) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    abandon();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
    position_ = other.position_;
    error_ = std::move(other.error_);
  }
  return *this;
}

AtomicFile::~AtomicFile() {
  abandon();
}

void AtomicFile::abandon() {
  if (descriptor_ >= 0) {
    ::close(std::exchange(descriptor_, -1));
  }
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
    temporary_.clear();
  }
}

Result<void> AtomicFile::status() const {
  if (!error_.empty()) {
    return Failure{error_};
  }
  if (descriptor_ < 0) {
    return cannot_write(path_, "the file is closed");
  }
  return {};
}

Result<void> AtomicFile::fail(int error_number) {
  error_ = cannot_write(path_, reason(error_number)).message;
  abandon();
  return Failure{error_};
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  if (Result<void> so_far = status(); !so_far.ok()) {
    return so_far;
  }
  while (!bytes.empty()) {
    const ssize_t written = unless_interrupted(
        [&] { return ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(position_)); });
    if (written <= 0) {
      return fail(written < 0 ? errno : ENOSPC);
    }
    position_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> AtomicFile::write(std::string_view text) {
  return write(std::as_bytes(std::span(text.data(), text.size())));
}

Result<void> AtomicFile::read_back(std::uint64_t position, std::span<char> bytes) const {
  if (Result<void> so_far = status(); !so_far.ok()) {
    return so_far;
  }
  while (!bytes.empty()) {
    const ssize_t count = unless_interrupted(
        [&] { return ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(position)); });
    if (count <= 0) {
      return cannot_read(path_, count < 0 ? reason(errno) : "it ends too early");
    }
    position += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

/// Gives a file without a name its own at once, where that is free, or else a temporary one: only between
/// that and the renaming a killed process leaves something behind. Returns 0, or the error's number.
int AtomicFile::give_name() {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor_);
  const auto named = [&](const fs::path& name) {
    return ::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (named(path_)) return 0;
  for (;;) {
    const fs::path temporary = temporary_name(folder_of(path_));
    if (named(temporary)) {
      if (::rename(temporary.c_str(), path_.c_str()) == 0) return 0;
      const int error_number = errno;
      ::unlink(temporary.c_str());
      return error_number;
    }
    if (errno != EEXIST && errno != EINTR) {
      return errno;
    }
  }
}

Result<void> AtomicFile::commit() {
  if (Result<void> so_far = status(); !so_far.ok()) {
    return so_far;
  }
  if (unless_interrupted([&] { return ::fsync(descriptor_); }) != 0) {
    return fail(errno);
  }
  if (temporary_.empty()) {
    if (const int error_number = give_name(); error_number != 0) {
      return fail(error_number);
    }
  }
  // A network file system, which has no files without a name, may say only here that the disk is full. The
  // descriptor is gone in any case.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) {
    return fail(errno);
  }
  if (!temporary_.empty() && ::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return fail(errno);
  }
  temporary_.clear();
  if (const int error_number = flush_folder(folder_of(path_)); error_number != 0) {
    return fail(error_number);
  }
  return {};
}

Result<void> write_file(const fs::path& path, std::string_view contents) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) {
    return file.failure();
  }
  if (Result<void> written = file.value().write(contents); !written.ok()) {
    return written;
  }
  return file.value().commit();
}

Result<void> require_regular_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    return cannot_read(
        path, (error ? error : std::make_error_code(std::errc::no_such_file_or_directory)).message());
  }
  if (fs::is_regular_file(status)) return {};
  return cannot_read(path, fs::is_directory(status) ? reason(EISDIR) : "not a regular file");
}

Result<std::string> read_file(const fs::path& path, std::size_t longest) {
  const auto file = Descriptor::open(path);
  if (!file.ok()) return file.failure();
  std::string contents;
  const Result<void> read = for_each_block(file.value(), path, [&](std::string_view block) {
    contents += block;
    return contents.size() <= longest;
  });
  if (!read.ok()) return read.failure();
  if (contents.size() <= longest) return contents;
  return cannot_read(path, "it is longer than " + std::to_string(longest >> 20U) + " MiB");
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

std::string fault_of_encoding(std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool marked = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
  if (marked || bytes.starts_with("\0\0\xFE\xFF"sv)) return "it is UTF-16 or UTF-32 text; save it as UTF-8";
  // Latin letters in UTF-16 are every other byte.
  const std::string_view begin = bytes.substr(0, 64);
  const bool alternates = begin.size() >= 4 && (begin[0] == 0) != (begin[1] == 0) &&
                          (begin[2] == 0) == (begin[0] == 0) && (begin[3] == 0) == (begin[1] == 0);
  if (alternates) return "it is UTF-16 text; save it as UTF-8";
  return begin.find('\0') == std::string_view::npos ? "" : "it is not text: it has null bytes";
}

Result<std::string> sha256_of_file(const fs::path& path) {
  if (const Result<void> regular = require_regular_file(path); !regular.ok()) return regular.failure();
  const auto file = Descriptor::open(path);
  if (!file.ok()) return file.failure();
  Sha256 digest;
  const Result<void> read = for_each_block(file.value(), path, [&](std::string_view block) {
    digest.update(block);
    return true;
  });
  if (!read.ok()) return read.failure();
  return to_hex(digest.finish());
}

}  // namespace backlight
