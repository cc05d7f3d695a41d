#include "backlight/scene/schema.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "backlight/scene/keys.h"
#include "json.h"

namespace backlight {
namespace {

std::vector<Json> texts(const std::vector<std::string_view>& names) {
  std::vector<Json> list;
  for (const std::string_view name : names) list.push_back(Json::text(name));
  return list;
}

Json of_type(std::string_view type) {
  return std::move(Json::object().add("type", Json::text(type)));
}

Json reference(std::string_view definition) {
  return std::move(Json::object().add("$ref", Json::text("#/$defs/" + std::string(definition))));
}

// A number of the range, or any expression: its value is not an editor's business.
Json number_schema(const Range& range) {
  Json number = of_type(range.whole ? "integer" : "number");
  if (std::isfinite(range.least)) {
    number.add(range.above_least ? "exclusiveMinimum" : "minimum", Json::number(range.least));
  }
  if (std::isfinite(range.greatest)) {
    number.add(range.below_greatest ? "exclusiveMaximum" : "maximum", Json::number(range.greatest));
  }
  return std::move(Json::object().add("anyOf", Json::array({number, reference("expression")})));
}

Json array_of(Json items, int count) {
  Json array = of_type("array");
  array.add("items", std::move(items));
  if (count > 0) array.add("minItems", Json::number(count)).add("maxItems", Json::number(count));
  if (count == 0) array.add("minItems", Json::number(1));
  return array;
}

Json list_of(Json items) {
  return std::move(of_type("array").add("items", std::move(items)));
}

Json table_of(Json values) {
  return std::move(of_type("object").add("additionalProperties", std::move(values)));
}

Json form_schema(const Key& key, const ValueForm& form) {
  switch (form.kind) {
    case ValueKind::boolean:
      return of_type("boolean");
    case ValueKind::number:
      return number_schema(key.range);
    case ValueKind::numbers:
      return array_of(number_schema(key.range), form.count);
    case ValueKind::colours:
    case ValueKind::points:
      return array_of(array_of(number_schema(key.range), 3), form.count);
    case ValueKind::choice:
      return std::move(Json::object().add("enum", Json::array(texts(key.choices))));
    case ValueKind::choices:
      return list_of(std::move(Json::object().add("enum", Json::array(texts(key.choices)))));
    case ValueKind::formula:
      return form.count > 0 ? array_of(number_schema(key.range), form.count) : of_type("string");
    case ValueKind::text:
    case ValueKind::path:
    case ValueKind::reference:
      return of_type("string");
    case ValueKind::paths:
      return list_of(of_type("string"));
    case ValueKind::table:
      return reference(form.table);
    case ValueKind::tables:
      return list_of(reference(form.table));
    case ValueKind::named_tables:
      return table_of(reference(form.table));
    case ValueKind::parameters:
      return table_of(number_schema({}));
  }
  return Json::object();
}

void add_default(Json& schema, const Key& key) {
  if (const auto* flag = std::get_if<bool>(&key.value)) schema.add("default", Json::boolean(*flag));
  if (const auto* number = std::get_if<double>(&key.value)) schema.add("default", Json::number(*number));
  if (const auto* text = std::get_if<std::string>(&key.value)) schema.add("default", Json::text(*text));
  if (const auto* numbers = std::get_if<std::vector<double>>(&key.value)) {
    std::vector<Json> list;
    for (const double number : *numbers) list.push_back(Json::number(number));
    schema.add("default", Json::array(list));
  }
}

std::string description_of(const Key& key) {
  std::string description(key.meaning);
  if (!key.unit.empty()) description += " Unit: " + std::string(key.unit) + ".";
  return description;
}

// Beside a $ref older checkers see nothing else: it stands within an anyOf. No allOf: of that the language
// server of taplo shows no description, and it never ends when it completes keys.
Json key_schema(const Key& key) {
  Json schema = Json::object();
  if (key.forms.size() == 1 && key.forms.front().kind != ValueKind::table) {
    schema = form_schema(key, key.forms.front());
  } else {
    std::vector<Json> forms;
    for (const ValueForm& form : key.forms) forms.push_back(form_schema(key, form));
    schema.add("anyOf", Json::array(forms));
  }
  schema.add("description", Json::text(description_of(key)));
  add_default(schema, key);
  return schema;
}

std::vector<Json> required_keys(const KeyTable& table) {
  std::vector<Json> names;
  for (const Key& key : table.keys) {
    if (std::holds_alternative<Required>(key.value)) names.push_back(Json::text(key.name));
  }
  return names;
}

void add_keys(Json& properties, const KeyTable& table) {
  for (const Key& key : table.keys) properties.add(key.name, key_schema(key));
}

std::vector<const KeyTable*> variants_of(const KeyTable& table) {
  std::vector<const KeyTable*> variants;
  if (table.selector.empty()) return variants;
  for (const std::string_view choice : find_key(table, table.selector)->choices)
    variants.push_back(find_variant(table, choice));
  return variants;
}

// What a key means in each of the variants that have it; what it may hold is said by the variants alone.
Json meanings_schema(const KeyTable& table, std::string_view name) {
  std::string meanings;
  for (const KeyTable* variant : variants_of(table)) {
    const Key* key = find_key(*variant, name);
    if (key == nullptr) continue;
    meanings +=
        (meanings.empty() ? "`" : " `") + std::string(choice_of(*variant)) + "`: " + description_of(*key);
  }
  return std::move(Json::object().add("description", Json::text(meanings)));
}

// The keys of all variants, each once: an editor offers them before a choice is written. Without defaults,
// which some checkers fill in, whatever the choice.
void add_variants_keys(Json& properties, const KeyTable& table) {
  std::vector<std::string_view> added;
  for (const KeyTable* variant : variants_of(table)) {
    for (const Key& key : variant->keys) {
      if (find_key(table, key.name) != nullptr) continue;  // the variant's row has it more exactly
      if (std::find(added.begin(), added.end(), key.name) != added.end()) continue;
      added.push_back(key.name);
      properties.add(key.name, meanings_schema(table, key.name));
    }
  }
}

// All keys that a table may have with this choice.
Json names_with(const KeyTable& table, const KeyTable& variant) {
  std::vector<std::string_view> names;
  for (const Key& key : table.keys) names.push_back(key.name);
  for (const Key& key : variant.keys) {
    if (find_key(table, key.name) == nullptr) names.push_back(key.name);
  }
  return std::move(Json::object().add("enum", Json::array(texts(names))));
}

// "If the shape is a sphere, its keys are these." The default choice is also meant when none is written.
Json variant_schema(const KeyTable& table, std::string_view choice) {
  const Key& selector = *find_key(table, table.selector);
  const KeyTable& variant = *find_variant(table, choice);
  Json condition = Json::object();
  Json selected = Json::object();
  selected.add(selector.name, std::move(Json::object().add("const", Json::text(choice))));
  condition.add("properties", std::move(selected));
  const auto* usual = std::get_if<std::string>(&selector.value);
  if (usual == nullptr || *usual != choice)
    condition.add("required", Json::array({Json::text(selector.name)}));
  Json properties = Json::object();
  add_keys(properties, variant);
  Json consequence = Json::object();
  consequence.add("properties", std::move(properties));
  consequence.add("propertyNames", names_with(table, variant));
  if (const auto required = required_keys(variant); !required.empty()) {
    consequence.add("required", Json::array(required));
  }
  Json schema = Json::object();
  schema.add("if", std::move(condition)).add("then", std::move(consequence));
  return schema;
}

Json table_schema(const KeyTable& table) {
  Json schema = of_type("object");
  schema.add("description", Json::text(table.meaning));
  Json properties = Json::object();
  add_keys(properties, table);
  add_variants_keys(properties, table);
  schema.add("properties", std::move(properties));
  if (const auto required = required_keys(table); !required.empty())
    schema.add("required", Json::array(required));
  if (!table.selector.empty()) {
    std::vector<Json> variants;
    for (const std::string_view choice : find_key(table, table.selector)->choices) {
      variants.push_back(variant_schema(table, choice));
    }
    // Always: an allOf of the table itself would hide its keys as above.
    schema.add("if", of_type("object"));
    schema.add("then", std::move(Json::object().add("allOf", Json::array(variants))));
  }
  // Not unevaluatedProperties, which would see the keys that a variant adds: editors' checkers ignore it.
  schema.add("additionalProperties", Json::boolean(false));
  return schema;
}

bool is_variant(const KeyTable& table) {
  const std::size_t dot = table.name.find('.');
  if (dot == std::string_view::npos) return false;
  const KeyTable* owner = find_table(table.name.substr(0, dot));
  if (owner == nullptr || owner->selector.empty()) return false;
  const auto& choices = find_key(*owner, owner->selector)->choices;
  return std::find(choices.begin(), choices.end(), table.name.substr(dot + 1)) != choices.end();
}

}  // namespace

std::string json_schema() {
  Json definitions = Json::object();
  Json expression = of_type("string");
  // No description, which editors would show beside that of each key.
  expression.add("title",
                 Json::text("An expression of `t`, `frame` and the parameters: \"2*t + sin(pi*t)\"."));
  definitions.add("expression", std::move(expression));
  for (const KeyTable& table : key_tables()) {
    if (table.name.empty() || table.name == "params" || is_variant(table)) continue;
    definitions.add(table.name, table_schema(table));
  }
  Json schema = Json::object();
  schema.add("$schema", Json::text("https://json-schema.org/draft/2020-12/schema"));
  schema.add("title", Json::text("Backlight scene"));
  const KeyTable& top = *find_table("");
  schema.add("description", Json::text(top.meaning)).add("type", Json::text("object"));
  Json properties = Json::object();
  add_keys(properties, top);
  schema.add("properties", std::move(properties));
  schema.add("additionalProperties", Json::boolean(false));
  schema.add("$defs", std::move(definitions));
  return schema.write() + "\n";
}

}  // namespace backlight
