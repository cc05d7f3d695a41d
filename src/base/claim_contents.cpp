#include "claim_contents.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "backlight/base/files.h"

namespace backlight {
namespace {

constexpr std::string_view first_line = "backlight claim";

std::string text_of(const std::string& path) {
  auto text = read_file(path);
  return text.ok() ? std::move(text).value() : std::string();
}

// Process numbers mean something within one boot and one process namespace only.
std::string process_space() {
  std::string boot = text_of("/proc/sys/kernel/random/boot_id");
  while (!boot.empty() && boot.back() == '\n') boot.pop_back();
  std::error_code error;
  const std::string space = std::filesystem::read_symlink("/proc/self/ns/pid", error).string();
  return boot.empty() || space.empty() ? std::string() : boot + "/" + space;
}

// The time at which a process began, in ticks since the boot: a number may be given to another process later.
// "gone" for what is left of an ended one (a zombie); empty if it cannot be read.
std::string start_of(const std::string& process) {
  const std::string stat = text_of("/proc/" + process + "/stat");
  const std::size_t name_end = stat.rfind(')');  // the name may contain anything
  if (name_end == std::string::npos) return {};
  std::istringstream fields(stat.substr(name_end + 1));
  std::string field;
  fields >> field;
  if (field == "Z" || field == "X") return "gone";
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

}  // namespace

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : "unknown";
}

std::string new_claim_contents() {
  static std::atomic<unsigned> counter{0};
  const std::string process = std::to_string(::getpid());
  std::ostringstream text;
  text << first_line << "\nhost " << host_name() << "\nprocess " << process << "\nsince " << utc_now()
       << "\nspace " << process_space() << "\nstart " << start_of(process) << "\nnumber " << counter++
       << '\n';
  return text.str();
}

std::string claim_holder(const std::string& contents) {
  if (!contents.starts_with(first_line)) return "another process";
  return "process " + field_of(contents, "process") + " on " + field_of(contents, "host");
}

bool is_claim_of_a_dead_process(const std::string& contents) {
  const std::string space = field_of(contents, "space");
  const std::string start = field_of(contents, "start");
  const std::string process = field_of(contents, "process");
  // Virtual machines that were started from one snapshot share their boot, but not their name.
  if (space.empty() || start.empty() || space != process_space()) return false;
  if (field_of(contents, "host") != host_name()) return false;
  pid_t number = 0;
  const auto [end, error] = std::from_chars(process.data(), process.data() + process.size(), number);
  if (error != std::errc() || end != process.data() + process.size() || number <= 0) return false;
  if (::kill(number, 0) != 0 && errno == ESRCH) return true;
  // /proc may hide the processes of other users: then this one may be alive.
  const std::string now = start_of(process);
  return !now.empty() && now != start;
}

}  // namespace backlight
