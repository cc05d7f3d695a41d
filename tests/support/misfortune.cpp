// A library that tests load into the program ahead of all others (LD_PRELOAD), and that lets things go wrong.
// What it does is told by environment variables; without them, nothing.
//
//   MISFORTUNE=KIND:N:ERRNO   the N-th call of a kind from the begin of main() fails with that number; with
//                             KIND:N+:ERRNO, all from the N-th on. The kinds are the names below. For write,
//                             ERRNO 0 is a short write: half of the bytes. A failing close closes all the
//                             same.
//   MISFORTUNE_COUNTS=FILE    at the end, writes how many calls there were: "KIND COUNT" a line.
//   MISFORTUNE_SIGNAL=N       sends the process this signal while it is being loaded, before main().
//   MISFORTUNE_WEATHER=FILE   two 64-bit integers in a file, looked at whenever they matter: seconds that the
//                             clock of the day is off, and whether the disk is full.
//
// Calls on the standard streams are left alone, or a test could not read what the program says.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum Kind {
  k_open,
  k_read,
  k_write,
  k_close,
  k_fsync,
  k_rename,
  k_link,
  k_unlink,
  k_mkdir,
  k_truncate,
  k_stat,
  k_memory,
  k_thread,
  kind_count
};
const char* const kind_names[kind_count] = {"open",   "read",   "write",  "close", "fsync",
                                            "rename", "link",   "unlink", "mkdir", "truncate",
                                            "stat",   "memory", "thread"};

struct Weather {
  volatile std::int64_t clock_is_off;
  volatile std::int64_t disk_is_full;
};

std::atomic<bool> armed{false};
std::atomic<long> counts[kind_count];
int failing_kind = -1;
long failing_call = 0;
bool and_all_after = false;
int failing_errno = 0;
char counts_file[4096];
Weather fair{0, 0};
Weather* weather = &fair;

// Whether this call is to fail, with errno set. It is counted in any case.
bool fails(Kind kind) {
  if (!armed.load(std::memory_order_relaxed)) return false;
  const long number = counts[kind].fetch_add(1) + 1;
  if (kind != failing_kind || (and_all_after ? number < failing_call : number != failing_call)) return false;
  errno = failing_errno;
  return true;
}

bool disk_is_full() {
  if (weather->disk_is_full == 0 || !armed.load(std::memory_order_relaxed)) return false;
  errno = ENOSPC;
  return true;
}

bool is_new(const char* path) {
  return syscall(SYS_faccessat, AT_FDCWD, path, F_OK) != 0;
}

template <class Function>
Function next(Function /*itself*/, const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

[[gnu::constructor]] void begin() {
  if (const char* text = getenv("MISFORTUNE")) {
    char kind[32] = "";
    char rest[64] = "";
    if (sscanf(text, "%31[a-z]:%ld%63s", kind, &failing_call, rest) == 3) {
      and_all_after = rest[0] == '+';
      failing_errno = atoi(rest + (and_all_after ? 2 : 1));
      for (int i = 0; i < kind_count; ++i) {
        if (strcmp(kind, kind_names[i]) == 0) failing_kind = i;
      }
    }
    if (failing_kind < 0) {
      fprintf(stderr, "misfortune: cannot read MISFORTUNE=%s\n", text);
      _exit(125);
    }
  }
  if (const char* file = getenv("MISFORTUNE_COUNTS")) snprintf(counts_file, sizeof counts_file, "%s", file);
  if (const char* file = getenv("MISFORTUNE_WEATHER")) {
    const int descriptor = static_cast<int>(syscall(SYS_openat, AT_FDCWD, file, O_RDONLY | O_CLOEXEC));
    void* mapped = mmap(nullptr, sizeof(Weather), PROT_READ, MAP_SHARED, descriptor, 0);
    if (descriptor < 0 || mapped == MAP_FAILED) {
      fprintf(stderr, "misfortune: cannot read %s\n", file);
      _exit(125);
    }
    syscall(SYS_close, descriptor);
    weather = static_cast<Weather*>(mapped);
  }
  if (const char* number = getenv("MISFORTUNE_SIGNAL")) kill(getpid(), atoi(number));
}

[[gnu::destructor]] void end() {
  armed.store(false);
  if (counts_file[0] == '\0') return;
  char text[1024];
  int size = 0;
  for (int i = 0; i < kind_count; ++i) {
    size += snprintf(text + size, sizeof text - static_cast<std::size_t>(size), "%s %ld\n", kind_names[i],
                     counts[i].load());
  }
  const long descriptor = syscall(SYS_openat, AT_FDCWD, counts_file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  syscall(SYS_write, descriptor, text, size);
  syscall(SYS_close, descriptor);
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int armed_main(int count, char** arguments, char** environment) {
  armed.store(true);
  return real_main(count, arguments, environment);
}

}  // namespace

extern "C" {

// What is loaded with the program is not counted, nor what its libraries do before main().
int __libc_start_main(Main main, int count, char** arguments, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  real_main = main;
  return next(&__libc_start_main, "__libc_start_main")(armed_main, count, arguments, init, fini, rtld_fini,
                                                       stack_end);
}

#define OPEN(name)                                                             \
  int name(const char* path, int flags, ...) {                                 \
    va_list list;                                                              \
    va_start(list, flags);                                                     \
    const mode_t mode = va_arg(list, mode_t);                                  \
    va_end(list);                                                              \
    if ((flags & O_CREAT) != 0 && is_new(path) && disk_is_full()) return -1;   \
    if (fails(k_open)) return -1;                                              \
    return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode)); \
  }
OPEN(open)
OPEN(open64)

ssize_t read(int descriptor, void* bytes, size_t size) {
  if (descriptor > 2 && fails(k_read)) return -1;
  return syscall(SYS_read, descriptor, bytes, size);
}

#define PREAD(name)                                                          \
  ssize_t name(int descriptor, void* bytes, size_t size, off64_t position) { \
    if (descriptor > 2 && fails(k_read)) return -1;                          \
    return syscall(SYS_pread64, descriptor, bytes, size, position);          \
  }
PREAD(pread)
PREAD(pread64)

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (descriptor > 2 && disk_is_full()) return -1;
  if (descriptor > 2 && fails(k_write)) {
    if (failing_errno != 0) return -1;
    size = (size + 1) / 2;
  }
  return syscall(SYS_write, descriptor, bytes, size);
}

#define PWRITE(name)                                                               \
  ssize_t name(int descriptor, const void* bytes, size_t size, off64_t position) { \
    if (disk_is_full()) return -1;                                                 \
    if (fails(k_write)) {                                                          \
      if (failing_errno != 0) return -1;                                           \
      size = (size + 1) / 2;                                                       \
    }                                                                              \
    return syscall(SYS_pwrite64, descriptor, bytes, size, position);               \
  }
PWRITE(pwrite)
PWRITE(pwrite64)

int close(int descriptor) {
  const bool failed = descriptor > 2 && fails(k_close);
  const int result = static_cast<int>(syscall(SYS_close, descriptor));
  if (!failed) return result;
  errno = failing_errno;
  return -1;
}

int fsync(int descriptor) {
  if (fails(k_fsync)) return -1;
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

int fdatasync(int descriptor) {
  if (fails(k_fsync)) return -1;
  return static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

int rename(const char* from, const char* to) noexcept {
  if (fails(k_rename)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int link(const char* from, const char* to) noexcept {
  if (disk_is_full() || fails(k_link)) return -1;
  return static_cast<int>(syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  if (disk_is_full() || fails(k_link)) return -1;
  return static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}

int unlink(const char* path) noexcept {
  if (fails(k_unlink)) return -1;
  return static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}

int remove(const char* path) noexcept {
  if (fails(k_unlink)) return -1;
  return next(&remove, "remove")(path);
}

int mkdir(const char* path, mode_t mode) noexcept {
  if (disk_is_full() || fails(k_mkdir)) return -1;
  return static_cast<int>(syscall(SYS_mkdirat, AT_FDCWD, path, mode));
}

int ftruncate(int descriptor, off_t size) noexcept {
  if (fails(k_truncate)) return -1;
  return static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}

int stat(const char* path, struct stat* status) noexcept {
  if (fails(k_stat)) return -1;
  return next(&stat, "stat")(path, status);
}

int lstat(const char* path, struct stat* status) noexcept {
  if (fails(k_stat)) return -1;
  return next(&lstat, "lstat")(path, status);
}

int fstat(int descriptor, struct stat* status) noexcept {
  if (fails(k_stat)) return -1;
  return next(&fstat, "fstat")(descriptor, status);
}

// The C library's own, by the names that it gives them: dlsym() would call malloc().
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) noexcept {
  return fails(k_memory) ? nullptr : __libc_malloc(size);
}

void* calloc(size_t count, size_t size) noexcept {
  return fails(k_memory) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) noexcept {
  return fails(k_memory) ? nullptr : __libc_realloc(old, size);
}

void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return fails(k_memory) ? nullptr : __libc_memalign(alignment, size);
}

void* memalign(size_t alignment, size_t size) noexcept {
  return fails(k_memory) ? nullptr : __libc_memalign(alignment, size);
}

int posix_memalign(void** result, size_t alignment, size_t size) noexcept {
  if (fails(k_memory)) return ENOMEM;
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                   void* argument) noexcept {
  if (fails(k_thread)) return failing_errno;
  return next(&pthread_create, "pthread_create")(thread, attributes, work, argument);
}

int clock_gettime(clockid_t clock, struct timespec* now) noexcept {
  const int result = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  if (result == 0 && clock == CLOCK_REALTIME) now->tv_sec += weather->clock_is_off;
  return result;
}

time_t time(time_t* seconds) noexcept {
  struct timespec now {};
  clock_gettime(CLOCK_REALTIME, &now);
  if (seconds != nullptr) *seconds = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"
