#include "backlight/trace/sky.h"

#include <algorithm>
#include <cmath>

#include "backlight/film/lane_texture.h"
#include "shading_steps.h"

namespace backlight {
namespace {

// The direction in the camera's frame in which a star at infinity is seen, and the frequency ratio.
struct SeenStar {
  Vec3 direction;
  DopplerFactor<Camera, Rest> doppler;
};

SeenStar seen(const Star& star, const Hub& hub, const Scene& scene, bool light_delay) {
  if (light_delay) {
    const NullDirection<Camera> n = hub.camera_from_sky(NullDirection<Rest>{star.direction, 1.0});
    return {n.x / n.length, {n.length}};
  }
  // Simultaneous in the camera's frame: the direction d whose image (0; d) in the sky's frame points at the
  // star. With Λ = R B(w), the space part of B(w)(0; d) is d + (w·d)/(γ+1) w.
  const auto& sky = hub.frames[static_cast<std::size_t>(scene.sky.frame)].from_camera;
  const Vec3 unrotated = glm::transpose(sky.rotation()) * star.direction;
  const Vec3& w = sky.celerity();
  const double k = glm::dot(w, unrotated) / (sky.gamma() * (1.0 + sky.gamma()));
  return {glm::normalize(unrotated - k * w), {1.0}};
}

// The same in the camera's frame, in film Y times steradians.
LinearRgb light_of(const Star& star, double illuminance, DopplerFactor<Camera, Rest> doppler, double gamma,
                   const Effects& effects, const WavelengthSet& wavelengths) {
  const double flux = flux_factor(doppler, gamma, effects.towards_camera());
  const DopplerFactor<Camera, Rest> shift = effects.doppler ? doppler : DopplerFactor<Camera, Rest>{};
  const Spectrum body = Spectrum::blackbody(star.temperature).scaled(illuminance);
  return flux * star_colour(body, shift, {}, wavelengths);
}

}  // namespace

LinearRgb star_colour(const Spectrum& body, DopplerFactor<Camera, Rest> shift,
                      const std::vector<Filter>& filters, const WavelengthSet& wavelengths) {
  const LinearRgb film = filters.empty() ? wavelengths.lights().at(body, shift.value)->film()
                                         : integrate_film(body, shift.value, filters);
  return wavelength_density_factor(shift) * film;
}

double brightest_star(const Scene& scene, const FrameView& sky, const WavelengthSet& wavelengths) {
  const SharedVector<Star>& stars = scene.sky.stars;
  if (stars.empty()) return 0.0;
  const Star& star = *std::ranges::max_element(stars, {}, &Star::illuminance);
  const auto& motion = sky.from_camera;
  const DopplerFactor<Camera, Rest> ahead{motion.gamma() + glm::length(motion.celerity())};
  const LinearRgb light = light_of(star, scene.sky.star_scale * star.illuminance, ahead, motion.gamma(),
                                   scene.effects, wavelengths);
  const Lens& lens = scene.camera.lens;
  return std::max({light.r, light.g, light.b}) / pixel_solid_angle(lens, straight_ahead(lens));
}

LinearRgb sky_texel(const Sky& sky, double u, double v) {
  return sky.texture_scale * sky.texture->sample(u, v, TextureEdge::clamp);
}

Radiance<Rest> sky_radiance(const Sky& sky, const RestRayEvents& ray) {
  if (!sky.emits) return {};
  if (!sky.texture) return {sky.radiance.rgb};
  const LaneSkyPlace<Lanes<1>> place({ray.direction.x, ray.direction.y, ray.direction.z});
  return {sky_texel(sky, place.u.v, place.v.v)};
}

LinearRgb sky_shifted(const ShadingContext& context, const Radiance<Rest>& radiance, Scratch& s) {
  const Sky& sky = context.scene->sky;
  if (!sky.emits) return LinearRgb{0.0};
  if (!sky.texture) return shifted_colour(context.spectra->sky(), s);
  return shifted_rgb(context, glm::max(radiance.rgb, 0.0), s);
}

std::vector<StarImage> star_images(const Scene& scene, const Hub& hub, const WavelengthSet& wavelengths) {
  const Lens& lens = scene.camera.lens;
  const double gamma = hub.camera_from_sky.gamma();
  std::vector<StarImage> images;
  for (const Star& star : scene.sky.stars) {
    // A region may switch light delay, and so move the star: it is seen where it agrees with itself.
    for (const bool light_delay : {true, false}) {
      const SeenStar s = seen(star, hub, scene, light_delay);
      const auto point = point_of(lens, s.direction);
      if (!point) continue;
      const Effects& effects = effects_at(scene, *point);
      if (effects.light_delay != light_delay) continue;
      const ImagePoint pixel{std::floor(point->x), std::floor(point->y)};
      const double area = pixel_solid_angle(lens, {pixel.x + 0.5, pixel.y + 0.5});
      const LinearRgb light =
          light_of(star, scene.sky.star_scale * star.illuminance, s.doppler, gamma, effects, wavelengths);
      images.push_back(
          {static_cast<int>(pixel.x), static_cast<int>(pixel.y), s.direction, light / area, light_delay});
    }
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const StarImage& a, const StarImage& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return images;
}

}  // namespace backlight
