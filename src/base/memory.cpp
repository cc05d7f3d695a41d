#include "backlight/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace backlight {
namespace {

namespace fs = std::filesystem;

/// The number after a word at the beginning of a line, or of the whole file where `word` is empty; nothing
/// where there is none ("max").
std::optional<std::uint64_t> number_in(const fs::path& path, std::string_view word = "") {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    if (!line.starts_with(word)) continue;
    std::istringstream rest(line.substr(word.size()));
    std::uint64_t number = 0;
    if (rest >> number) return number;
    return std::nullopt;
  }
  return std::nullopt;
}

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) {
  return limit > used ? limit - used : 0;
}

void lower(std::optional<MemoryLeft>& least, std::uint64_t bytes, const char* where) {
  if (!least || bytes < least->bytes) least = MemoryLeft{bytes, where};
}

/// How a version of control groups names its files.
struct GroupFiles {
  const char* limit;
  const char* usage;
  const char* droppable;
};
constexpr GroupFiles version_1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "};
constexpr GroupFiles version_2{"memory.max", "memory.current", "inactive_file "};

/// A group and those that it is in: each may have a limit.
void look_at_groups(const fs::path& mount, fs::path group, const GroupFiles& files,
                    std::optional<MemoryLeft>& least) {
  for (;; group = group.parent_path()) {
    const fs::path folder = mount / group;
    const auto limit = number_in(folder / files.limit);
    const auto usage = number_in(folder / files.usage);
    if (limit && usage) {
      const std::uint64_t dropped = number_in(folder / "memory.stat", files.droppable).value_or(0);
      lower(least, difference(*limit, difference(*usage, dropped)), "left in the control group");
    }
    if (group.empty()) return;
  }
}

/// The groups that /proc/self/cgroup names, in lines NUMBER:CONTROLLERS:/PATH. In a container the path may be
/// that of the host, which is not to be seen: the container's own group is then the root of what is.
void look_at_groups(const fs::path& root, std::optional<MemoryLeft>& least) {
  std::ifstream file(root / "proc/self/cgroup");
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path group = fs::path(line.substr(second + 1)).relative_path();
    if (controllers == ",,") look_at_groups(root / "sys/fs/cgroup", group, version_2, least);
    if (controllers.find(",memory,") != std::string::npos)
      look_at_groups(root / "sys/fs/cgroup/memory", group, version_1, least);
  }
}

}  // namespace

void return_freed_memory(std::size_t bytes) {
  if (bytes < std::size_t{1} << 20U) return;
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

std::optional<MemoryLeft> memory_left(const fs::path& root) {
  std::optional<MemoryLeft> least;
  const fs::path information = root / "proc/meminfo";  // in KiB
  if (const auto available = number_in(information, "MemAvailable:")) {
    const std::uint64_t swap = number_in(information, "SwapFree:").value_or(0);
    lower(least, (*available + swap) << 10U, "free on this machine");
  }
  look_at_groups(root, least);
  rlimit limit{};
  const auto pages = number_in(root / "proc/self/statm");
  if (pages && ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    lower(least, difference(limit.rlim_cur, *pages * page), "left by ulimit -v");
  }
  return least;
}

std::string memory_words(std::uint64_t bytes) {
  constexpr std::array units{"KiB", "MiB", "GiB", "TiB"};
  double size = static_cast<double>(bytes) / 1024.0;
  std::size_t unit = 0;
  while (size >= 1000.0 && unit + 1 < units.size()) {
    size /= 1024.0;
    ++unit;
  }
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), size < 10.0 && unit > 0 ? "%.1f %s" : "%.0f %s", size, units[unit]);
  return text.data();
}

}  // namespace backlight
