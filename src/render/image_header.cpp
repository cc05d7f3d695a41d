#include "backlight/render/image_header.h"

#include <algorithm>
#include <charconv>
#include <numbers>
#include <utility>

#include "backlight/render/image_identity.h"

namespace backlight {
namespace {

std::string yes_or_no(bool on) {
  return on ? "true" : "false";
}

std::string rate_text(ArrivalRate rate) {
  switch (rate) {
    case ArrivalRate::exact:
      return "\"exact\"";
    case ArrivalRate::dilation:
      return "\"dilation\"";
    case ArrivalRate::off:
      break;
  }
  return "\"off\"";
}

// The one word for a usual combination of switches, or the three switches.
std::string searchlight_text(const BrightnessSwitches& on) {
  if (on == BrightnessSwitches{true, ArrivalRate::exact, true}) return "searchlight = \"exact\"";
  if (on == BrightnessSwitches{true, ArrivalRate::dilation, true}) return "searchlight = \"paper\"";
  if (on == BrightnessSwitches{false, ArrivalRate::off, false}) return "searchlight = \"off\"";
  return "energy = " + yes_or_no(on.photon_energy) + ", rate = " + rate_text(on.arrival_rate) +
         ", solid_angle = " + yes_or_no(on.solid_angle);
}

std::string number_text(double value) {
  char digits[32];
  const auto result = std::to_chars(digits, digits + sizeof digits, value);
  return {digits, result.ptr};
}

std::vector<std::string> region_texts(const Scene& scene) {
  std::vector<std::string> texts;
  for (const EffectsRegion& region : scene.regions) {
    texts.push_back("rect = [" + number_text(region.x0) + ", " + number_text(region.y0) + ", " +
                    number_text(region.x1) + ", " + number_text(region.y1) + "], " +
                    effects_text(region.effects));
  }
  return texts;
}

// The axes are those of worldToCamera.
void add_lens(std::vector<ExrAttribute>& list, const CameraView& camera) {
  const Lens& lens = camera.lens;
  list.push_back({"backlight/projection", std::string(name_of(lens.projection))});
  if (lens.screen) {
    const ScreenFilm& film = *lens.screen;
    list.push_back({"backlight/screen", number_text(film.foot.x) + " " + number_text(film.foot.y) + " " +
                                            number_text(film.step_x) + " " + number_text(film.step_y)});
  } else if (has_fov(lens.projection))
    list.push_back({"backlight/fov", lens.fov * (180.0 / std::numbers::pi)});
}

// By object the velocity in the camera's frame, as text; empty of matter in motion.
std::vector<std::string> velocity_texts(const Scene& scene) {
  std::vector<std::string> texts(scene.objects.size());
  for (const SceneFrame& frame : scene.frames) {
    const RelativeMotion motion = relative_motion(frame.motion.celerity, scene.camera.celerity);
    const Vec3 v = motion.celerity * (scene.c / motion.gamma) + Vec3{0.0};  // no -0
    const std::string text = number_text(v.x) + " " + number_text(v.y) + " " + number_text(v.z);
    for (std::size_t i = 0; i < frame.object_of_surface.size(); ++i) {
      if (!frame.surfaces->moves(static_cast<int>(i)))
        texts[static_cast<std::size_t>(frame.object_of_surface[i])] = text;
    }
  }
  return texts;
}

// What objectId.V numbers, and how it moves: objects of one velocity that follow each other in one text.
void add_objects(std::vector<ExrAttribute>& list, const Scene& scene) {
  if (std::ranges::find(scene.film.aovs, "objectId") == scene.film.aovs.end()) return;
  if (scene.objects.empty() || scene.objects.size() > most_named_objects) return;
  std::vector<std::string> names;
  for (const Object& object : scene.objects) names.push_back(object.name);
  list.push_back({"backlight/objects", std::move(names)});
  const std::vector<std::string> velocities = velocity_texts(scene);
  std::vector<std::string> runs;
  for (std::size_t first = 0, last = 0; first < velocities.size(); first = last + 1) {
    for (last = first; last + 1 < velocities.size() && velocities[last + 1] == velocities[first];) ++last;
    if (velocities[first].empty()) continue;
    runs.push_back(std::to_string(first + 1) + " " + std::to_string(last + 1) + " " + velocities[first]);
  }
  list.push_back({"backlight/objectVelocities", std::move(runs)});
}

}  // namespace

std::string effects_text(const Effects& effects) {
  return "light_delay = " + yes_or_no(effects.light_delay) + ", doppler = " + yes_or_no(effects.doppler) +
         ", " + searchlight_text(effects.brightness);
}

ExrHeader image_header(const Scene& scene, int wavelengths, const ImageOrigin& origin,
                       std::optional<std::int64_t> creation_time) {
  const CameraView& camera = scene.camera;
  const Vec3 celerity = camera.celerity.rounded();
  const double gamma = double(lorentz_factor(camera.celerity));

  ExrHeader header;
  header.software = origin.software;
  header.creation_time = creation_time;
  header.world_to_camera = world_to_camera_matrix(camera.event.x.rounded(), camera.lens.right, camera.lens.up,
                                                  camera.lens.forward);
  auto& list = header.attributes;
  list.push_back({"backlight/scene", origin.scene_file});
  list.push_back({"backlight/sceneSha256", origin.scene_sha256});
  if (!origin.overrides.empty()) list.push_back({"backlight/overrides", origin.overrides});
  if (!scene.parameters.empty()) {
    std::vector<std::string> parameters;
    for (const auto& [name, value] : scene.parameters)
      parameters.push_back(name + " = " + number_text(value));
    list.push_back({"backlight/params", std::move(parameters)});
  }
  list.push_back({"backlight/frame", scene.frame});
  list.push_back({"backlight/time", scene.time});
  if (!camera.name.empty()) list.push_back({"backlight/camera", camera.name});
  list.push_back({"backlight/cameraVelocity", celerity * (scene.c / gamma)});
  list.push_back({"backlight/cameraCelerity", celerity * scene.c});
  list.push_back({"backlight/cameraTime", camera.proper_time / scene.c});
  list.push_back({"backlight/c", scene.c});
  add_lens(list, camera);
  add_objects(list, scene);
  if (scene.film.tolerance > 0.0) list.push_back({"backlight/tolerance", scene.film.tolerance});
  if (!scene.film.adaptive) list.push_back({"backlight/samples", std::int32_t{scene.film.samples}});
  list.push_back({"backlight/wavelengths", std::int32_t{wavelengths}});
  list.push_back({"backlight/seed", double(scene.film.seed)});
  list.push_back({"backlight/exposure", scene.film.exposure});
  list.push_back({"backlight/effects", effects_text(scene.effects)});
  if (!scene.regions.empty()) list.push_back({"backlight/effectsRegions", region_texts(scene)});
  if (!origin.identity.empty()) list.push_back({identity_attribute, origin.identity});
  list.push_back({"backlight/complete", std::int32_t{1}});
  return header;
}

}  // namespace backlight
