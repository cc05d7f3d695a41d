// The one table of what a scene file may contain. The check of a file, the JSON Schema (schema.h) and the
// reference page docs/scene-reference.md are all made from it.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "backlight/base/variant_guard.h"

namespace backlight {

enum class ValueKind {
  boolean,
  number,     ///< or an expression in a string
  numbers,    ///< an array of `count` numbers; any length (but zero) when count is 0
  colours,    ///< an array of `count` arrays of three numbers
  points,     ///< the same, of coordinates
  formula,    ///< an expression of x, y, z and what every expression may use, in a string; `count`: an array
  text,       ///< any string
  choice,     ///< one of the key's `choices`
  choices,    ///< an array of them
  path,       ///< of a file, relative to the file that names it
  paths,      ///< an array of them
  reference,  ///< the name of a [table.NAME], `table` being the form's
  table,      ///< one table, whose keys are those of `table`
  tables,     ///< an array of them
  named_tables,  ///< a table of tables: [table.NAME]
  parameters     ///< a table of numbers with names of the author's choice
};

/// What `t` is in the formulas of a key.
enum class Clock {
  image,   ///< the image's scene time: the key is about the picture, or the observer
  own,     ///< the thing's own time when the light left it
  motion,  ///< the time of the thing's frame when the light left it: matter moves
  /// The image's scene time, for want of a meaning: the thing is another one in each image, everywhere at
  /// once and without delay, of which `warn_of_things_made_anew` warns.
  anew
};

/// One way of writing a value.
struct ValueForm {
  ValueKind kind = ValueKind::number;
  int count = 0;           ///< for `numbers`, `colours` and `formula`
  std::string_view table;  ///< for the kinds that need one

  ValueForm(ValueKind of_kind, int of_count = 0, std::string_view of_table = {})
      : kind(of_kind), count(of_count), table(of_table) {}
};

/// Which numbers are allowed. Every number must be finite besides.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  bool above_least = false;     ///< `least` itself is not allowed
  bool below_greatest = false;  ///< `greatest` itself is not allowed
  bool whole = false;           ///< whole numbers only
  /// No larger in size than this, and of what must be positive no smaller than its inverse: so that squares
  /// of squares of lengths are numbers too.
  double magnitude = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool contains(double value) const;
  [[nodiscard]] bool is_positive() const { return least == 0.0 && above_least; }
  /// "greater than 0 and at most 1", "a whole number of at least 1"; empty when everything is allowed.
  [[nodiscard]] std::string words() const;
  /// Why a finite value is not allowed: "must be greater than 0", "must be at most 1e50 in size".
  [[nodiscard]] std::string complaint(double value) const;
};

/// The greatest size of lengths, times and what is made of them; the least of what must be positive is its
/// inverse.
inline constexpr double greatest_magnitude = 1e50;

/// Stands for a key's absence in the place of a default.
struct Nothing {};
/// The key must be written.
struct Required {};
using DefaultValue =
    std::variant<Nothing, Required, bool, double, std::vector<double>, std::string, VariantGuard>;

struct Key {
  std::string_view name;
  std::vector<ValueForm> forms;  ///< the ways of writing its value; the first is the usual one
  DefaultValue value;            ///< when it is not written
  std::string_view unit;
  std::string_view meaning;  ///< a sentence of Markdown
  Range range;
  std::vector<std::string_view> choices;
  Clock clock = Clock::image;
  std::string_view physically = {};  ///< of Clock::anew: which key changes as nature does; may be empty
};

/// The keys of one kind of table.
///
/// Where `selector` is not empty, it names the key that chooses a variant ("shape", "type"): the table then
/// has the keys of the table `name.CHOICE` besides, or of `variants_of.CHOICE` where that is not empty.
struct KeyTable {
  std::string_view name;
  std::string_view heading;  ///< how it is written in a file: "[camera]"
  std::string_view meaning;
  std::vector<Key> keys;
  std::string_view selector;
  std::string_view variants_of = {};
};

/// All tables, in the order of the reference page. "" is the top of a file.
const std::vector<KeyTable>& key_tables();

/// The table of this name, or null.
const KeyTable* find_table(std::string_view name);

/// The table of a table's variant, such as the keys of a sphere; null when there is none of this name.
const KeyTable* find_variant(const KeyTable& table, std::string_view choice);

/// The last word of a table's name: of a variant, the choice that it belongs to.
std::string_view choice_of(const KeyTable& variant);

/// The key of this name, or null.
const Key* find_key(const KeyTable& table, std::string_view name);

/// A default as it would be written in a file; empty for Nothing and Required.
std::string default_text(const Key& key);

/// A number in the fewest digits that give it back.
std::string number_text(double value);

}  // namespace backlight
