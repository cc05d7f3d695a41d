#include "signals.h"

#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

#include "exit_codes.h"

namespace backlight {
namespace {

// A signal handler reaches nothing but globals, and of these only lock-free atomics.
std::atomic<bool> requested{false};
std::atomic<bool> pause{false};
std::atomic<bool> snapshot{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// As the kernel has it.
using SignalMask = std::uint64_t;

constexpr SignalMask mask_of(int number) {
  return SignalMask{1} << static_cast<unsigned>(number - 1);
}

SignalMask mask_at_begin = 0;
bool pipes_were_ignored = false;

// The C library runs this when it has itself in order, before the constructors of any library, those of
// sanitizers among them.
extern "C" __attribute__((no_sanitize("address", "thread", "undefined"))) void backlight_hold_signals() {
  const SignalMask held = mask_of(SIGINT) | mask_of(SIGTERM) | mask_of(SIGHUP) | mask_of(SIGUSR1);
  // Not by sigprocmask(), which sanitizers replace by one that is not ready yet.
  syscall(SYS_rt_sigprocmask, SIG_BLOCK, &held, &mask_at_begin, sizeof held);
}

[[gnu::section(".preinit_array"), gnu::used]] void (*const at_the_very_begin)() = backlight_hold_signals;

extern "C" void backlight_on_stop_signal(int number) {
  int none = 0;
  if (!first_signal.compare_exchange_strong(none, number)) _exit(exit_stopped + number);
  requested.store(true);
  pause.store(true);
}

extern "C" void backlight_on_snapshot_signal(int /*number*/) {
  snapshot.store(true);
  pause.store(true);
}

void catch_unless_ignored(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  struct sigaction before {};
  sigaction(number, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
}

}  // namespace

void catch_stop_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) catch_unless_ignored(number, backlight_on_stop_signal);
  catch_unless_ignored(SIGUSR1, backlight_on_snapshot_signal);
}

void release_held_signals() {
  syscall(SYS_rt_sigprocmask, SIG_SETMASK, &mask_at_begin, nullptr, sizeof mask_at_begin);
}

void make_signals_of_writing_errors() {
  signal(SIGXFSZ, SIG_IGN);
  pipes_were_ignored = signal(SIGPIPE, SIG_IGN) == SIG_IGN;
}

void end_by_broken_pipe() {
  if (pipes_were_ignored) return;
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}

const std::atomic<bool>& stop_requested() {
  return requested;
}

const std::atomic<bool>& pause_requested() {
  return pause;
}

bool take_snapshot_request() {
  const bool wanted = snapshot.exchange(false);
  pause.store(false);
  if (requested.load()) pause.store(true);  // a signal to stop may have come in between
  return wanted;
}

int stop_signal() {
  return first_signal.load();
}

}  // namespace backlight
