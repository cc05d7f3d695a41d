// Runs the program in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace backlight::test {

/// Sanitizers take memory of their own, and replace the functions that tests/support/misfortune.cpp does.
#if defined(__has_feature)
#define BACKLIGHT_HAS_FEATURE(name) __has_feature(name)  // clang
#else
#define BACKLIGHT_HAS_FEATURE(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    BACKLIGHT_HAS_FEATURE(address_sanitizer) || BACKLIGHT_HAS_FEATURE(thread_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
#undef BACKLIGHT_HAS_FEATURE

struct Outcome {
  int code = -1;  ///< exit code; 1000 + n when killed by signal n
  std::string out;
  std::string err;
  double seconds = 0.0;
};

/// Each test works in an empty temporary folder, which is the program's current folder too.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Runs backlight with these arguments to its end. `environment` is added: "NAME=value". A run that takes
  /// more than two minutes is killed, and fails the test.
  Outcome run(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});

  /// The same, with `while_running(process id)` called right after the start.
  Outcome run_and(const std::vector<std::string>& arguments, const std::function<void(int)>& while_running);

  /// Starts the program and returns at once: several may run side by side, each under a label of its own.
  int start(const std::vector<std::string>& arguments, const std::string& label);
  /// Waits for the end of a process that start() began.
  Outcome finish(int process, const std::string& label);

  /// What the child does before it becomes the program: resource limits, another user.
  std::function<void()> in_child;

  /// Writes a file into the folder.
  void write(const std::string& name, const std::string& text) const;

  /// A small scene that renders in an instant, written as NAME.
  void write_scene(const std::string& name = "scene.toml", const std::string& more = "") const;

  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] bool exists(const std::string& name) const;
  /// All files in the folder and below, hidden ones too, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

  std::filesystem::path folder;
};

}  // namespace backlight::test
