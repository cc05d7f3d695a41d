// Light that will pass what a film value can be, known before anything is traced.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/scene/material_in_time.h"
#include "compile_parts.h"
#include "words.h"

namespace backlight {
namespace {

// The film Y of a radiance of unit strength as it is seen with D: docs/physics.md equation (8).
double film_seen(const Spectrum& light, double doppler, const Effects& effects) {
  const WavelengthSet& set = wavelength_set(default_wavelength_count);
  const DopplerFactor<Camera, Rest> d{doppler};
  std::vector<double> nm(set.nm().begin(), set.nm().end());
  if (effects.doppler) {
    for (double& at : nm) at = wavelength_at_origin(d, at);
  }
  std::vector<double> values(nm.size());
  light.evaluate_light(nm.data(), set.size(), values.data());
  const double gamma = 0.5 * (doppler + 1.0 / doppler);
  const double density = effects.doppler ? wavelength_density_factor(d) : 1.0;
  return luminance(set.film(values.data())) * density * radiance_factor(d, gamma, effects.towards_camera());
}

class Foresight {
 public:
  explicit Foresight(Compilation& c) : c_(c) {}

  void background() {
    const Sky& sky = c_.scene.sky;
    if (!sky.emits || sky.texture != nullptr) return;
    const Entry* entry = find(c_.values.description.root, "background");
    warn(sky.radiance.spectrum, sky.frame, entry->node, "the background");
  }

  void emission() {
    std::set<std::pair<int, int>> seen;  // material, frame
    for (std::size_t frame = 0; frame < c_.scene.frames.size(); ++frame) {
      for (const int object : c_.scene.frames[frame].object_of_surface) {
        const Object& of = c_.scene.objects[static_cast<std::size_t>(object)];
        std::vector<int> materials = of.member_materials;
        materials.push_back(of.material);
        for (const int material : materials) {
          const Material& m = c_.scene.materials[static_cast<std::size_t>(material)];
          const auto emitted = emission_of(m);
          if (!emitted || !seen.emplace(material, frame).second) continue;
          warn(*emitted, static_cast<int>(frame), written(m, of), "the emission");
        }
      }
    }
  }

  void lights() {
    const Entry* entry = find(c_.values.description.root, "light");
    if (entry == nullptr || entry->node.array() == nullptr) return;
    const NodeArray& nodes = *entry->node.array();
    for (std::size_t i = 0; i < std::min(nodes.size(), c_.scene.lights.size()); ++i) {
      const Light& light = c_.scene.lights[i];
      // Of one that flickers, its colour says how strong it is now.
      const Spectrum& unit = light.colour.spectrum;
      warn(light.flickers ? unit : unit.scaled(light.strength), light.frame, nodes[i], "the light");
    }
  }

 private:
  // Of what runs by its own time, as it is when its clock shows the image's.
  [[nodiscard]] std::optional<Spectrum> emission_of(const Material& material) const {
    const bool changes = material.in_time && material.in_time->emission;
    if (!changes && !material.emission) return std::nullopt;
    if (!changes) return material.emission->spectrum;
    const EmissionNow now = emission_at(*material.in_time->emission, c_.scene.time);
    if (!std::isfinite(now.strength)) return std::nullopt;
    if (now.body) return now.body;
    return now.colour ? Spectrum::illuminant(*now.colour) : material.emission->spectrum.scaled(now.strength);
  }

  const Node& written(const Material& material, const Object& object) const {
    const Node& root = c_.values.description.root;
    if (!material.name.empty()) return find(find(root, "material")->node, material.name)->node;
    const Node& node = (*find(root, "object")->node.array())[static_cast<std::size_t>(object.id) - 1];
    const Entry* own = find(node, "material");
    return own != nullptr && own->node.table() != nullptr ? own->node : node;
  }

  void warn(const Spectrum& light, int frame, const Node& node, const std::string& what) {
    const ExtendedVec3& celerity = c_.scene.frames[static_cast<std::size_t>(frame)].motion.celerity;
    const RelativeMotion motion = relative_motion(celerity, c_.scene.camera.celerity);
    const double doppler = c_.scene.effects.light_delay ? motion.gamma + motion.speed : 1.0;
    if (!(film_seen(light, doppler, c_.scene.effects) > std::numeric_limits<float>::max())) return;
    if (!told_.insert(&node).second) return;
    const Entry* temperature = node.table() != nullptr ? find(node, "temperature") : nullptr;
    const Place& place = temperature != nullptr ? temperature->node.place : node.place;
    std::string at =
        doppler > 1.0 ? " where it comes with D = " + number_text(0.1 * std::round(10.0 * doppler)) : "";
    c_.values.diagnostics.warning(
        c_.values.description.span(place),
        what + " passes what a film value can be, 3.4e38," + at + ": such pixels keep their colour alone",
        light.is_blackbody() ? "absolute = true gives a blackbody the luminance that it has" : "");
  }

  Compilation& c_;
  std::set<const Node*> told_;
};

}  // namespace

void foresee_brightness(Compilation& c) {
  if (std::exchange(c.parts.brightness_is_foreseen, true)) return;
  Foresight foresight(c);
  foresight.background();
  foresight.emission();
  foresight.lights();
}

}  // namespace backlight
