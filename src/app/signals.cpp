#include "signals.h"

#include <signal.h>
#include <unistd.h>

#include "exit_codes.h"

namespace backlight {
namespace {

// A signal handler reaches nothing but globals, and of these only lock-free atomics.
std::atomic<bool> requested{false};
std::atomic<bool> pause{false};
std::atomic<bool> snapshot{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

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
  signal(SIGXFSZ, SIG_IGN);
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
