// docs/scene-reference.md, made from the table of keys.
#include <variant>

#include "backlight/scene/keys.h"
#include "backlight/scene/schema.h"
#include "words.h"

namespace backlight {
namespace {

constexpr std::string_view introduction = R"page(# The scene file

<!-- Made by `backlight schema --markdown` from the table of keys (src/scene/keys_*.cpp). Do not edit. -->

A scene is a TOML 1.0 file. `backlight check SCENE.toml` says whether it is right and what it needs, and
`backlight schema` prints a JSON Schema for editors.

- Axes are right-handed with y up. Angles are in degrees. Lengths and times are in scene units that `c` ties together.
- **Any number may be an expression** in a string: `"2*t + sin(pi*t)"`. It may use `t` (the scene time of the image in
  seconds), `frame` (its number in the animation), the parameters of `[params]`, the functions sin cos tan asin acos
  atan atan2 sinh cosh tanh exp log sqrt cbrt abs floor min max pow mod clamp (radians, as in C), `^` for powers, and
  `pi` and `e`. `mod(a, b)` is a - b floor(a/b), with the sign of b: mod(-1, 3) is 2, unlike C's fmod.
- Colors are linear Rec.709. *Film Y* is the luminance of a film value; white is 1.
- Mistakes are errors, reported all together: unknown keys, wrong types, duplicate names, references to nothing,
  speeds of c and more, numbers that are not finite. A definition of the scene file itself that nothing uses gives a
  warning.
- `-D path=value` on the command line replaces a value: `-D camera.fov=40`, `-D c=5`, `-D params.v=0.9`,
  `-D object.tram.velocity=[0.9,0,0]` by the object's name, `-D light.1.intensity=50` by its number in the file.

How things move, in every table that has these keys: `velocity` (compare with `c`), or `beta` (in units of `c`), or one
of `gamma`, `celerity` and `rapidity` together with `along`. Velocities are relative to the world. The last three are
exact for any speed; `celerity` and `rapidity` may be negative, against `along`.
)page";

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
        kinds.emplace_back("formula");
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
  const std::string range = key.range.words();
  if (!range.empty()) text += " Allowed: " + range + ".";
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
  if (table.keys.empty()) return text;
  text += "\n| key | type | default | unit | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const Key& key : table.keys) {
    text += "| `" + std::string(key.name) + "` | " + kind_of(key) + " | " + default_of(key) + " | " +
            std::string(key.unit) + " | " + meaning_of(key) + " |\n";
  }
  return text;
}

}  // namespace

std::string reference_markdown() {
  std::string page(introduction);
  for (const KeyTable& table : key_tables()) page += section(table);
  return page;
}

}  // namespace backlight
