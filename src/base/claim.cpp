#include "backlight/base/claim.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <exception>
#include <system_error>
#include <utility>

#include "backlight/base/interrupted.h"
#include "claim_contents.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

Failure cannot_claim(const fs::path& file, const std::string& why) {
  return {"cannot claim " + file.string() + ": " + why};
}

Failure cannot_claim(const fs::path& file, int error_number) {
  return cannot_claim(file, std::generic_category().message(error_number));
}

/// The file of a claim at one moment.
struct Look {
  std::string contents;
  std::string seen;  ///< differs from that of another moment if the claim was renewed or is another
};

// The first bytes, more than a claim has, and as much as is ever compared. -1: errno tells.
ssize_t read_begin(int descriptor, std::string& contents) {
  std::array<char, 4096> bytes{};
  while (contents.size() < bytes.size()) {
    const ssize_t count =
        unless_interrupted([&] { return ::read(descriptor, bytes.data(), bytes.size() - contents.size()); });
    if (count < 0) return -1;
    if (count == 0) break;
    contents.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return static_cast<ssize_t>(contents.size());
}

// It may go at any moment.
bool means_gone(int error_number) {
  return error_number == ENOENT || error_number == ESTALE;
}

// Nothing if there is no claim. The file is opened before its times are asked for: so a network file system
// answers with those of now.
Result<std::optional<Look>> look_at(const fs::path& file) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0) {
    if (means_gone(errno)) return std::optional<Look>();
    return cannot_claim(file, errno);
  }
  if (!S_ISREG(status.st_mode)) {
    return cannot_claim(file, S_ISDIR(status.st_mode)   ? "a folder has that name"
                              : S_ISLNK(status.st_mode) ? "a symbolic link has that name"
                                                        : "it is not a regular file");
  }
  const int descriptor = unless_interrupted(
      [&] { return ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC); });
  Look look;
  const bool is_read =
      descriptor >= 0 && ::fstat(descriptor, &status) == 0 && read_begin(descriptor, look.contents) >= 0;
  const int error_number = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!is_read) {
    if (means_gone(error_number)) return std::optional<Look>();
    return cannot_claim(file,
                        "it is there and cannot be read: " + std::generic_category().message(error_number));
  }
  look.seen = std::to_string(status.st_ino) + " " + std::to_string(status.st_size) + " " +
              std::to_string(status.st_mtim.tv_sec) + " " + std::to_string(status.st_mtim.tv_nsec) + "\n" +
              look.contents;
  return std::optional<Look>(std::move(look));
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// A name beside the claim that nobody else uses.
fs::path name_beside(const fs::path& file) {
  static std::atomic<unsigned> counter{0};
  return folder_of(file) / (".backlight-claim-" + host_name().substr(0, 64) + "-" +
                            std::to_string(::getpid()) + "-" + std::to_string(counter++));
}

// A file that is to become a claim: without a name where the file system can, so that nothing is left of a
// killed process.
class OwnFile {
 public:
  explicit OwnFile(const fs::path& file) : path_(name_beside(file)) {
    const fs::path folder = folder_of(file);
    descriptor_ =
        unless_interrupted([&] { return ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666); });
    if (descriptor_ >= 0) return;
    descriptor_ = unless_interrupted(
        [&] { return ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666); });
    is_named_ = descriptor_ >= 0;
    if (descriptor_ < 0) error_ = errno;
  }
  ~OwnFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (is_named_) ::unlink(path_.c_str());
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  /// 0 if `file` is now the claim with these contents, EEXIST if another has it, or another error.
  [[nodiscard]] int make(const fs::path& file, const std::string& contents) {
    if (error_ == 0) error_ = write(contents);
    if (error_ == 0) error_ = link_to(file);
    const bool no_links = error_ == EPERM || error_ == EOPNOTSUPP || error_ == ENOSYS || error_ == ENOENT;
    return no_links ? make_without_links(file, contents) : error_;
  }

  /// Of the claim's file, which is the caller's from now on.
  [[nodiscard]] int release() { return std::exchange(descriptor_, -1); }

 private:
  [[nodiscard]] int write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written =
          unless_interrupted([&] { return ::write(descriptor_, bytes.data(), bytes.size()); });
      if (written <= 0) return written < 0 ? errno : ENOSPC;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    // A network file system may have written nothing yet, and says only at the end that its disk is full.
    return unless_interrupted([&] { return ::fsync(descriptor_); }) == 0 || errno == EINVAL ? 0 : errno;
  }

  [[nodiscard]] int link_to(const fs::path& file) const {
    const std::string nameless = "/proc/self/fd/" + std::to_string(descriptor_);
    const int result = unless_interrupted([&] {
      return is_named_ ? ::link(path_.c_str(), file.c_str())
                       : ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, file.c_str(), AT_SYMLINK_FOLLOW);
    });
    if (result == 0) return 0;
    const int error_number = errno;
    struct stat status {};
    const bool has_it = ::fstat(descriptor_, &status) == 0 && status.st_nlink == (is_named_ ? 2U : 1U);
    return has_it ? 0 : error_number;  // the answer may have been lost on the way
  }

  // No links on this file system (FAT), or no /proc: the next best thing.
  [[nodiscard]] int make_without_links(const fs::path& file, const std::string& contents) {
    ::close(std::exchange(descriptor_, -1));
    descriptor_ = unless_interrupted(
        [&] { return ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    if (descriptor_ < 0) return errno;
    const int error_number = write(contents);
    if (error_number != 0) ::unlink(file.c_str());
    return error_number;
  }

  fs::path path_;
  int descriptor_ = -1;
  bool is_named_ = false;
  int error_ = 0;
};

// Takes a stale claim out of the way. Another may have done so already, and may have a fresh claim there:
// that one is put back. (Should a third have claimed in this moment, the second has lost, and will see it.)
Result<void> remove_stale(const fs::path& file, const std::string& contents) {
  const fs::path aside = name_beside(file);
  if (unless_interrupted([&] { return ::rename(file.c_str(), aside.c_str()); }) != 0) {
    if (means_gone(errno)) return {};
    return cannot_claim(
        file, "it was left behind, and cannot be taken away: " + std::generic_category().message(errno));
  }
  const auto taken = look_at(aside);
  const bool is_it = taken.ok() && taken.value() && taken.value()->contents == contents;
  if (is_it || ::link(aside.c_str(), file.c_str()) == 0 || errno == EEXIST) {
    ::unlink(aside.c_str());
  } else {
    ::rename(aside.c_str(), file.c_str());
  }
  return {};
}

}  // namespace

Claimant::Claimant(std::chrono::milliseconds expiry)
    : expiry_(expiry), thread_([this](std::stop_token stop) { renew_until_stopped(std::move(stop)); }) {}

Result<Claimant::Attempt> Claimant::attempt(const fs::path& file) {
  std::error_code folder_error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), folder_error);
  if (folder_error) return cannot_claim(file, folder_error.value());
  constexpr int most_tries = 8;  // each after another process has made a claim or given it up
  std::string taken_from;
  for (int i = 0; i < most_tries; ++i) {
    const auto look = look_at(file);
    if (!look.ok()) return look.failure();
    if (look.value()) {
      const auto& [theirs, seen] = *look.value();
      if (!is_stale(file, theirs, seen)) return Attempt{nullptr, claim_holder(theirs), {}};
      if (const auto removed = remove_stale(file, theirs); !removed.ok()) return removed.failure();
      taken_from = claim_holder(theirs);
    }
    // All that may want memory comes before the claim is made: so it is given up whatever follows.
    Attempt attempt{std::unique_ptr<Claim>(new Claim(*this, file, new_claim_contents())), {}, taken_from};
    OwnFile own(file);
    const int error_number = own.make(file, attempt.claim->contents_);
    if (error_number == 0) {
      attempt.claim->hold(own.release());
      sights_.erase(file);
      return attempt;
    }
    if (error_number != EEXIST) return cannot_claim(file, error_number);
  }
  return Attempt{nullptr, "another process", {}};
}

void Claimant::clear(const fs::path& file) {
  const auto look = look_at(file);
  if (!look.ok() || !look.value()) return;
  const auto& [contents, seen] = *look.value();
  // Where it stays, nothing is lost: nobody waits for it.
  if (is_stale(file, contents, seen)) static_cast<void>(remove_stale(file, contents));
}

std::chrono::milliseconds Claimant::pause() const {
  return std::min(std::chrono::milliseconds(500), expiry_ / 4);
}

bool Claimant::is_stale(const fs::path& file, const std::string& contents, const std::string& seen) {
  if (is_claim_of_a_dead_process(contents)) return true;
  const Clock::time_point now = Clock::now();
  Sight& sight = sights_[file];
  if (sight.seen != seen) sight = {seen, now};
  return now - sight.since >= expiry_;
}

void Claimant::renew_until_stopped(std::stop_token stop) {
  std::unique_lock lock(guard_);
  while (!wake_.wait_for(lock, stop, expiry_ / 4, [&stop] { return stop.stop_requested(); })) {
    if (stop.stop_requested()) return;
    for (const Claim* claim : held_) claim->renew();
  }
}

Claim::Claim(Claimant& owner, fs::path file, std::string contents)
    : owner_(owner), file_(std::move(file)), contents_(std::move(contents)) {
  const std::lock_guard lock(owner_.guard_);
  owner_.held_.push_back(this);
}

void Claim::hold(int descriptor) {
  const std::lock_guard lock(owner_.guard_);
  descriptor_ = descriptor;
}

Claim::~Claim() {
  {
    const std::lock_guard lock(owner_.guard_);
    std::erase(owner_.held_, this);
  }
  if (descriptor_ < 0) return;
  bool lost = false;
  try {
    lost = is_lost();
  } catch (const std::exception&) {  // no memory
    lost = has_no_name();
  }
  ::close(descriptor_);  // first: a network file system keeps what is open under another name
  if (!lost) ::unlink(file_.c_str());
}

bool Claim::is_lost() const {
  const auto look = look_at(file_);
  if (look.ok()) return !look.value() || look.value()->contents != contents_;
  return has_no_name();  // it cannot be read, or something else has its name
}

// Who takes a claim over leaves its file without any.
bool Claim::has_no_name() const {
  struct stat status {};
  return ::fstat(descriptor_, &status) == 0 ? status.st_nlink == 0 : errno == ESTALE;
}

// With the lock. By its descriptor: so that never another's claim is renewed.
void Claim::renew() const {
  if (descriptor_ >= 0) ::futimens(descriptor_, nullptr);
}

}  // namespace backlight
