#include <cmath>
#include <cstdint>
#include <numbers>

#include "backlight/colour/stars.h"
#include "compile_parts.h"

namespace backlight {
namespace {

// Film Y times steradians of a star of magnitude 0: docs/scene-reference.md, [background] stars.
constexpr double illuminance_of_magnitude_0 = 1e-6;
// The same in lux, outside the atmosphere: Cox (editor), "Allen's Astrophysical Quantities", 4th edition,
// 2000.
constexpr double lux_of_magnitude_0 = 2.54e-6;
// Film Y of the faintest star in the pixel that it falls on, where nothing else is said: 38 of 255 steps of
// an sRGB screen.
constexpr double film_of_faintest = 0.02;
// Made-up stars go down to what the naked eye sees.
constexpr double faintest_magnitude = 6.5;

// North is +y, right ascension 0 is +z and 90 degrees is +x: a right-handed renaming of the equatorial axes.
Vec3 direction_of(double right_ascension, double declination) {
  const double degree = std::numbers::pi / 180.0;
  const double ra = right_ascension * degree, dec = declination * degree;
  return {std::cos(dec) * std::sin(ra), std::sin(dec), std::cos(dec) * std::cos(ra)};
}

double relative_illuminance(double magnitude) {
  return std::pow(10.0, -0.4 * magnitude);
}

Star star_of(const Vec3& direction, double magnitude, double b_minus_v) {
  return {direction, temperature_from_bv(b_minus_v), relative_illuminance(magnitude)};
}

// SplitMix64: the output function of Steele, Lea & Flood, "Fast splittable pseudorandom number generators",
// OOPSLA 2014. The same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Uniform in (0, 1].
  double next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>((z >> 11U) + 1) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

// Evenly over the sphere; N(brighter than m) ∝ 10^(m/2); half of them about B-V = 0.1, half about 1.05, as
// the two humps of the naked-eye stars.
Star made_up_star(Random& random) {
  const double y = 1.0 - 2.0 * random.next();
  const double longitude = 2.0 * std::numbers::pi * random.next();
  const double magnitude = faintest_magnitude + 2.0 * std::log10(random.next());
  const bool blue = random.next() < 0.5;
  const double spread = random.next() + random.next() - 1.0;
  const double b_minus_v = blue ? 0.1 + 0.3 * spread : 1.05 + 0.5 * spread;
  const double r = std::sqrt(std::max(0.0, 1.0 - y * y));
  return star_of({r * std::sin(longitude), y, r * std::cos(longitude)}, magnitude, b_minus_v);
}

void add_catalogue(Compilation& c, const TableView& table, std::string_view key, std::vector<Star>& into) {
  const Node* written = table.node_of(key);
  if (written == nullptr || written->text() == nullptr) return;
  const auto stars = c.cache.stars(resolve_path(c.values, *written));
  if (!stars.ok()) return table.error(key, stars.error());
  for (const CatalogueStar& star : *stars.value()) {
    const Vec3 direction = direction_of(star.right_ascension, star.declination);
    into.push_back(star_of(direction, star.magnitude, star.b_minus_v));
  }
}

void read_stars(Compilation& c, const TableView& background, std::vector<Star>& stars) {
  if (background.node_of("stars")->text() != nullptr) {
    return add_catalogue(c, background, "stars", stars);
  }
  const TableView table = background.table("stars", "background.stars");
  const std::string_view given = table.one_of({"file", "count"});
  if (given == "file") return add_catalogue(c, table, "file", stars);
  if (given.empty()) return background.error("stars", "'stars' needs a file or a count");
  Random random(static_cast<std::uint64_t>(table.number("seed")));
  const double count = table.number("count");
  for (double i = 0; i < count; ++i) stars.push_back(made_up_star(random));
}

// What the stars' illuminances are multiplied with. Without a word about it they are as a dark-adapted eye
// sees them: the faintest are just visible in a pixel of the middle, whatever solid angle that is.
double star_scale(const Compilation& c, const TableView& background) {
  std::optional<double> brightness;
  bool absolute = false;
  if (background.node_of("stars")->table() != nullptr) {
    const TableView table = background.table("stars", "background.stars");
    brightness = table.optional_number("brightness");
    absolute = table.boolean("absolute");
  }
  if (absolute) return lux_of_magnitude_0 * brightness.value_or(1.0);
  if (brightness) return illuminance_of_magnitude_0 * *brightness;
  const Lens& lens = c.scene.camera.lens;
  return film_of_faintest / relative_illuminance(faintest_magnitude) *
         pixel_solid_angle(lens, straight_ahead(lens));
}

void read_stars_key(Compilation& c, const TableView& background) {
  if (!background.has_valid("stars")) return;
  c.scene.sky.star_scale = c.scene.film.exposure * star_scale(c, background);
  if (c.parts.stars) {
    c.scene.sky.stars = *c.parts.stars;
    return;
  }
  std::vector<Star> stars;
  read_stars(c, background, stars);
  c.scene.sky.stars = std::move(stars);
  const bool changes = c.parts.dependence.changes(*background.node_of("stars"));
  if (c.parts.kept && !changes) c.parts.stars = c.scene.sky.stars;
}

}  // namespace

void compile_sky(Compilation& c) {
  const TableView table = TableView::top(c.values, "background");
  Sky& sky = c.scene.sky;
  sky.frame = c.frames.rest_of(table, Vec3{0.0}).frame;
  const double radiance = table.number("radiance");
  const double exposure = c.scene.film.exposure;
  const std::string_view given = table.one_of({"color", "texture", "temperature"});
  check_absolute(table, given);
  if (given == "color") {
    sky.radiance = times(coloured_light(table.vector("color")), radiance * exposure);
  } else if (given == "temperature") {
    if (const auto body = read_blackbody(table)) sky.radiance = times(times(*body, radiance), exposure);
  } else if (given == "texture") {
    sky.texture = read_texture(table, "texture", c.cache);
    sky.texture_scale = radiance * exposure;
  }
  sky.given = !given.empty() || table.node_of("stars") != nullptr;
  // A body may be too cold to be seen at rest, and still be seen by who flies towards it.
  sky.emits =
      radiance > 0.0 && exposure > 0.0 && (sky.texture != nullptr || !sky.radiance.spectrum.is_black());
  read_stars_key(c, table);
}

}  // namespace backlight
