#include "backlight/render/image_header.h"

#include <charconv>

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
  list.push_back({"backlight/frame", scene.frame});
  list.push_back({"backlight/time", scene.time});
  if (!camera.name.empty()) list.push_back({"backlight/camera", camera.name});
  list.push_back({"backlight/cameraVelocity", celerity * (scene.c / gamma)});
  list.push_back({"backlight/cameraCelerity", celerity * scene.c});
  list.push_back({"backlight/cameraTime", camera.proper_time / scene.c});
  list.push_back({"backlight/c", scene.c});
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
