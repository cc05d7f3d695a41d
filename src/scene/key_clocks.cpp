// What `t` is in the keys of things.
#include <algorithm>

#include "key_builders.h"

namespace backlight::key_builders {
namespace {

struct Physically {
  std::string_view table;  // or what its name begins with, and a dot
  std::vector<std::string_view> keys;
  std::string_view instead;
};

constexpr std::string_view by_formula =
    "a scale that is a formula of t stretches its matter, and an implicit surface may have an f of t";
constexpr std::string_view by_path =
    "a position that is a formula of t is a path, with the velocity that comes of it";
constexpr std::string_view by_strength =
    "its strength (intensity, irradiance or radiance) may depend on t, the light's own time";

const std::vector<Physically>& ways() {
  static const std::vector<Physically> all{
      {"object.implicit", {"bounds"}, "write bounds that hold at all times"},
      {"object.union", {"bounds"}, "write bounds that hold at all times"},
      {"object.repeat", {"count", "step"}, ""},
      {"object",
       {"radius", "size", "height", "top_radius", "major", "minor", "coefficients", "blend"},
       by_formula},
      {"object", {"velocity", "beta", "gamma", "celerity", "rapidity", "along"}, by_path},
      {"light", {"velocity", "beta", "gamma", "celerity", "rapidity", "along"}, by_path},
      {"light", {"temperature", "color"}, by_strength},
      {"frame",
       {"velocity", "beta", "gamma", "celerity", "rapidity", "along", "origin", "origin_time"},
       "a frame is inertial: what is in it moves by a position that is a formula of t"},
      {"material.checker", {"size"}, "its colors may depend on t, the matter's own time"}};
  return all;
}

bool is_or_begins(std::string_view name, std::string_view with) {
  return name == with || (name.starts_with(with) && name[with.size()] == '.');
}

std::string_view way(std::string_view table, std::string_view key) {
  for (const Physically& one : ways()) {
    if (!is_or_begins(table, one.table)) continue;
    if (std::find(one.keys.begin(), one.keys.end(), key) != one.keys.end()) return one.instead;
  }
  return {};
}

}  // namespace

void set_clocks(std::vector<KeyTable>& tables) {
  for (KeyTable& table : tables) {
    for (Key& key : table.keys) {
      if (key.clock != Clock::image) continue;
      key.clock = Clock::anew;
      key.physically = way(table.name, key.name);
    }
  }
}

}  // namespace backlight::key_builders
