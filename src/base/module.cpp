#include "backlight/base/module.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace backlight {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> places(const std::string& file_name) {
  if (const char* folder = std::getenv("BACKLIGHT_MODULE_PATH"); folder != nullptr && *folder != '\0') {
    return {fs::path(folder) / file_name};
  }
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path up = folder.parent_path();
  return {folder / file_name, up / "lib" / "backlight" / file_name,
          up.parent_path() / "lib" / "backlight" / file_name};
}

}  // namespace

Result<Module> Module::load(const std::string& file_name, const std::string& purpose) {
  std::string looked;
  for (const fs::path& place : places(file_name)) {
    std::error_code error;
    if (!fs::exists(place, error)) {
      looked += "\n  not at " + place.string();
      continue;
    }
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) {
      return Failure{"cannot load the module for " + purpose + ": " + std::string(::dlerror())};
    }
    return Module(library, place.string(), purpose);
  }
  return Failure{"cannot find the module for " + purpose +
                 " (BACKLIGHT_MODULE_PATH names its folder):" + looked};
}

void* Module::symbol(const char* name) const {
  return ::dlsym(library_, name);
}

Failure Module::of_another_version() const {
  return {"the module for " + purpose_ + ", " + place_ + ", is of another version"};
}

}  // namespace backlight
