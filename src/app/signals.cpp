#include "signals.h"

#include <signal.h>
#include <unistd.h>

#include "exit_codes.h"

namespace backlight {
namespace {

// A signal handler reaches nothing but globals, and of these only lock-free atomics.
std::atomic<bool> requested{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void backlight_on_stop_signal(int number) {
  int none = 0;
  if (!first_signal.compare_exchange_strong(none, number)) _exit(exit_stopped + number);
  requested.store(true);
}

}  // namespace

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = backlight_on_stop_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& stop_requested() {
  return requested;
}

int stop_signal() {
  return first_signal.load();
}

}  // namespace backlight
