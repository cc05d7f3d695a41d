// Libraries of the program's own that are loaded when they are first needed, because what they link is slow
// to load.
#pragma once

#include <string>
#include <utility>

#include "backlight/base/result.h"

namespace backlight {

/// One of them. It stays loaded.
class Module {
 public:
  /// Looks in the folder BACKLIGHT_MODULE_PATH of the environment, or without it in the executable's folder,
  /// ../lib/backlight and ../../lib/backlight. `purpose`: what it is for, as in "the module for PURPOSE". The
  /// failure lists where it looked.
  static Result<Module> load(const std::string& file_name, const std::string& purpose);

  /// Sets `function` to what has this name; false: there is no such thing.
  template <typename Function>
  [[nodiscard]] bool find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(symbol(name));
    return function != nullptr;
  }

  /// What to say where something is not found.
  [[nodiscard]] Failure of_another_version() const;

 private:
  Module(void* library, std::string place, std::string purpose)
      : library_(library), place_(std::move(place)), purpose_(std::move(purpose)) {}
  [[nodiscard]] void* symbol(const char* name) const;

  void* library_;
  std::string place_, purpose_;
};

}  // namespace backlight
