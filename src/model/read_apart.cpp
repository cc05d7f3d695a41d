#include "read_apart.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

namespace backlight::models {
namespace {

/// What the shared memory begins with. Behind it: the numbers of the corners, six of each material, the
/// lengths of the texts (of materials: name, texture, embedded; files; missing), the indices, the triangles'
/// materials, and the texts, each with a zero.
struct Head {
  std::uint64_t good, corners, has_normals, has_texture, triangles, materials, files, left_out, error_length;
};

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

/// A file of shared memory that is being written.
class SharedFile {
 public:
  SharedFile() : descriptor_(memfd_create("backlight-model", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail("there is no memory to share");
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;
  ~SharedFile() { close(descriptor_); }

  void write(const void* data, std::size_t size) const {
    const char* from = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, from, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail("it cannot be handed over");
      from += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  template <class T>
  void write(const std::vector<T>& values) const {
    write(values.data(), values.size() * sizeof(T));
  }
  void begin_again() const {
    if (ftruncate(descriptor_, 0) != 0 || lseek(descriptor_, 0, SEEK_SET) != 0)
      fail("it cannot be handed over");
  }
  [[nodiscard]] std::unique_ptr<SharedModel> map() const {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) fail("it cannot be handed over");
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size < sizeof(Head)) return nullptr;
    void* memory = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor_, 0);
    if (memory == MAP_FAILED) fail("it cannot be handed over");
    return std::make_unique<SharedModel>(memory, size);
  }

 private:
  int descriptor_;
};

void hand_over(const Read& read, const SharedFile& file) {
  std::vector<std::string_view> texts;
  std::vector<double> colours;
  for (const Material& its : read.materials) {
    texts.insert(texts.end(), {its.name, its.texture, its.embedded});
    colours.insert(colours.end(), its.color.begin(), its.color.end());
    colours.insert(colours.end(), its.emission.begin(), its.emission.end());
  }
  texts.insert(texts.end(), read.files.begin(), read.files.end());
  texts.push_back(read.missing);
  std::vector<std::uint64_t> lengths;
  for (const std::string_view text : texts) lengths.push_back(text.size());
  const Head head{1,
                  read.places.size(),
                  read.normals.empty() ? 0U : 1U,
                  read.texture.empty() ? 0U : 1U,
                  read.indices.size() / 3,
                  read.materials.size(),
                  read.files.size(),
                  read.left_out,
                  0};
  file.write(&head, sizeof head);
  file.write(read.places);
  file.write(read.normals);
  file.write(read.texture);
  file.write(colours);
  file.write(lengths);
  file.write(read.indices);
  file.write(read.materials_of_triangles);
  for (const std::string_view text : texts) {
    file.write(text.data(), text.size());
    file.write("", 1);
  }
}

void fill(const SharedModel& shared, const Head& head, BacklightModel& model, SharedModel& owner) {
  const char* at = shared.begin() + sizeof head;
  const auto take = [&]<class T>(const T*& into, std::size_t count) {
    into = reinterpret_cast<const T*>(at);
    at += count * sizeof(T);
  };
  model.corners = head.corners;
  take(model.places, 3 * head.corners);
  if (head.has_normals != 0) take(model.normals, 3 * head.corners);
  if (head.has_texture != 0) take(model.texture, 2 * head.corners);
  const double* colours = nullptr;
  const std::uint64_t* lengths = nullptr;
  take(colours, 6 * head.materials);
  take(lengths, 3 * head.materials + head.files + 1);
  model.triangles = head.triangles;
  take(model.indices, 3 * head.triangles);
  take(model.materials, head.triangles);
  const auto text = [&](std::size_t& length) {
    const char* its = at;
    length = *lengths++;
    at += length + 1;
    return length > 0 ? its : nullptr;
  };
  std::size_t length = 0;
  for (std::size_t i = 0; i < head.materials; ++i, colours += 6) {
    BacklightModelMaterial material{};
    std::copy_n(colours, 3, material.color);
    std::copy_n(colours + 3, 3, material.emission);
    const char* name = text(length);
    material.name = name != nullptr ? name : "";
    material.texture = text(length);
    material.embedded = text(material.embedded_size);
    owner.materials.push_back(material);
  }
  for (std::size_t i = 0; i < head.files; ++i) owner.files.push_back(text(length));
  model.missing = text(length);
  model.material_count = head.materials;
  model.material = owner.materials.data();
  model.file_count = head.files;
  model.files = owner.files.data();
  model.left_out = head.left_out;
}

/// Of the processor: some, and one for each megabyte.
rlim_t most_seconds(std::uintmax_t file_size) {
  return 5 + static_cast<rlim_t>(file_size / 1'000'000);
}

/// The data of this process, in bytes.
std::uint64_t data_size() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t all = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  statm >> all >> resident >> shared >> text >> library >> data;
  return data * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// In the new process: with memory for what such a file may be, and no traces of a crash.
void limit(std::uintmax_t file_size) {
  constexpr std::uint64_t times_file = 80, besides = std::uint64_t{1} << 29;
  const auto set = [](int what, rlim_t most) {
    rlimit its{};
    if (getrlimit(static_cast<__rlimit_resource>(what), &its) != 0) return;
    its.rlim_cur = std::min(its.rlim_max, most);
    setrlimit(static_cast<__rlimit_resource>(what), &its);
  };
#if !defined(__SANITIZE_ADDRESS__)
  set(RLIMIT_DATA, data_size() + besides + times_file * file_size);
#endif
  set(RLIMIT_CPU, most_seconds(file_size));
  set(RLIMIT_CORE, 0);
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) dup2(nowhere, 2);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGHUP, SIGXCPU})
    std::signal(signal, SIG_DFL);
}

void run(const std::function<Read()>& read, std::uintmax_t file_size, const SharedFile& file) {
  std::string text = "it is damaged";
  try {
    limit(file_size);
    hand_over(read(), file);
    return;
  } catch (const std::bad_alloc&) {
    text = "it takes more memory than such a file needs: it is damaged";
  } catch (const std::exception& exception) {
    text = exception.what();
  } catch (...) {
  }
  file.begin_again();
  Head head{};
  head.error_length = text.size();
  file.write(&head, sizeof head);
  file.write(text.data(), text.size());
}

}  // namespace

SharedModel::~SharedModel() {
  munmap(memory_, size_);
}

std::unique_ptr<SharedModel> read_apart(const std::function<Read()>& read, std::uintmax_t file_size,
                                        BacklightModel& model) {
  const SharedFile file;
  const pid_t child = fork();
  if (child < 0) fail("there is no process to read it");
  if (child == 0) {
    run(read, file_size, file);
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail("the process that reads it is lost");
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw std::runtime_error("it takes more than " + std::to_string(most_seconds(file_size)) + " s to read");
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) throw std::runtime_error("its reader was killed");
  auto shared = file.map();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !shared)
    throw std::runtime_error("it is damaged, or made in a way that its reader does not know");
  Head head;
  std::memcpy(&head, shared->begin(), sizeof head);
  if (head.good == 0) throw std::runtime_error(std::string(shared->begin() + sizeof head, head.error_length));
  fill(*shared, head, model, *shared);
  return shared;
}

}  // namespace backlight::models
