#include "backlight/scene/keys.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "key_builders.h"

namespace backlight {
namespace {

// The inverse of greatest_magnitude, as it is written.
constexpr double least_magnitude = 1e-50;

}  // namespace

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (value < least || (above_least && value == least)) return false;
  if (value > greatest || (below_greatest && value == greatest)) return false;
  if (std::abs(value) > magnitude || (std::isfinite(magnitude) && is_positive() && value < least_magnitude))
    return false;
  return !whole || value == std::floor(value);
}

std::string Range::complaint(double value) const {
  Range without = *this;
  without.magnitude = std::numeric_limits<double>::infinity();
  if (!without.contains(value)) return "must be " + words();
  return std::abs(value) > 1.0 ? "must be at most " + number_text(magnitude) + " in size"
                               : "must be at least " + number_text(least_magnitude);
}

std::string Range::words() const {
  std::string words;
  if (std::isfinite(least)) words = (above_least ? "greater than " : "at least ") + number_text(least);
  if (std::isfinite(greatest)) {
    if (!words.empty()) words += " and ";
    words += (below_greatest ? "less than " : "at most ") + number_text(greatest);
  }
  if (!whole) return words;
  return words.empty() ? "a whole number" : "a whole number, " + words;
}

const std::vector<KeyTable>& key_tables() {
  static const std::vector<KeyTable> tables = [] {
    std::vector<KeyTable> all = key_builders::picture_tables();
    for (auto* part : {key_builders::matter_tables, key_builders::light_tables}) {
      for (KeyTable& table : part()) all.push_back(std::move(table));
    }
    return all;
  }();
  return tables;
}

const KeyTable* find_table(std::string_view name) {
  const std::vector<KeyTable>& tables = key_tables();
  const auto found =
      std::find_if(tables.begin(), tables.end(), [&](const KeyTable& t) { return t.name == name; });
  return found == tables.end() ? nullptr : &*found;
}

const KeyTable* find_variant(const KeyTable& table, std::string_view choice) {
  const std::string_view owner = table.variants_of.empty() ? table.name : table.variants_of;
  return find_table(std::string(owner) + "." + std::string(choice));
}

std::string_view choice_of(const KeyTable& variant) {
  return variant.name.substr(variant.name.rfind('.') + 1);
}

const Key* find_key(const KeyTable& table, std::string_view name) {
  const auto found =
      std::find_if(table.keys.begin(), table.keys.end(), [&](const Key& key) { return key.name == name; });
  return found == table.keys.end() ? nullptr : &*found;
}

std::string number_text(double value) {
  char buffer[32];
  if (std::isnan(value)) return "nan";
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  std::string text(buffer, end.ptr);
  // 1e+07 is 1e7.
  for (std::size_t e = text.find('e'); e != std::string::npos && e + 2 < text.size();) {
    const std::size_t digit = text[e + 1] == '-' ? e + 2 : e + 1;
    if (text[digit] != '+' && text[digit] != '0') break;
    text.erase(digit, 1);
  }
  return text;
}

std::string default_text(const Key& key) {
  if (const auto* flag = std::get_if<bool>(&key.value)) return *flag ? "true" : "false";
  if (const auto* number = std::get_if<double>(&key.value)) return number_text(*number);
  if (const auto* text = std::get_if<std::string>(&key.value)) return '"' + *text + '"';
  const auto* numbers = std::get_if<std::vector<double>>(&key.value);
  if (numbers == nullptr) return {};
  std::string text = "[";
  for (std::size_t i = 0; i < numbers->size(); ++i) text += (i == 0 ? "" : ", ") + number_text((*numbers)[i]);
  return text + "]";
}

}  // namespace backlight

namespace backlight::key_builders {

void add_motion(std::vector<Key>& keys) {
  keys.push_back(
      numbers("velocity", 3, Nothing{}, "length/time",
              "Velocity, to be compared with `c`. At most one of `velocity`, `beta`, `gamma`, `celerity` "
              "and `rapidity` is given."));
  keys.push_back(numbers("beta", 3, Nothing{}, "c", "Velocity in units of `c`."));
  keys.push_back(number("gamma", Nothing{}, "", "Lorentz factor, with `along`.", between(1, 1e30)));
  keys.push_back(number("celerity", Nothing{}, "c",
                        "γβ, with `along`; a negative one moves against it. Exact for any γ, as `gamma` is.",
                        between(-1e30, 1e30)));
  keys.push_back(number("rapidity", Nothing{}, "", "artanh β, with `along`; a negative one moves against it.",
                        between(-70, 70)));
  keys.push_back(
      numbers("along", 3, Nothing{}, "",
              "The direction of motion for `gamma`, `celerity` and `rapidity`; of any length but zero."));
}

void add_motion_or_frame(std::vector<Key>& keys) {
  keys.push_back(
      {"frame",
       {{ValueKind::reference, 0, "frame"}},
       std::string("world"),
       "",
       "The frame in which it is at rest, and whose coordinates its `position` is given in: the name of "
       "a `[frame.NAME]`, or `\"world\"`. Not together with a velocity.",
       {},
       {}});
  add_motion(keys);
}

void add_rocket(std::vector<Key>& keys) {
  keys.push_back(structured("rocket", {{ValueKind::table, 0, "rocket"}},
                            "It accelerates: at rest at `position` at time 0 of its frame, or of the frame "
                            "that its velocity makes."));
}

}  // namespace backlight::key_builders
