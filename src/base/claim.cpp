#include "backlight/base/claim.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <ctime>
#include <sstream>
#include <system_error>
#include <utility>

#include "backlight/base/files.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "backlight claim";

Failure cannot_claim(const fs::path& file, int error_number) {
  return {"cannot claim " + file.string() + ": " + std::generic_category().message(error_number)};
}

std::string contents_of(const fs::path& path) {
  auto text = read_file(path);
  return text.ok() ? std::move(text).value() : std::string();
}

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : "unknown";
}

// Process numbers mean something within one boot and one process namespace only.
std::string process_space() {
  std::string boot = contents_of("/proc/sys/kernel/random/boot_id");
  while (!boot.empty() && boot.back() == '\n') boot.pop_back();
  std::error_code error;
  const std::string space = fs::read_symlink("/proc/self/ns/pid", error).string();
  return boot.empty() || space.empty() ? std::string() : boot + "/" + space;
}

// The time at which a process began, in ticks since the boot: a number may be given to another process later.
// Empty if there is no such process, or only what is left of it (a zombie).
std::string start_of(const std::string& process) {
  const std::string stat = contents_of("/proc/" + process + "/stat");
  const std::size_t name_end = stat.rfind(')');  // the name may contain anything
  if (name_end == std::string::npos) return {};
  std::istringstream fields(stat.substr(name_end + 1));
  std::string field;
  fields >> field;
  if (field == "Z" || field == "X") return {};
  for (int i = 4; i <= 22 && fields >> field; ++i) {
  }
  return field;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::array<char, 32> text{};
  if (::gmtime_r(&now, &utc) != nullptr) std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

// What stands in a claim's file, `name value` a line.
std::string field_of(const std::string& contents, const std::string& name) {
  const std::size_t line = contents.find("\n" + name + " ");
  if (line == std::string::npos) return {};
  const std::size_t begin = line + name.size() + 2;
  return contents.substr(begin, contents.find('\n', begin) - begin);
}

// No two claims have the same contents.
std::string new_contents() {
  static std::atomic<unsigned> counter{0};
  const std::string process = std::to_string(::getpid());
  std::ostringstream text;
  text << first_line << "\nhost " << host_name() << "\nprocess " << process << "\nsince " << utc_now()
       << "\nspace " << process_space() << "\nstart " << start_of(process) << "\nnumber " << counter++
       << '\n';
  return text.str();
}

std::string holder_of(const std::string& contents) {
  if (!contents.starts_with(first_line)) return "another process";
  return "process " + field_of(contents, "process") + " on " + field_of(contents, "host");
}

bool is_of_a_dead_process(const std::string& contents) {
  const std::string space = field_of(contents, "space");
  const std::string start = field_of(contents, "start");
  if (space.empty() || start.empty() || space != process_space()) return false;
  return start_of(field_of(contents, "process")) != start;
}

// A small file of our own beside the claim, for as long as an attempt lasts: without a name where the file
// system can, so that nothing is left of a killed process.
class Beside {
 public:
  Beside(const fs::path& file, const std::string& contents) {
    static std::atomic<unsigned> counter{0};
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    path_ = folder / (".backlight-claim-" + host_name().substr(0, 64) + "-" + std::to_string(::getpid()) +
                      "-" + std::to_string(counter++));
    descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      is_named_ = descriptor_ >= 0;
    }
    if (descriptor_ < 0) {
      error_ = errno;
      return;
    }
    const ssize_t written = ::write(descriptor_, contents.data(), contents.size());
    if (written != static_cast<ssize_t>(contents.size())) error_ = written < 0 ? errno : ENOSPC;
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0) made_ = status.st_mtim;
  }
  ~Beside() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (is_named_) ::unlink(path_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  [[nodiscard]] int error() const { return error_; }
  /// A name beside the claim that nobody else uses.
  [[nodiscard]] const fs::path& path() const { return path_; }
  /// By the clock of the file server.
  [[nodiscard]] timespec made() const { return made_; }

  /// Gives the file the name `file` too: 0, or the error's number.
  [[nodiscard]] int link_to(const fs::path& file) {
    // A network file system may have written nothing yet, and says only at the end that its disk is full.
    if (::fsync(descriptor_) != 0 && errno != EINVAL) return errno;
    const std::string nameless = "/proc/self/fd/" + std::to_string(descriptor_);
    const int result = is_named_
                           ? ::link(path_.c_str(), file.c_str())
                           : ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, file.c_str(), AT_SYMLINK_FOLLOW);
    const int error_number = result == 0 ? 0 : errno;
    struct stat status {};
    const bool has_it = ::fstat(descriptor_, &status) == 0 && status.st_nlink == (is_named_ ? 2U : 1U);
    return has_it ? 0 : error_number;  // the answer may have been lost on the way
  }

 private:
  fs::path path_;
  int descriptor_ = -1;
  bool is_named_ = false;
  timespec made_{};
  int error_ = 0;
};

// 0 if `file` is now the claim with these contents, EEXIST if another has it, or another error.
int make(const fs::path& file, const std::string& contents, Beside& own) {
  const int link_error = own.link_to(file);
  if (link_error != EPERM && link_error != EOPNOTSUPP && link_error != ENOSYS && link_error != ENOENT) {
    return link_error;
  }
  // No links on this file system (FAT), or no /proc: the next best thing.
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  const ssize_t written = ::write(descriptor, contents.data(), contents.size());
  const int error_number = written == static_cast<ssize_t>(contents.size()) ? 0 : ENOSPC;
  ::close(descriptor);
  if (error_number != 0) ::unlink(file.c_str());
  return error_number;
}

bool is_stale(const fs::path& file, const std::string& contents, timespec now, std::chrono::seconds expiry) {
  if (is_of_a_dead_process(contents)) return true;
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && now.tv_sec - status.st_mtim.tv_sec > expiry.count();
}

// Takes a stale claim out of the way. Another may have done so already, and may have a fresh claim there:
// that one is put back. (Should a third have claimed in this moment, the second has lost, and will see it.)
void remove_stale(const fs::path& file, const std::string& contents, const fs::path& aside) {
  if (::rename(file.c_str(), aside.c_str()) != 0) return;
  if (contents_of(aside) == contents || ::link(aside.c_str(), file.c_str()) == 0 || errno == EEXIST) {
    ::unlink(aside.c_str());
    return;
  }
  ::rename(aside.c_str(), file.c_str());
}

}  // namespace

Result<Claim::Attempt> Claim::attempt(const fs::path& file, std::chrono::seconds expiry) {
  std::error_code folder_error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), folder_error);
  if (folder_error) return cannot_claim(file, folder_error.value());
  constexpr int most_tries = 8;  // each after a stale claim was taken away, by this process or another
  for (int i = 0; i < most_tries; ++i) {
    const std::string contents = new_contents();
    Beside own(file, contents);
    if (own.error() != 0) return cannot_claim(file, own.error());
    const int error_number = make(file, contents, own);
    if (error_number == 0) {
      const auto interval = std::chrono::duration_cast<std::chrono::milliseconds>(expiry) / 4;
      return Attempt{std::unique_ptr<Claim>(new Claim(file, contents, interval)), {}};
    }
    if (error_number != EEXIST) return cannot_claim(file, error_number);
    const std::string theirs = contents_of(file);
    if (theirs.empty()) continue;  // given up in this moment
    if (!is_stale(file, theirs, own.made(), expiry)) return Attempt{nullptr, holder_of(theirs)};
    remove_stale(file, theirs, own.path());
  }
  return Attempt{nullptr, "another process"};
}

Claim::Claim(fs::path file, std::string contents, std::chrono::milliseconds interval)
    : file_(std::move(file)), contents_(std::move(contents)), interval_(interval) {
  thread_ = std::jthread([this](std::stop_token stop) { touch_until_stopped(std::move(stop)); });
}

Claim::~Claim() {
  thread_.request_stop();
  thread_.join();
  if (is_held()) ::unlink(file_.c_str());
}

bool Claim::is_held() const {
  return contents_of(file_) == contents_;
}

void Claim::touch_until_stopped(std::stop_token stop) {
  std::unique_lock lock(guard_);
  while (!wake_.wait_for(lock, stop, interval_, [&stop] { return stop.stop_requested(); })) {
    if (stop.stop_requested() || !is_held()) return;
    ::utimensat(AT_FDCWD, file_.c_str(), nullptr, 0);
  }
}

}  // namespace backlight
