// Shorthand in which the table of keys is written.
#pragma once

#include <utility>
#include <vector>

#include "backlight/scene/keys.h"

namespace backlight::key_builders {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

inline Range at_least(double least) {
  return {.least = least};
}
inline Range above(double least) {
  return {.least = least, .above_least = true};
}
inline Range between(double least, double greatest) {
  return {.least = least, .greatest = greatest};
}
inline Range whole(double least, double greatest) {
  return {.least = least, .greatest = greatest, .whole = true};
}

/// What is measured in lengths and times has a greatest size.
inline Range limited(std::string_view unit, Range range) {
  if (unit == "s" || unit.starts_with("length")) range.magnitude = greatest_magnitude;
  return range;
}

inline Key number(std::string_view name, DefaultValue value, std::string_view unit, std::string_view meaning,
                  Range range = {}) {
  return {name, {ValueKind::number}, std::move(value), unit, meaning, limited(unit, range), {}};
}

inline Key numbers(std::string_view name, int count, DefaultValue value, std::string_view unit,
                   std::string_view meaning, Range range = {}) {
  return {name, {{ValueKind::numbers, count}}, std::move(value), unit, meaning, limited(unit, range), {}};
}

inline Key boolean(std::string_view name, DefaultValue value, std::string_view meaning) {
  return {name, {ValueKind::boolean}, std::move(value), "", meaning, {}, {}};
}

inline Key text(std::string_view name, std::string_view meaning) {
  return {name, {ValueKind::text}, Nothing{}, "", meaning, {}, {}};
}

inline Key choice(std::string_view name, DefaultValue value, std::vector<std::string_view> choices,
                  std::string_view meaning) {
  return {name, {ValueKind::choice}, std::move(value), "", meaning, {}, std::move(choices)};
}

inline Key points(std::string_view name, int count, std::string_view unit, std::string_view meaning) {
  return {name, {{ValueKind::points, count}}, Nothing{}, unit, meaning, limited(unit, {}), {}};
}

/// A key whose value is a table, a reference, a path, or one of several of them.
inline Key structured(std::string_view name, std::vector<ValueForm> forms, std::string_view meaning) {
  return {name, std::move(forms), Nothing{}, "", meaning, {}, {}};
}

/// `t` in it is the thing's own time.
inline Key own(Key key) {
  key.clock = Clock::own;
  return key;
}

/// As a formula of `t` it is motion of matter.
inline Key of_motion(Key key) {
  key.clock = Clock::motion;
  return key;
}

/// All other keys of these tables are Clock::anew, with what is physical instead.
void set_clocks(std::vector<KeyTable>& tables);

/// The five ways of saying how a thing moves.
void add_motion(std::vector<Key>& keys);

/// Motion, or the name of the frame in which a thing is at rest.
void add_motion_or_frame(std::vector<Key>& keys);
/// `rocket` of an object or a light.
void add_rocket(std::vector<Key>& keys);

std::vector<KeyTable> picture_tables();  ///< keys_picture.cpp: the top, params, animation, film, camera
std::vector<KeyTable> matter_tables();   ///< keys_matter.cpp: frame, material, object
std::vector<KeyTable> light_tables();    ///< keys_light.cpp: light, background, effects

}  // namespace backlight::key_builders
