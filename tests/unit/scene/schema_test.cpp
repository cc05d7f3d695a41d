// The JSON Schema: well-formed, complete, and in agreement with the reader.
#include "backlight/scene/schema.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "backlight/scene/keys.h"

namespace backlight {
namespace {

using nlohmann::json;

// Every "$ref" below `node` is to a definition of the schema.
void check_references(const json& node, const json& definitions) {
  if (node.is_object() && node.contains("$ref")) {
    const std::string name = node["$ref"].get<std::string>().substr(std::string("#/$defs/").size());
    EXPECT_TRUE(definitions.contains(name)) << name;
  }
  if (node.is_structured()) {
    for (const json& child : node) check_references(child, definitions);
  }
}

TEST(Schema, IsJsonWhoseReferencesResolve) {
  const json schema = json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  check_references(schema, schema["$defs"]);
}

TEST(Schema, HasEveryKeyOfEveryTable) {
  const json schema = json::parse(json_schema());
  for (const KeyTable& table : key_tables()) {
    const std::string name(table.name);
    if (name == "params") continue;
    const std::size_t dot = name.find('.');
    const KeyTable* owner = dot == std::string::npos ? nullptr : find_table(name.substr(0, dot));
    const bool is_variant = owner != nullptr && !owner->selector.empty() && owner->heading == table.heading;
    for (const Key& key : table.keys) {
      const std::string key_name(key.name);
      if (name.empty()) {
        EXPECT_TRUE(schema["properties"].contains(key_name)) << key_name;
      } else if (is_variant) {
        bool found = false;
        for (const json& variant : schema["$defs"][name.substr(0, dot)]["then"]["allOf"]) {
          const json& chosen = variant["if"]["properties"][std::string(owner->selector)]["const"];
          found =
              found || (chosen == name.substr(dot + 1) && variant["then"]["properties"].contains(key_name));
        }
        EXPECT_TRUE(found) << name << "." << key_name;
      } else {
        EXPECT_TRUE(schema["$defs"][name]["properties"].contains(key_name)) << name << "." << key_name;
      }
    }
  }
}

// On an allOf of a table or of a key the completion of a widely used language server does not end
// (src/scene/schema.cpp).
TEST(Schema, HasNoAllOfOfTablesAndKeys) {
  json schema = json::parse(json_schema());
  schema["$defs"]["the top"] = {{"properties", schema["properties"]}};
  for (const auto& [name, table] : schema["$defs"].items()) {
    EXPECT_FALSE(table.contains("allOf")) << name;
    if (!table.contains("properties")) continue;
    for (const auto& [key, its] : table["properties"].items()) {
      EXPECT_FALSE(its.contains("allOf")) << name << "." << key;
      EXPECT_TRUE(its.contains("description")) << name << "." << key;
    }
  }
}

TEST(Schema, AnyNumberMayBeAnExpression) {
  const json schema = json::parse(json_schema());
  const json fov = schema["$defs"]["camera"]["properties"]["fov"];
  EXPECT_EQ(fov["anyOf"][0]["type"], "number");
  EXPECT_EQ(fov["anyOf"][0]["exclusiveMinimum"], 0);
  EXPECT_EQ(fov["anyOf"][1]["$ref"], "#/$defs/expression");
  EXPECT_EQ(fov["default"], 60);
}

TEST(Schema, RequiredKeysAreThoseOfTheShape) {
  const json object = json::parse(json_schema())["$defs"]["object"];
  EXPECT_EQ(object["required"], json::array({"shape"}));
  const json& sphere = object["then"]["allOf"][0];
  EXPECT_EQ(sphere["if"]["properties"]["shape"]["const"], "sphere");
  EXPECT_EQ(sphere["then"]["required"], json::array({"radius"}));
}

}  // namespace
}  // namespace backlight
