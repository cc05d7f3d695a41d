// Stars in mirrors and through glass: docs/physics.md equation (33a), on rendered images.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "backlight/colour/observer.h"
#include "four_vector.h"
#include "matter_scenes.h"

namespace backlight::test {
namespace {

struct Velocities {
  Vec3 matter{0.0}, camera{0.0}, sky{0.0};
};

// What a star is seen as by a camera of those velocities.
struct Seen {
  Vec3 direction;
  double doppler;
  double cosine;  // at the surface, in its frame
};

// By way of a plane with this normal, if it is a mirror.
Seen seen(const Vec3& star, const Velocities& v, const Vec3& normal, bool mirrored) {
  FourVector n = boosted(boosted({-1.0, star}, -v.sky), v.matter);
  const double cosine = std::abs(glm::dot(n.x, normal) / n.t);
  if (mirrored) n.x -= 2.0 * glm::dot(n.x, normal) * normal;
  n = boosted(boosted(n, -v.matter), v.camera);
  return {n.x / -n.t, -n.t, cosine};
}

// The sum of what stars are expected to be, pixel by pixel.
class ExpectedStars {
 public:
  explicit ExpectedStars(const Rendering& picture)
      : lens_(picture.scene.camera.lens),
        sky_(picture.scene.sky),
        light_(static_cast<std::size_t>(lens_.width * lens_.height), Vec3{0.0}),
        doubtful_(light_.size(), false) {}

  void add(const Star& star, const Seen& as, double share) {
    const auto at = point_of(lens_, as.direction);
    if (!at) return;
    const auto place = index(static_cast<int>(at->x), static_cast<int>(at->y));
    const auto near_edge = [](double x) { return std::abs(x - std::round(x)) < 1e-6; };
    if (near_edge(at->x) || near_edge(at->y)) doubtful_[place] = true;
    const Spectrum body = Spectrum::blackbody(star.temperature).scaled(sky_.star_scale * star.illuminance);
    const Vec3 colour = wavelength_set(default_wavelength_count).lights().at(body, 1.0)->film();
    light_[place] += share * as.doppler * as.doppler * colour /
                     pixel_solid_angle(lens_, {std::floor(at->x) + 0.5, std::floor(at->y) + 0.5});
    ++stars_;
  }

  // Of all pixels that show object 1 to all sides, relative to the larger value; but for `unseen` of each.
  [[nodiscard]] Worst difference(const Rendering& picture, double unseen = 0.0) const {
    Worst worst;
    for (int y = 1; y + 1 < picture.height(); ++y) {
      for (int x = 1; x + 1 < picture.width(); ++x) {
        if (picture.id(x, y) != 1 || !picture.is_inside(x, y) || doubtful_[index(x, y)]) continue;
        const Vec3 a = picture.rgb(x, y), b = light_[index(x, y)];
        const double size = std::max(glm::length(a), glm::length(b));
        if (size > 0.0) worst.take(std::max(0.0, glm::length(a - b) - unseen) / size);
      }
    }
    return worst;
  }
  [[nodiscard]] int stars() const { return stars_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y * lens_.width + x);
  }

  Lens lens_;
  Sky sky_;
  std::vector<Vec3> light_;
  std::vector<bool> doubtful_;
  int stars_ = 0;
};

// A wall before the camera, obliquely, of a material.
const Vec3 tilt{74, 0, 21};
Vec3 normal_of_wall() {
  const double a = tilt.x * std::numbers::pi / 180.0, b = tilt.z * std::numbers::pi / 180.0;
  const Vec3 about_x{0.0, std::cos(a), std::sin(a)};  // of +y, about x, then about z
  return {std::cos(b) * about_x.x - std::sin(b) * about_x.y,
          std::sin(b) * about_x.x + std::cos(b) * about_x.y, about_x.z};
}

std::string sky_and_wall(const Velocities& v, const std::string& wall) {
  return film(96, 72) +
         "[effects]\ndoppler = false\n[background]\nstars = { count = 4000, seed = 5 }\nbeta = " +
         list(v.sky) +
         "\n[camera]\nposition = [0, 0, -4]\ndirection = [0.1, 0.05, 1]\nfov = 50\nbeta = " + list(v.camera) +
         "\n[[object]]\nrotate = " + list(tilt) + "\nbeta = " + list(v.matter) + "\n" + wall;
}

const std::vector<Velocities> motions{
    {},
    {.matter = {0.36, 0.0, 0.48}},
    {.matter = {-0.3, 0.2, -0.3}, .camera = {0.2, -0.1, 0.5}},
    {.matter = {0.1, 0.3, 0.2}, .camera = {0.4, 0, -0.2}, .sky = {0, 0.7, 0}}};

TEST(PassedStars, ArePointsInAFlatMirrorWhereItsLawSaysAndAsBright) {
  const Vec3 normal = normal_of_wall();
  for (const Velocities& v : motions) {
    const Rendering picture =
        render_text(sky_and_wall(v, "shape = \"plane\"\nmaterial = { mirror = [0.9, 0.5, 0.7] }\n"));
    ExpectedStars expected(picture);
    for (const Star& star : picture.scene.sky.stars)
      expected.add(star, seen(star.direction, v, normal, true), 1);
    // The mirror's colour is a factor on each.
    Rendering plain = render_text(sky_and_wall(v, "shape = \"plane\"\nmaterial = { mirror = 1 }\n"));
    const Worst worst = expected.difference(plain);
    EXPECT_GT(worst.compared, 20) << list(v.matter);
    EXPECT_LT(worst.error, 3e-6) << list(v.matter);
    Worst coloured;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (plain.id(x, y) != 1) continue;
        const Vec3 want = Vec3{0.9, 0.5, 0.7} * plain.rgb(x, y);
        if (glm::length(want) > 0.0) coloured.take(glm::length(picture.rgb(x, y) - want) / glm::length(want));
      }
    }
    EXPECT_LT(coloured.error, 1e-6);
  }
}

// Both faces of a slab reflect; all together, without the differences of phase that thick glass does not
// show, leave (1 - R)/(1 + R) of what is behind it and mirror 2R/(1 + R) of what is before it.
TEST(PassedStars, KeepTheirPlacesBehindASlabOfGlass) {
  const Vec3 normal = normal_of_wall();
  for (const Velocities& v : motions) {
    const Rendering picture = render_text(sky_and_wall(
        v, "shape = \"box\"\nsize = [4000, 0.3, 4000]\nmaterial = { glass = { index = 1.5 } }\n"));
    ExpectedStars expected(picture);
    for (const Star& star : picture.scene.sky.stars) {
      const Seen through = seen(star.direction, v, normal, false);
      const Seen reflected = seen(star.direction, v, normal, true);
      const double c = through.cosine;
      const double within = std::sqrt(1.0 - (1.0 - c * c) / 2.25);
      const double across = (c - 1.5 * within) / (c + 1.5 * within);
      const double along = (1.5 * c - within) / (1.5 * c + within);
      const double r = 0.5 * (across * across + along * along);
      const FourVector at_rest = boosted(boosted({-1.0, star.direction}, -v.sky), v.matter);
      // The camera is on the side to which -normal points; light from there is reflected.
      const bool before = glm::dot(at_rest.x, normal) < 0.0;
      if (before) {
        expected.add(star, reflected, 2.0 * r / (1.0 + r));
      } else {
        expected.add(star, through, (1.0 - r) / (1.0 + r));
      }
    }
    // Images of less than half a step of an 8-bit screen are put where straight lines say, or cut off.
    const Worst worst = expected.difference(picture, 2.0 * 0.5 / 255.0 / 12.92);
    EXPECT_GT(worst.compared, 20) << list(v.matter);
    EXPECT_LT(worst.error, 2e-4) << list(v.matter);
  }
}

// A ball of radius r sends light of irradiance E, from any direction, evenly to all sides: E r²/(4 d²)
// arrives at the distance d.
TEST(PassedStars, ShineInAMirrorBallEvenlyToAllSides) {
  const double distance = 4000.0;
  for (const char* camera : {"direction = [0, 0, 1]\nposition = [0, 0, -4000]\n",
                             "direction = [-0.6, 0, -0.8]\nposition = [2400, 0, 3200]\n"}) {
    const Rendering picture = render_text(
        film(64, 64) + "[effects]\ndoppler = false\n[background]\nstars = { count = 900, seed = 3 }\n" +
        "[camera]\nfov = 0.03\n" + camera +
        "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { mirror = 1 }\n");
    double sum = 0.0, all = 0.0;
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x)
        sum += picture.rgb(x, y).g * pixel_solid_angle(picture.scene.camera.lens, {x + 0.5, y + 0.5});
    }
    const Sky& sky = picture.scene.sky;
    for (const Star& star : sky.stars) {
      const Spectrum body = Spectrum::blackbody(star.temperature).scaled(sky.star_scale * star.illuminance);
      all += wavelength_set(default_wavelength_count).lights().at(body, 1.0)->film().g;
    }
    // Of those within some degrees of what is right behind the ball, the rim's last eighth of a pixel lacks
    // some.
    EXPECT_NEAR(sum / (all / (4.0 * distance * distance)), 0.98, 0.02);
  }
}

// A mirror that recedes shifts a star's colours as the star's own motion would.
TEST(PassedStars, AreShiftedByTheMirror) {
  const auto brightest = [](const Rendering& picture) {
    Vec3 found{0.0};
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) found = glm::max(found, picture.rgb(x, y));
    }
    return found;
  };
  for (const double beta : {-0.4, 0.3}) {
    const std::string top = film(40, 30) + "[background]\nstars = \"tests/laws/one_star.csv\"\n";
    const Rendering mirror = render_text(top +
                                         "[camera]\ndirection = [0.002, 0.001, -1]\nfov = 10\n"
                                         "[[object]]\nshape = \"plane\"\nrotate = [-90, 0, 0]\n"
                                         "position = [0, 0, -5]\nbeta = [0, 0, " +
                                         digits(-beta) + "]\nmaterial = { mirror = 1 }\n");
    const double twice = 2.0 * beta / (1.0 + beta * beta);
    const Rendering sky =
        render_text(film(40, 30) + "[background]\nstars = \"tests/laws/one_star.csv\"\nbeta = [0, 0, " +
                    digits(twice) + "]\n[camera]\ndirection = [-0.002, 0.001, 1]\nfov = 10\n");
    const Vec3 a = brightest(mirror), b = brightest(sky);
    ASSERT_GT(b.g, 0.0);
    EXPECT_LT(glm::length(a - b), 1e-5 * glm::length(b)) << beta << ": " << list(a) << list(b);
  }
}

}  // namespace
}  // namespace backlight::test
