// What a thread keeps for itself from one call to the next.
#pragma once

namespace backlight {

/// Is destroyed when the thread ends that it was given to.
class EndsWithThread {
 public:
  EndsWithThread() = default;
  EndsWithThread(const EndsWithThread&) = delete;
  EndsWithThread& operator=(const EndsWithThread&) = delete;
  virtual ~EndsWithThread() = default;

  /// Destroys those of this thread that were given before `last`, and `last`.
  static void end_all(void* last);

 protected:
  /// From here on it is destroyed at the end of this thread. Throws std::bad_alloc, and nothing has changed.
  void give_to_thread();

 private:
  EndsWithThread* before_ = nullptr;
};

/// A T of each thread, made when the thread first asks for it. To be declared `static constinit
/// thread_local`. A thread_local of T would do but where memory fails: glibc ends the process if it cannot
/// note that a destructor is to be called, and this throws std::bad_alloc.
template <class T>
class ThreadMemory {
 public:
  constexpr ThreadMemory() = default;

  /// Made of these arguments when the thread first asks.
  template <class... Arguments>
  T& get(const Arguments&... arguments) {
    if (held_ == nullptr) held_ = Held::make(arguments...);
    return held_->value;
  }

 private:
  struct Held final : EndsWithThread {
    template <class... Arguments>
    explicit Held(const Arguments&... arguments) : value(arguments...) {}

    template <class... Arguments>
    static Held* make(const Arguments&... arguments) {
      Held* const held = new Held(arguments...);
      try {
        held->give_to_thread();
      } catch (...) {
        delete held;
        throw;
      }
      return held;
    }

    T value;
  };

  Held* held_ = nullptr;
};

}  // namespace backlight
