#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "compile_motion.h"
#include "compile_parts.h"

namespace backlight {
namespace {

Colour read_colour(const TableView& table, ResourceCache& cache) {
  const std::string_view given = table.one_of({"temperature", "color", "spectrum"});
  check_absolute(table, given);
  if (!light_lines_stand_alone(table, given, "spectrum")) return white_light();
  if (given == "temperature") {
    if (const auto body = read_blackbody(table)) return *body;
  } else if (given == "color") {
    return coloured_light(table.vector("color"));
  } else if (const auto spectrum = read_light_spectrum(table, "spectrum", cache)) {
    return *spectrum;
  }
  return white_light();
}

// In a strength, t is the light's own time.
void read_strength(const TableView& table, std::string_view key, Light& light) {
  const auto formula = table.in_own_time(key);
  if (!formula) {
    light.strength = table.number(key);
    return;
  }
  light.flickers = true;
  light.strength_of_time = *formula;
  light.strength = light.strength_of_time.evaluate(std::array{table.values().variables[variable_t]});
}

// The light's colour takes the film's exposure; that of a blackbody, whose range passes a double's, takes the
// strength too: where it flickers, that of the image's time, by which the formula is divided.
void take_exposure(double exposure, Light& light) {
  light.colour = times(light.colour, exposure);
  const bool takes_strength =
      light.colour.spectrum.is_blackbody() && light.strength > 0.0 && std::isfinite(light.strength);
  if (takes_strength) light.colour = times(light.colour, light.strength);
  if (takes_strength != light.flickers) light.strength = 1.0;
}

// The unit direction of a light; a zero one is reported.
Vec3 read_direction(const TableView& table) {
  const Vec3 direction = of_size_one(table.vector("direction"));
  const double length = glm::length(direction);
  if (length == 0.0) table.error("direction", "'direction' is zero: it points nowhere");
  return direction / length;
}

SpotCone read_cone(const TableView& table, double c) {
  SpotCone cone;
  if (const auto turning = table.vector_in_own_time("direction")) {
    cone.turning = std::make_shared<const TurningAxis>(TurningAxis{*turning, c});
  } else if (table.has_valid("direction")) {
    cone.axis = read_direction(table);
  }
  cone.half_angle = table.number("angle") * (std::numbers::pi / 360.0);
  cone.edge = table.number("edge");
  return cone;
}

void compile_light(Compilation& c, const Node& node) {
  const TableView table(c.values, &node, *find_table("light"));
  Light light;
  light.name = table.text("name");
  light.colour = read_colour(table, c.cache);
  const RestPlace place = c.frames.rest_of(table, table.vector("position"));
  light.frame = place.frame;
  light.position = place.position;
  if (has_motion(table)) {
    check_motions_apart(table, c.scene.frames[static_cast<std::size_t>(place.frame)].motion.celerity);
  }
  if (is_in_motion(table)) light.motion = path_of(c, table, place.frame);
  light.shadows = table.boolean("shadows");
  if (const Node* type = table.node_of("type"); type != nullptr && !type->valid()) return;
  const std::string type = table.text("type");
  if (type == "distant") {
    light.kind = LightKind::distant;
    if (table.has_valid("direction")) light.direction = read_direction(table);
    read_strength(table, "irradiance", light);
  } else if (type == "ambient") {
    light.kind = LightKind::ambient;
    if (table.has("position")) {
      table.warning("position", "an ambient light comes from everywhere: its 'position' changes nothing");
    }
    read_strength(table, "radiance", light);
  } else {
    if (type == "spot") light.cone = read_cone(table, c.scene.c);
    read_strength(table, "intensity", light);
  }
  const auto& aovs = c.scene.film.aovs;
  light.tells_time = std::find(aovs.begin(), aovs.end(), "lampTime") != aovs.end();
  take_exposure(c.scene.film.exposure, light);
  c.scene.lights.push_back(std::move(light));
}

}  // namespace

void compile_lights(Compilation& c) {
  const Entry* lights = find(c.values.description.root, "light");
  if (lights == nullptr || lights->node.array() == nullptr) return;
  for (const Node& node : *lights->node.array()) compile_light(c, node);
}

}  // namespace backlight
