// Tries mutated inputs, each under a watch: none may crash, take over 10 s of processor time or over 2 GB.
//
//   mutation_campaign KIND COUNT SEED FOUND FILE...    COUNT inputs made of the files; what fails is left in
//   FOUND mutation_campaign KIND replay FOLDER               the inputs of a folder as they are
//
// KIND is scene, image, texture, table or mesh. Exits 1 when an input failed. Inputs are tried in a process
// of their own, a batch in each.
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "backlight/base/files.h"
#include "mutation_targets.h"
#include "mutations.h"

// One input is measured with the checks of AddressSanitizer; leaks are looked for elsewhere.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "hard_rss_limit_mb=2048:detect_leaks=0:quarantine_size_mb=32:malloc_context_size=12";
}

namespace {

using namespace backlight;
namespace fs = std::filesystem;

constexpr std::size_t batch = 100;
constexpr int most_seconds = 10;        // of processor time
constexpr unsigned most_waiting = 300;  // by the clock, for a machine that has other things to do
constexpr long most_kibibytes = 2L << 20;

const std::map<std::string, fuzz::Kind> kinds{{"scene", fuzz::Kind::scene},
                                              {"image", fuzz::Kind::image},
                                              {"texture", fuzz::Kind::texture},
                                              {"table", fuzz::Kind::table},
                                              {"mesh", fuzz::Kind::mesh}};

struct Seed {
  fs::path file;
  std::string bytes;
};

std::vector<Seed> read_seeds(char** begin, char** end) {
  std::vector<Seed> seeds;
  for (char** file = begin; file != end; ++file) {
    auto bytes = read_file(*file);
    if (!bytes.ok()) {
      std::fprintf(stderr, "%s\n", bytes.error().c_str());
      std::exit(2);
    }
    seeds.push_back({*file, std::move(bytes).value()});
  }
  return seeds;
}

/// Without the flush to the disk of write_file(): there are many.
void put(const fs::path& file, const std::string& bytes) {
  if (!(std::ofstream(file, std::ios::binary) << bytes << std::flush)) std::_Exit(99);
}

std::string mutated(fuzz::Kind kind, const Seed& seed, const Seed& other, fuzz::Random& random) {
  switch (kind) {
    case fuzz::Kind::scene:
      return fuzz::mutated_scene(seed.bytes, other.bytes, random);
    case fuzz::Kind::table:
      return fuzz::mutated_table(seed.bytes, other.bytes, random);
    case fuzz::Kind::mesh:
      if (seed.file.extension() != ".obj" || random.one_in(2)) break;
      return fuzz::mutated_table(seed.bytes, other.bytes, random);
    case fuzz::Kind::image:
    case fuzz::Kind::texture:
      break;
  }
  return fuzz::mutated_picture(seed.bytes, other.bytes, random);
}

void watch() {
  const itimerval limit{{0, 0}, {most_seconds, 0}};
  ::setitimer(ITIMER_PROF, &limit, nullptr);  // ends the process by SIGPROF
  ::alarm(most_waiting);
}

void require_little_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  if (usage.ru_maxrss <= most_kibibytes) return;
  std::fprintf(stderr, "%ld MiB of memory\n", usage.ru_maxrss >> 10);
  std::abort();
}

/// Runs `work` in a process of its own. Returns how that ended, in words, or an empty text.
std::string end_of(const std::function<void()>& work) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    std::_Exit(0);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return "no process";
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status)) return "exit " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  if (signal == SIGPROF || signal == SIGALRM) return "hang";
  return "signal " + std::to_string(signal);
}

/// The folder whose files a scene may name.
fs::path folder_of(const fs::path& file) {
  return fs::absolute(file).parent_path();
}

int campaign(fuzz::Kind kind, std::size_t count, std::uint64_t seed, const fs::path& found,
             const std::vector<Seed>& seeds) {
  fs::create_directories(found);
  const fs::path current = found / ("current-" + std::to_string(::getpid()));
  const fs::path place = found / ("place-" + std::to_string(::getpid()));
  std::size_t failures = 0;
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t end = std::min(count, begin + batch);
    const std::string ended = end_of([&] {
      for (std::size_t i = begin; i < end; ++i) {
        fuzz::Random random(seed + 0x9e3779b97f4a7c15ULL * (i + 1));  // each input of its own number alone
        const Seed& from = random.of(seeds);
        const std::string input = mutated(kind, from, random.of(seeds), random);
        // Meshes are read by the endings of their names.
        const std::string ending = kind == fuzz::Kind::mesh ? from.file.extension().string() : "";
        watch();
        put(current.string() + ending, input);
        put(place, std::to_string(i) + ending);
        fuzz::try_input(kind, current.string() + ending, folder_of(from.file));
        require_little_memory();
      }
    });
    if (ended.empty()) {
      begin = end;
      continue;
    }
    const std::string last = read_file(place).value();
    char* ending = nullptr;
    const std::size_t at = std::strtoull(last.c_str(), &ending, 10);
    ++failures;
    const fs::path kept = found / ("seed-" + std::to_string(seed) + "-input-" + std::to_string(at) + ending);
    fs::copy_file(current.string() + ending, kept, fs::copy_options::overwrite_existing);
    std::fprintf(stderr, "%s: %s\n", kept.c_str(), ended.c_str());
    begin = std::max(begin, at) + 1;
  }
  for (const char* ending : {"", ".obj", ".ply", ".stl", ".gltf", ".glb"})
    fs::remove(current.string() + ending);
  fs::remove(place);
  std::printf("%zu inputs tried, %zu failed\n", count, failures);
  return failures == 0 ? 0 : 1;
}

int replay(fuzz::Kind kind, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  int failures = 0;
  for (const fs::path& file : files) {
    const std::string ended = end_of([&] {
      watch();
      fuzz::try_input(kind, file, folder_of(file));
      require_little_memory();
    });
    if (ended.empty()) continue;
    ++failures;
    std::fprintf(stderr, "%s: %s\n", file.c_str(), ended.c_str());
  }
  std::printf("%zu inputs tried, %d failed\n", files.size(), failures);
  return files.empty() || failures > 0 ? 1 : 0;
}

}  // namespace

int main(int count, char** arguments) {
  const auto kind = count >= 4 ? kinds.find(arguments[1]) : kinds.end();
  if (kind != kinds.end() && std::string(arguments[2]) == "replay") return replay(kind->second, arguments[3]);
  if (kind == kinds.end() || count < 6) {
    std::fprintf(stderr, "mutation_campaign KIND COUNT SEED FOUND FILE... | KIND replay FOLDER\n");
    return 2;
  }
  return campaign(kind->second, std::strtoull(arguments[2], nullptr, 10),
                  std::strtoull(arguments[3], nullptr, 10), arguments[4],
                  read_seeds(arguments + 5, arguments + count));
}
