// What was written: a scene file with its includes and overrides, as a tree of values that know their place.
//
// Nothing is evaluated here: a number may still be an expression. The tree has been checked against the table
// of keys (keys.h): a value of the wrong type has been reported and is `Invalid`, so that later stages can go
// on and find the other mistakes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/expression/expression.h"

namespace backlight {

/// Where a value was written: small, because a scene may have millions of values. `source` is an index into
/// Description::sources; lines and columns as in SourceSpan; line 0 means nowhere in particular.
struct Place {
  std::uint32_t source = 0;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;
};

struct Node;
struct Entry;
using NodeArray = std::pmr::vector<Node>;
using NodeTable = std::pmr::vector<Entry>;  ///< in the order of the text

/// A value that was wrong and has been reported.
struct Invalid {};

/// A TOML date or time: no key takes one.
struct Date {};

/// One value as it was written. A string in the place of a number is an Expression.
struct Node {
  std::variant<Invalid, bool, double, std::string, Expression, NodeArray, NodeTable, Date> value;
  Place place;

  [[nodiscard]] bool valid() const { return !std::holds_alternative<Invalid>(value); }
  [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&value); }
  [[nodiscard]] const NodeArray* array() const { return std::get_if<NodeArray>(&value); }
  [[nodiscard]] const NodeTable* table() const { return std::get_if<NodeTable>(&value); }
  [[nodiscard]] NodeArray* array() { return std::get_if<NodeArray>(&value); }
  [[nodiscard]] NodeTable* table() { return std::get_if<NodeTable>(&value); }
};

/// `name = value`, or a table under its name.
struct Entry {
  std::string name;
  Place place;  ///< of the name
  Node node;
};

/// The entry of this name in a table, or null (also when `table` is not a table). Names are unique except in
/// the merged tables of several files, whose duplicates have been reported.
const Entry* find(const Node& table, std::string_view name);
Entry* find(Node& table, std::string_view name);

/// What every expression may use besides the parameters, by index into Description::variables: `t`, the
/// number of the image, and its scene time, which is what `t` means wherever no clock of a thing's own is
/// meant.
inline constexpr std::size_t variable_t = 0;
inline constexpr std::size_t variable_frame = 1;
inline constexpr std::size_t variable_image_time = 2;
inline constexpr std::size_t first_parameter = 3;

/// A scene as written.
struct Description {
  Description() = default;
  Description(Description&&) = default;
  Description& operator=(Description&&) = delete;  // the tree must go before its memory

  /// Where the values of files are: in few large pieces, apart from what is made of them, so that forgetting
  /// them leaves no gaps.
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory =
      std::make_unique<std::pmr::monotonic_buffer_resource>();
  std::string file;                                        ///< the scene file's path as given
  std::vector<std::shared_ptr<const SourceText>> sources;  ///< every text that was read, and the overrides
  std::vector<std::filesystem::path> folders;  ///< of each source: relative paths in it start here
  Node root;                                   ///< the merged tables
  std::vector<std::string>
      variables;  ///< of every expression: "t", "frame", "image_time", then the parameters
  std::vector<std::size_t> parameter_order;  ///< indices into `variables`: each after those that it uses
  /// By index into `variables`: whether it is `t` or a parameter whose formula uses `t`, if through others.
  /// Such a parameter is a formula and stands where it is used: its `t` is the `t` of that place.
  std::vector<bool> follows_t;
  std::vector<std::string> overrides;  ///< the -D overrides as given
  /// SHA-256 (hexadecimal) of the bytes of the scene file, followed by those of each included file in the
  /// order of reading. Without includes it is the digest of the file.
  std::string sha256;

  [[nodiscard]] SourceSpan span(const Place& place) const;

  /// Whether the expression depends on `t`, if through parameters. It is of `variables`, or of
  /// formula_variables().
  [[nodiscard]] bool depends_on_t(const Expression& expression) const;

  /// Where each of `variables` is written; null for those that are no parameters.
  [[nodiscard]] std::vector<const Entry*> parameters() const;

  /// Forgets what is in the picture, which is nearly all of a large scene, and the texts: of the film, the
  /// cameras, the animation and the parameters all stays, but for the lines shown beside errors.
  void forget_contents();
};

/// The formula of a surface may use x, y and z besides the variables of every expression: they come first.
/// `t` is then the object's own time.
inline constexpr std::size_t formula_coordinates = 3;
std::vector<std::string> formula_variables(const Description& description);

}  // namespace backlight
