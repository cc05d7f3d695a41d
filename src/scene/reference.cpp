// docs/scene-reference.md, made from the table of keys.
#include <algorithm>
#include <variant>

#include "backlight/scene/keys.h"
#include "backlight/scene/schema.h"
#include "key_builders.h"
#include "words.h"

namespace backlight {
namespace {

constexpr std::string_view introduction = R"page(# The scene file

<!-- Made by `backlight schema --markdown` from the table of keys (src/scene/keys_*.cpp). Do not edit. -->

A scene is a TOML 1.0 file. `backlight check SCENE.toml` says whether it is right and what it needs, and
`backlight schema` prints a JSON Schema for editors.

- Axes are right-handed with y up. Angles are in degrees. Lengths and times are in scene units that `c` ties together.
- **Any number may be an expression** in a string: `"2*t + sin(pi*t)"`. It may use `t`, `image_time` (the scene
  time of the image in seconds), `frame` (its number in the animation), the parameters of `[params]`, the functions
  sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt cbrt abs floor min max pow mod clamp (radians, as in C),
  `^` for powers, and `pi` and `e`. `mod(a, b)` is a - b floor(a/b), with the sign of b: mod(-1, 3) is 2, unlike C's
  fmod.
- **`t` is a time in seconds, of the clock that the place has.** In what is about the picture or the camera it is
  `image_time`. In materials, in the strength of a light and in the formula of a surface it is the thing's own time when
  the light left it: so a ball at 0.9 c blinks by its own clock, and its rim later than its middle. In the place of an
  object or a light (`position`, `rotate`, `scale`) it is the time of its frame when the light left it: matter that
  moves; with `velocity = [0, 0, 0]` it is put somewhere else for each image instead. What has no clock of its own (a
  radius, a frame's origin) is evaluated anew for each image, everywhere at once and without the delay of light; that is
  told by a warning, unless it is written with `image_time`. A parameter that uses `t` is a formula, and its `t` is that
  of the place where it is used.
- Colors are linear Rec.709. *Film Y* is the luminance of a film value; white is 1.
- Mistakes are errors, reported all together: unknown keys, wrong types, duplicate names, references to nothing,
  speeds of c and more, numbers that are not finite. A definition of the scene file itself that nothing uses gives a
  warning.
- Lengths, times, `c`, accelerations, scales and the coefficients of a quadric are at most 1e50 in size; what must be
  greater than 0 of them is at least 1e-50. Arrays and tables are nested at most 256 deep, frames and parameters as
  deep as you like.
- The file is UTF-8 text of at most 256 MiB, and so are the files that it names for tables of numbers. Those may have
  commas, semicolons or tabs between the numbers, quotes about them, a line of names before them, and any ends of lines;
  a decimal point is a point. Of a spectrum the wavelengths are in nm: a table that lies below 10 nm or above 1e6 nm is
  an error, one without visible light a warning.
- `-D path=value` on the command line replaces a value: `-D camera.fov=40`, `-D c=5`, `-D params.v=0.9`,
  `-D object.tram.velocity=[0.9,0,0]` by the object's name, `-D light.1.intensity=50` by its number in the file.

## How things move

In every table that has these keys: `velocity`, or `beta`, or one of `gamma`, `celerity` and `rapidity` together with
`along`. Velocities are relative to the world. The last three are exact for any speed.
)page";

// Text within a cell of a table, where a bar would begin the next one.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string kind_of(const Key& key) {
  std::vector<std::string> kinds;
  for (const ValueForm& form : key.forms) {
    switch (form.kind) {
      case ValueKind::boolean:
        kinds.emplace_back("boolean");
        break;
      case ValueKind::number:
        kinds.emplace_back("number");
        break;
      case ValueKind::numbers:
        kinds.push_back(form.count == 0 ? "numbers" : std::to_string(form.count) + " numbers");
        break;
      case ValueKind::colours:
        kinds.push_back(std::to_string(form.count) + " colors");
        break;
      case ValueKind::points:
        kinds.push_back(std::to_string(form.count) + " points");
        break;
      case ValueKind::formula:
        kinds.push_back(form.count > 0 ? std::to_string(form.count) + " formulas" : "formula");
        break;
      case ValueKind::choice:
      case ValueKind::text:
        kinds.emplace_back("string");
        break;
      case ValueKind::choices:
        kinds.emplace_back("strings");
        break;
      case ValueKind::path:
        kinds.emplace_back("path");
        break;
      case ValueKind::paths:
        kinds.emplace_back("paths");
        break;
      case ValueKind::reference:
        kinds.push_back("name of a " + std::string(form.table));
        break;
      case ValueKind::table:
      case ValueKind::parameters:
        kinds.emplace_back("table");
        break;
      case ValueKind::tables:
      case ValueKind::named_tables:
        kinds.emplace_back("tables");
        break;
    }
  }
  return listed(kinds);
}

std::string default_of(const Key& key) {
  if (std::holds_alternative<Required>(key.value)) return "required";
  const std::string text = default_text(key);
  return text.empty() ? "" : "`" + text + "`";
}

std::string meaning_of(const Key& key) {
  std::string text(key.meaning);
  if (!key.choices.empty()) {
    std::vector<std::string> names;
    for (const std::string_view name : key.choices) names.push_back("`\"" + std::string(name) + "\"`");
    text += (key.forms.front().kind == ValueKind::choices ? " Any of " : " One of ") + listed(names) + ".";
  }
  if (key.clock == Clock::own && key.forms.front().kind != ValueKind::formula)
    text += " It may be a formula of its own time `t`.";
  const std::string range = key.range.words();
  if (!range.empty()) text += " Allowed: " + range + ".";
  return text;
}

constexpr std::string_view head_of_rows =
    "\n| key | type | default | unit | meaning |\n| --- | --- | --- | --- | --- |\n";

std::string row(const Key& key) {
  return "| `" + std::string(key.name) + "` | " + cell(kind_of(key)) + " | " + cell(default_of(key)) + " | " +
         cell(key.unit) + " | " + cell(meaning_of(key)) + " |\n";
}

std::vector<Key> motion_keys() {
  std::vector<Key> keys;
  key_builders::add_motion(keys);
  return keys;
}

// The rows of a table; those of motion, which many have, are told once, in a section of their own.
std::string rows(const std::vector<Key>& keys) {
  static const std::vector<Key> motion = motion_keys();
  const auto tells_motion = [](const Key& key) {
    return std::ranges::any_of(
        motion, [&key](const Key& of) { return of.name == key.name && of.meaning == key.meaning; });
  };
  std::string text(head_of_rows);
  std::string names;
  for (const Key& key : keys) {
    if (tells_motion(key)) {
      names += (names.empty() ? "`" : ", `") + std::string(key.name) + "`";
      if (&key == &keys.back() || !tells_motion(*(&key + 1))) {
        text += "| " + names + " |  |  |  | Its motion: [how things move](#how-things-move). |\n";
        names.clear();
      }
    } else {
      text += row(key);
    }
  }
  return text;
}

std::string motion_section() {
  std::string text(head_of_rows);
  for (const Key& key : motion_keys()) text += row(key);
  return text;
}

std::string section(const KeyTable& table) {
  std::string text = "\n## `" + std::string(table.heading) + "`";
  if (table.name.empty()) text = "\n## The top of the file";
  const std::size_t dot = table.name.find('.');
  const KeyTable* owner = dot == std::string_view::npos ? nullptr : find_table(table.name.substr(0, dot));
  if (owner != nullptr && !owner->selector.empty() && table.heading == owner->heading) {
    text = "\n### " + std::string(owner->selector) + " = \"" + std::string(table.name.substr(dot + 1)) + "\"";
  }
  text += "\n\n" + std::string(table.meaning) + "\n";
  return table.keys.empty() ? text : text + rows(table.keys);
}

}  // namespace

std::string reference_markdown() {
  std::string page = std::string(introduction) + motion_section();
  for (const KeyTable& table : key_tables()) page += section(table);
  return page;
}

}  // namespace backlight
