#include "backlight/base/thread_memory.h"

#include <pthread.h>

#include <new>

namespace backlight {
namespace {

// The last that a thread was given, each of which knows the one before. Not a thread_local with a destructor,
// which is what this is for.
pthread_key_t last_of_thread() {
  static const pthread_key_t key = [] {
    pthread_key_t made{};
    if (pthread_key_create(&made, &EndsWithThread::end_all) != 0) throw std::bad_alloc();
    return made;
  }();
  return key;
}

}  // namespace

void EndsWithThread::give_to_thread() {
  const pthread_key_t key = last_of_thread();
  before_ = static_cast<EndsWithThread*>(pthread_getspecific(key));
  if (pthread_setspecific(key, this) != 0) throw std::bad_alloc();
}

void EndsWithThread::end_all(void* last) {
  for (auto* next = static_cast<EndsWithThread*>(last); next != nullptr;) {
    EndsWithThread* const before = next->before_;
    delete next;
    next = before;
  }
}

}  // namespace backlight
