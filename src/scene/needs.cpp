#include "backlight/scene/needs.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "backlight/colour/observer.h"

namespace backlight {
namespace {

const ExtendedVec3& celerity_of(const Scene& scene, int frame) {
  return scene.frames[static_cast<std::size_t>(frame)].motion.celerity;
}

// Below this relative celerity no colour shifts that anyone could see: the same speed written in two ways, or
// a scene told from another frame, differs by its rounding.
constexpr double at_rest_celerity = 1e-9;

bool moves(const ExtendedVec3& a, const ExtendedVec3& b) {
  return relative_motion(a, b).speed > at_rest_celerity;
}

// How a frame is called: by its name, or by its first object's.
std::string name_of(const Scene& scene, const SceneFrame& frame) {
  if (!frame.name.empty()) return "frame '" + frame.name + "'";
  if (frame.object_of_surface.empty()) return "a frame";
  const Object& object = scene.objects[static_cast<std::size_t>(frame.object_of_surface.front())];
  return object.name.empty() ? "object " + std::to_string(object.id) : "object '" + object.name + "'";
}

std::string name_of(const Scene& scene, const Light& light) {
  const auto number = static_cast<std::size_t>(&light - scene.lights.data()) + 1;
  return light.name.empty() ? "light " + std::to_string(number) : "light '" + light.name + "'";
}

// Whether any part of the image shows a shift of colours: on the way to the camera, and on the way from a
// light to a surface, which does not depend on light_delay.
struct Shifts {
  bool to_camera = false;
  bool from_light = false;
};

Shifts shifts_shown(const Scene& scene) {
  Shifts shifts;
  const auto add = [&](const Effects& effects) {
    shifts.to_camera = shifts.to_camera || (effects.doppler && effects.light_delay);
    shifts.from_light = shifts.from_light || effects.doppler;
  };
  add(scene.effects);
  for (const EffectsRegion& region : scene.regions) add(region.effects);
  return shifts;
}

// A motion that shifts a colour, in words.
struct ShiftingMotion {
  ModelReason reason = ModelReason::object_moves;
  std::string words;
};

// What a mirror shows is light on its way to the mirror, as a lamp's is: only its motion against what it
// shows counts where no light travels to the camera.
std::optional<ShiftingMotion> motion_in_mirrors(const Scene& scene) {
  for (const SceneFrame& mirror : scene.frames) {
    if (!passes_on(scene, mirror)) continue;
    const ExtendedVec3& its = mirror.motion.celerity;
    if (scene.sky.emits && moves(celerity_of(scene, scene.sky.frame), its)) {
      return ShiftingMotion{
          ModelReason::mirror_moves,
          "the background moves relative to " + name_of(scene, mirror) + ", which passes light on"};
    }
    for (const SceneFrame& frame : scene.frames) {
      if (frame.object_of_surface.empty()) continue;
      if (!frame.surfaces->any_moves() && !mirror.surfaces->any_moves() && !moves(frame.motion.celerity, its))
        continue;
      return ShiftingMotion{
          ModelReason::mirror_moves,
          name_of(scene, frame) + " moves relative to " + name_of(scene, mirror) + ", which passes light on"};
    }
  }
  return std::nullopt;
}

// The first of them, if there is any.
std::optional<ShiftingMotion> shifting_motion(const Scene& scene, const Shifts& shown) {
  const ExtendedVec3& camera = scene.camera.celerity;
  if (shown.to_camera && scene.sky.emits && moves(celerity_of(scene, scene.sky.frame), camera)) {
    return ShiftingMotion{ModelReason::background_moves, "the background moves relative to the camera"};
  }
  for (const SceneFrame& frame : scene.frames) {
    if (frame.object_of_surface.empty()) continue;
    const bool turns = frame.surfaces->any_moves();
    if (shown.to_camera && (turns || moves(frame.motion.celerity, camera))) {
      return ShiftingMotion{ModelReason::object_moves,
                            name_of(scene, frame) + " moves relative to the camera"};
    }
    for (const Light& light : scene.lights) {
      if (!shown.from_light || light.kind == LightKind::ambient) continue;
      const bool goes =
          turns || light.motion || moves(celerity_of(scene, light.frame), frame.motion.celerity);
      if (!goes) continue;
      return ShiftingMotion{
          ModelReason::light_moves,
          name_of(scene, light) + " and " + name_of(scene, frame) + " move relative to each other"};
    }
  }
  return shown.from_light ? motion_in_mirrors(scene) : std::nullopt;
}

void choose_model(const Scene& scene, Needs& needs) {
  const auto all_motion = shifting_motion(scene, {true, true});
  const auto shown_motion = shifting_motion(scene, shifts_shown(scene));
  needs.spectral = shown_motion.has_value();
  if (needs.spectral) {
    const bool given = scene.film.wavelengths > 0;
    needs.wavelengths = given ? scene.film.wavelengths : default_wavelength_count;
    needs.wavelength_reason = given ? WavelengthReason::given : WavelengthReason::usual;
    needs.why_so_many = given ? "as given" : "the default";
  }
  const auto because = [&needs](ModelReason reason, std::string words) {
    needs.reason = reason;
    needs.why = std::move(words);
  };
  if (shown_motion) {
    because(shown_motion->reason, shown_motion->words);
  } else if (!all_motion && needs.stars > 0 &&
             moves(celerity_of(scene, scene.sky.frame), scene.camera.celerity)) {
    because(ModelReason::only_stars_shift, "only stars shift, and their colours are found once an image");
  } else if (!all_motion) {
    because(ModelReason::nothing_moves, "nothing moves relative to anything else");
  } else {
    because(ModelReason::effects_off, "the effects show no shift of colours");
  }
}

void count_roots(const Shape& shape, std::size_t surfaces, std::vector<RootSearch>& roots) {
  // Elsewhere the kind decides: no words are made for each of 100,000 spheres.
  const bool differs_within_kind = shape.formula != nullptr || shape.solid != nullptr;
  const auto is_like = [&](const RootSearch& search) {
    return search.shape == shape.kind && (!differs_within_kind || search.how == root_finding(shape));
  };
  const auto found = std::ranges::find_if(roots, is_like);
  if (found != roots.end()) {
    found->surfaces += surfaces;
  } else {
    roots.push_back({shape.kind, root_finder(shape), root_finding(shape), surfaces});
  }
}

void count_roots(const SceneFrame& frame, std::vector<RootSearch>& roots) {
  for (std::size_t i = 0; i < frame.surfaces->size(); ++i)
    count_roots(frame.surfaces->shape(static_cast<int>(i)), 1, roots);
  for (const CopiesLeftOut& left : frame.left_out)
    count_roots(frame.surfaces->shape(left.surface), left.copies, roots);
}

std::string plural_of(const RootSearch& search) {
  const std::string shape{name(search.shape)};
  const bool several = search.surfaces != 1;
  switch (search.shape) {
    case ShapeKind::implicit:
      return several ? "implicit surfaces" : "implicit surface";
    case ShapeKind::torus:
      return several ? "tori" : "torus";
    case ShapeKind::box:
      return several ? "boxes" : "box";
    case ShapeKind::mesh:
      return several ? "meshes" : "mesh";
    default:
      return several ? shape + 's' : shape;
  }
}

}  // namespace

Needs needs_of(const Scene& scene) {
  Needs needs;
  for (const SceneFrame& frame : scene.frames) {
    if (frame.object_of_surface.empty()) continue;
    ++needs.frames;
    const RelativeMotion motion = relative_motion(frame.motion.celerity, scene.camera.celerity);
    if (motion.speed > at_rest_celerity) ++needs.moving_frames;
    if (motion.gamma > robust_gamma) ++needs.extended_frames;
    needs.surfaces += frame.surface_count();
    count_roots(frame, needs.roots);
  }
  needs.objects = scene.objects.size();
  needs.lights = scene.lights.size();
  needs.stars = scene.sky.stars.size();
  std::set<const Texture*> textures;
  for (const Material& material : scene.materials) textures.insert(material.texture.get());
  textures.insert(scene.sky.texture.get());
  textures.erase(nullptr);
  needs.textures = textures.size();
  needs.shadowing_lights = static_cast<std::size_t>(std::ranges::count_if(scene.lights, throws_shadows));
  needs.shadow_rays = needs.surfaces > 0 && needs.shadowing_lights > 0;
  choose_model(scene, needs);
  return needs;
}

std::string_view code_of(ModelReason reason) {
  switch (reason) {
    case ModelReason::background_moves:
      return "background-moves";
    case ModelReason::object_moves:
      return "object-moves";
    case ModelReason::mirror_moves:
      return "mirror-moves";
    case ModelReason::light_moves:
      return "light-moves";
    case ModelReason::only_stars_shift:
      return "only-stars-shift";
    case ModelReason::nothing_moves:
      return "nothing-moves";
    case ModelReason::effects_off:
      break;
  }
  return "effects-off";
}

std::string_view code_of(WavelengthReason reason) {
  switch (reason) {
    case WavelengthReason::given:
      return "given";
    case WavelengthReason::usual:
      return "default";
    case WavelengthReason::tolerance:
      return "tolerance";
    case WavelengthReason::none:
      break;
  }
  return "none";
}

std::string_view code_of(RootFinder finder) {
  switch (finder) {
    case RootFinder::closed_form:
      return "closed-form";
    case RootFinder::quartic:
      return "quartic";
    case RootFinder::interval:
      return "interval";
    case RootFinder::polynomial:
      return "polynomial";
    case RootFinder::affine:
      return "affine";
    case RootFinder::triangles:
      return "triangles";
    case RootFinder::taylor:
      return "taylor";
    case RootFinder::solid:
      break;
  }
  return "csg";
}

std::string in_words(const std::vector<RootSearch>& roots) {
  std::string words;
  for (const RootSearch& search : roots) {
    if (!words.empty()) words += "; ";
    words += std::to_string(search.surfaces) + ' ' + plural_of(search) + ": " + search.how;
  }
  return words.empty() ? "none" : words;
}

}  // namespace backlight
