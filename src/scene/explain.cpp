#include "backlight/scene/explain.h"

#include <cstdio>
#include <numbers>

#include "backlight/scene/keys.h"
#include "backlight/scene/needs.h"
#include "words.h"

namespace backlight {
namespace {

constexpr std::size_t most_frames_listed = 20;

std::string plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string six_digits(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", value + 0.0);
  return buffer;
}

std::string words(const Vec3& v) {
  return "[" + six_digits(v.x) + ", " + six_digits(v.y) + ", " + six_digits(v.z) + "]";
}

// "at rest", or "0.9 c (gamma = 2.29416) along [1, 0, 0]": of a frame in the world.
std::string motion_words(const ExtendedVec3& celerity) {
  if (celerity == ExtendedVec3{}) return "at rest";
  const Extended size = sqrt(dot(celerity, celerity));
  const Extended gamma = lorentz_factor(celerity);
  const double beta = double(size / gamma);
  std::string speed = six_digits(beta) + " c";
  // Near c the speed is all nines: how much is missing says more. 1 - β = 1/(γ² (1 + β)).
  if (beta > 0.999)
    speed = "c (1 - " + six_digits(double(Extended(1.0) / (gamma * gamma * (size / gamma + 1.0)))) + ")";
  const Vec3 along = ((Extended(1.0) / size) * celerity).rounded();
  return speed + " (gamma = " + six_digits(double(gamma)) + ") along " + words(along);
}

std::string image_words(const Scene& scene) {
  const FilmSettings& film = scene.film;
  std::string text = std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels, " +
                     (film.adaptive ? "samples for an error of " + six_digits(film.tolerance)
                                    : plural(static_cast<std::size_t>(film.samples), "sample") + " each");
  if (!film.aovs.empty()) text += "; AOVs " + listed(film.aovs, "and");
  return text;
}

std::string camera_words(const Scene& scene) {
  const CameraView& camera = scene.camera;
  const Lens& lens = camera.lens;
  std::string text(name_of(lens.projection));
  if (lens.screen) {
    text += " through a screen";
  } else if (has_fov(lens.projection)) {
    text += ", " + six_digits(lens.fov * 180.0 / std::numbers::pi) + " degrees wide";
  }
  if (camera.stereo) text += ", two eyes " + six_digits(camera.stereo->separation) + " apart";
  text += "; " + motion_words(camera.celerity);
  text += "\n             exposed at its own time " + six_digits(camera.proper_time / scene.c) +
          " s, world time " + six_digits(double(camera.event.t) / scene.c) + " s, at " +
          words(camera.event.x.rounded());
  return text;
}

std::string frames_words(const Scene& scene) {
  std::string text;
  std::size_t listed_frames = 0;
  for (const SceneFrame& frame : scene.frames) {
    const std::size_t surfaces = frame.surface_count();
    if (surfaces == 0) continue;
    if (++listed_frames > most_frames_listed) continue;
    std::string name = frame.name;
    if (name.empty()) {
      const Object& object = scene.objects[static_cast<std::size_t>(frame.object_of_surface.front())];
      name = "of " + (object.name.empty() ? "object " + std::to_string(object.id) : "'" + object.name + "'");
    }
    text += "  frame " + name + ": " + motion_words(frame.motion.celerity) + "; " +
            plural(surfaces, "surface") + "\n";
  }
  if (listed_frames > most_frames_listed) {
    text += "  and " + plural(listed_frames - most_frames_listed, "other frame") + "\n";
  }
  return text;
}

std::string switch_words(const Effects& effects) {
  static constexpr const char* rates[] = {"D", "gamma", "1"};
  const BrightnessSwitches& on = effects.brightness;
  std::string text = std::string("light delay ") + (effects.light_delay ? "on" : "off") + ", colour shift " +
                     (effects.doppler ? "on" : "off") + ", brightness ";
  if (on == BrightnessSwitches{}) return text + "D^4";
  if (on == BrightnessSwitches{false, ArrivalRate::off, false}) return text + "unchanged";
  return text + (on.photon_energy ? "D" : "1") + " (energy) x " +
         rates[static_cast<std::size_t>(on.arrival_rate)] + " (rate) x " + (on.solid_angle ? "D^2" : "1") +
         " (solid angle)";
}

std::string background_words(const Scene& scene) {
  const Sky& sky = scene.sky;
  std::string text = !sky.emits ? "black" : sky.texture ? "a texture" : "uniform";
  if (!sky.stars.empty()) text += ", " + plural(sky.stars.size(), "star");
  const ExtendedVec3& celerity = scene.frames[static_cast<std::size_t>(sky.frame)].motion.celerity;
  if (sky.emits || !sky.stars.empty()) text += "; " + motion_words(celerity);
  return text;
}

std::string model_words(const Needs& needs) {
  std::string text = needs.spectral ? "spectral: " + needs.why + "; " + std::to_string(needs.wavelengths) +
                                          " wavelengths for reflectances, " + needs.why_so_many +
                                          "; lights, tables and lines are summed whole"
                                    : "red, green, blue: " + needs.why;
  text += needs.shadow_rays ? "; shadow rays" : "; no shadow rays";
  text += needs.textures > 0 ? "; " + plural(needs.textures, "texture") + " by OpenImageIO"
                             : "; no textures, OpenImageIO is not loaded";
  return text;
}

std::string arithmetic_words(const Needs& needs) {
  if (needs.moving_frames == 0) return "double precision; no boosts";
  std::string text = "double precision; a ray is boosted into " + plural(needs.moving_frames, "frame");
  if (needs.extended_frames > 0) {
    text += ", and begins in extended precision in the " + std::to_string(needs.extended_frames) +
            " of gamma > " + six_digits(robust_gamma);
  }
  return text;
}

}  // namespace

std::string explain(const Description& description, const Scene& scene, const Needs& needs) {
  std::string text =
      description.file + ": at t = " + six_digits(scene.time) + " s with c = " + six_digits(scene.c) + "\n";
  const auto line = [&](const std::string& label, const std::string& words_of_it) {
    std::string padded = "  " + label;
    padded.resize(13, ' ');
    text += padded + words_of_it + "\n";
  };
  line("image", image_words(scene));
  line("camera", camera_words(scene));
  std::string objects = plural(needs.objects, "object");
  if (needs.surfaces != needs.objects)
    objects += " (" + std::to_string(needs.surfaces) + " with their copies)";
  objects += " in " + plural(needs.frames, "frame") + ", " + std::to_string(needs.moving_frames) +
             " moving relative to the camera";
  line("objects", objects);
  text += frames_words(scene);
  line("roots", in_words(needs.roots));
  line("lights", needs.lights == 0 ? "none" : plural(needs.lights, "light"));
  line("background", background_words(scene));
  line("effects", switch_words(scene.effects));
  for (const EffectsRegion& region : scene.regions) {
    line("", "in [" + six_digits(region.x0) + ", " + six_digits(region.y0) + ", " + six_digits(region.x1) +
                 ", " + six_digits(region.y1) + "]: " + switch_words(region.effects));
  }
  line("model", model_words(needs));
  line("arithmetic", arithmetic_words(needs));
  return text;
}

}  // namespace backlight
