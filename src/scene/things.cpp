#include "things.h"

namespace backlight {
namespace {

Thing called(const std::string& kind, const std::string& name, const Place& place) {
  return {name.empty() ? kind : kind + " '" + name + "'", place};
}

Place place_of(const Compilation& c, std::string_view tables, std::size_t index) {
  return (*find(c.values.description.root, tables)->node.array())[index].place;
}

}  // namespace

Thing object_thing(const Compilation& c, int object) {
  const auto index = static_cast<std::size_t>(object);
  return called("the object", c.scene.objects[index].name, place_of(c, "object", index));
}

Thing light_thing(const Compilation& c, std::size_t light) {
  return called("the light", c.scene.lights[light].name, place_of(c, "light", light));
}

Thing camera_thing(const Compilation& c) {
  const Node* camera = find_camera(c.values, c.request);
  return called("the camera", c.scene.camera.name, camera != nullptr ? camera->place : Place{});
}

Thing background_thing(const Compilation& c) {
  const Entry* background = find(c.values.description.root, "background");
  return {"the background", background != nullptr ? background->place : Place{}};
}

std::string beside(const Compilation& c, const Thing& thing, const Thing& subject) {
  const SourceSpan span = c.values.description.span(thing.place);
  const bool same = thing.place.source == subject.place.source || !span.source;
  return thing.name + " of " + (same ? "line " : span.source->name + ":") + std::to_string(thing.place.line);
}

}  // namespace backlight
