#include "backlight/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "backlight/base/interrupted.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

Failure cannot_write(const fs::path& path, const std::string& why) {
  return {"cannot write " + path.string() + ": " + why};
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
  return unless_interrupted([&] { return ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666); });
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
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
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

Result<std::string> read_file(const fs::path& path) {
  const auto cannot_read = [&](int error_number) {
    return Failure{"cannot read " + path.string() + ": " + reason(error_number)};
  };
  const int descriptor = unless_interrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (descriptor < 0) {
    return cannot_read(errno);
  }
  std::string contents;
  constexpr std::size_t block = 1U << 16U;
  for (;;) {
    const std::size_t size = contents.size();
    contents.resize(size + block);
    const ssize_t count = ::read(descriptor, contents.data() + size, block);
    const int error_number = errno;
    contents.resize(size + (count > 0 ? static_cast<std::size_t>(count) : 0));
    if (count == 0) {
      break;
    }
    if (count < 0 && error_number != EINTR) {
      ::close(descriptor);
      return cannot_read(error_number);
    }
  }
  ::close(descriptor);
  return contents;
}

}  // namespace backlight
