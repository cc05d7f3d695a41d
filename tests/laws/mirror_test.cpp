// Mirrors: docs/physics.md section 11, on rendered images.
// Longer than 400 lines: the laws of one thing, which share what makes and compares the pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"
#include "backlight/scene/needs.h"
#include "four_vector.h"
#include "matter_scenes.h"
#include "redescription.h"

namespace backlight::test {
namespace {

std::string film_with_mirrors(int width, int height, const std::string& more = {}) {
  return "[film]\nresolution = [" + std::to_string(width) + ", " + std::to_string(height) +
         "]\naovs = [\"Z\", \"doppler\", \"emissionTime\", \"properTime\", \"P\", \"N\", \"objectId\", "
         "\"mirror\"]\n" +
         more;
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double relative(double a, double b) {
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

int mirrored_id(const Rendering& picture, int x, int y) {
  return static_cast<int>(picture.at("mirror.V", x, y));
}

template <class Look>
void for_each_pixel(const Rendering& picture, const Look& look) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) look(x, y);
}

// The traced null vector of the camera, at rest in the world, after a mirror of this velocity and normal (in
// its own frame), in the world.
FourVector reflected(const Vec3& looking, const Vec3& velocity, const Vec3& normal) {
  FourVector n = boosted({-1.0, looking}, velocity);
  n.x -= 2.0 * glm::dot(n.x, normal) * normal;
  return boosted(n, -velocity);
}

// Einstein 1905, section 8. Of the light that arrives, with φ' against the mirror's velocity (as he has it:
// after the reflection the angle of the light's way back), cos φ of what came in.
TEST(Mirror, MovingAlongItsNormalShiftsAsEinsteinSays) {
  for (const double beta : {-0.9, -0.5, 0.1, 0.6}) {
    const Rendering picture = render_text(
        film_with_mirrors(60, 44) +
        "[camera]\ndirection = [0.2, 0.1, 1]\nfov = 80\n[background]\ncolor = [1, 1, 1]\n"
        "[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nposition = [0, 0, 5]\nbeta = [0, 0, " +
        digits(beta) + "]\nmaterial = { mirror = 1 }\n");
    int seen = 0;
    Worst frequency;
    for_each_pixel(picture, [&](int x, int y) {
      if (picture.id(x, y) != 1) return;
      ++seen;
      const double after = picture.direction(x, y).z;
      const double before = ((1 + beta * beta) * after + 2 * beta) / (1 + 2 * beta * after + beta * beta);
      const double shift = (1 - 2 * beta * before + beta * beta) / (1 - beta * beta);
      frequency.take(relative(picture.at("mirror.D", x, y), shift));
    });
    EXPECT_GT(seen, 1000) << beta;
    EXPECT_LT(frequency.error, 1e-6) << beta;  // the channel is a float
  }
}

// Matter behind the camera, lit by a lamp there, and the mirror before it.
struct Behind {
  const char* keys;
  Vec3 position;
  Vec3 rotate;
};
const std::vector<Behind> behind{
    {"shape = \"sphere\"\nradius = 1.2\nmaterial = { color = [0.8, 0.3, 0.2] }\n", {1.5, 0.4, -5}, {}},
    {"shape = \"box\"\nsize = [1.4, 0.8, 2]\nmaterial = { color = [0.2, 0.6, 0.3], specular = 0.3 }\n",
     {-1.8, -0.2, -4},
     {25, 40, -15}},
    {"shape = \"sphere\"\nradius = 0.9\nmaterial = { emission = 0.5, temperature = 4500 }\n",
     {-0.2, 1.9, -6},
     {}},
    {"shape = \"box\"\nsize = [30, 1, 30]\nmaterial = { color = [0.5, 0.5, 0.6] }\n", {0, -2.6, -14}, {}}};
const Vec3 lamp_behind{2, 6, -3};
constexpr double mirror_at = 6.0;

// Where the mirror image of a point at rest is at world time 0. Its velocity is 2β/(1+β²).
Vec3 image_of(const Vec3& p, double beta) {
  const double behind_mirror = (mirror_at - p.z) * (1 - beta * beta) / (1 + beta * beta);
  return {p.x, p.y, mirror_at + behind_mirror};
}

// When the light left that is seen at this world event of the image: the reflection at a mirror that moves is
// its own inverse, t -> γ²((1+β²) t - 2β z), z from where the mirror is at time 0.
double time_of_original(const FourVector& event, double beta) {
  return ((1 + beta * beta) * event.t - 2 * beta * (event.x.z - mirror_at)) / (1 - beta * beta);
}

struct Eye {
  Vec3 position, velocity;
  Vec3 looking;
  double fov;
};

void expect_virtual_objects(double beta, const Eye& eye) {
  const std::string top = "c = 1\n" + film_with_mirrors(80, 60, "wavelengths = 96\n") +
                          "[camera]\nposition = " + list(eye.position) + "\nbeta = " + list(eye.velocity) +
                          "\ndirection = " + list(eye.looking) + "\nfov = " + digits(eye.fov) + "\n";
  std::string real = top, images = top;
  const double speed = 2 * beta / (1 + beta * beta);
  const std::string moves = "beta = [0, 0, " + digits(speed) + "]\n";
  for (const Behind& b : behind) {
    real += std::string("[[object]]\n") + b.keys + "position = " + list(b.position) +
            "\nrotate = " + list(b.rotate) + "\n";
    images += std::string("[[object]]\n") + b.keys + moves +
              "position = " + list(image_of(b.position, beta)) +
              "\nrotate = " + list({-b.rotate.x, -b.rotate.y, b.rotate.z}) + "\n";
  }
  const std::string lamp = "[[light]]\nintensity = 90\ntemperature = 5200\nposition = ";
  real += "[[object]]\nshape = \"plane\"\ncasts_shadow = false\nrotate = [90, 0, 0]\nposition = [0, 0, " +
          digits(mirror_at) + "]\nbeta = [0, 0, " + digits(beta) + "]\nmaterial = { mirror = 1 }\n" + lamp +
          list(lamp_behind) + "\n";
  images += lamp + list(image_of(lamp_behind, beta)) + "\n" + moves;
  const Rendering a = render_text(real), b = render_text(images);
  std::array<int, 5> seen{};
  int other = 0;
  Worst time, doppler, colour;
  for (int y = 1; y + 1 < b.height(); ++y) {
    for (int x = 1; x + 1 < b.width(); ++x) {
      if (!b.is_inside(x, y) || a.id(x, y) != 5) continue;
      const int id = b.id(x, y);
      ++seen[static_cast<std::size_t>(id)];
      other += mirrored_id(a, x, y) != id ? 1 : 0;
      if (id == 0 || mirrored_id(a, x, y) != id) continue;
      const double z = b.at("Z", x, y);
      FourVector event = boosted({-z, z * b.direction(x, y)}, -eye.velocity);
      event.x += eye.position;
      time.take(relative(a.at("mirror.T", x, y), time_of_original(event, beta)));
      doppler.take(relative(a.at("mirror.D", x, y), b.at("doppler.D", x, y)));
      const Vec3 rgb = b.rgb(x, y);
      if (largest(rgb) > 0.0) colour.take(largest(a.rgb(x, y) - rgb) / largest(rgb));
    }
  }
  for (int id = 1; id <= 4; ++id) EXPECT_GT(seen[static_cast<std::size_t>(id)], 8) << id << " at " << beta;
  EXPECT_EQ(other, 0) << beta;
  EXPECT_LT(time.error, 3e-6) << beta;  // of what is told in floats
  EXPECT_LT(doppler.error, 1e-6) << beta;
  EXPECT_LT(colour.error, 2e-6) << beta;
}

TEST(Mirror, ShowsWhatMatterMovingAsItsImageWould) {
  const Vec3 at{0, 0.3, 0}, looking{0.0, -0.02, 1};
  expect_virtual_objects(-0.5, {at, Vec3{0.0}, looking, 12});
  expect_virtual_objects(-0.2, {at, Vec3{0.0}, looking, 26});
  expect_virtual_objects(0.0, {at, Vec3{0.0}, looking, 40});
  expect_virtual_objects(0.3, {at, Vec3{0.0}, looking, 60});
  expect_virtual_objects(-0.3, {at, {0.35, 0.2, -0.3}, {0.25, 0.1, 1}, 40});
  expect_virtual_objects(0.1, {at, {-0.2, 0.1, 0.6}, {-0.05, 0, 1}, 30});
}

// What rests over a floor, which is a mirror.
std::string over_floor(const std::string& floor) {
  return film_with_mirrors(72, 54) +
         "[camera]\nposition = [0, 2, -7]\ndirection = [0, -0.25, 1]\nfov = 60\nbeta = [0.2, 0, 0.3]\n"
         "[background]\ncolor = [0.2, 0.3, 0.6]\n[[light]]\nposition = [3, 6, -4]\nintensity = 120\n"
         "[[object]]\nshape = \"box\"\nsize = [1, 1.5, 1]\nposition = [-1.5, 1, 2]\nrotate = [0, 30, 0]\n"
         "material = { color = [0.7, 0.5, 0.1] }\n"
         "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [1.2, 1.4, 3]\nmaterial = { color = [0.1, "
         "0.4, 0.8] }\n"
         "[[object]]\ncasts_shadow = false\n" +
         floor;
}

void expect_same_mirrored(const Rendering& a, const Rendering& b, double tolerance, const std::string& what) {
  int seen = 0, other = 0;
  Worst data, colour;
  for (int y = 1; y + 1 < a.height(); ++y) {
    for (int x = 1; x + 1 < a.width(); ++x) {
      if (!a.is_inside(x, y)) continue;
      bool edge = false;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) edge |= mirrored_id(a, x + i, y + j) != mirrored_id(a, x, y);
      if (edge) continue;
      other += a.id(x, y) != b.id(x, y) || mirrored_id(a, x, y) != mirrored_id(b, x, y) ? 1 : 0;
      if (a.id(x, y) != b.id(x, y)) continue;
      if (a.at("mirror.D", x, y) == 0.0) continue;
      ++seen;
      if (a.scene.sky.given || mirrored_id(a, x, y) > 0)
        data.take(relative(a.at("mirror.D", x, y), b.at("mirror.D", x, y)), "D");
      if (mirrored_id(a, x, y) > 0) data.take(relative(a.at("mirror.Z", x, y), b.at("mirror.Z", x, y)), "Z");
      const Vec3 rgb = a.rgb(x, y);
      if (largest(rgb) > 0.0) colour.take(largest(rgb - b.rgb(x, y)) / largest(rgb));
    }
  }
  EXPECT_GT(seen, 200) << what;
  EXPECT_EQ(other, 0) << what;
  EXPECT_LT(data.error, tolerance) << what << ' ' << data.where;
  EXPECT_LT(colour.error, 10 * tolerance) << what;
}

TEST(Mirror, MovingInItsOwnPlaneShowsThePictureOfOneAtRest) {
  const std::string plane = "shape = \"plane\"\nmaterial = { mirror = [0.9, 0.7, 0.8] }\n";
  const std::string grey = "shape = \"plane\"\nmaterial = { mirror = 0.8 }\n";
  const Rendering still = render_text(over_floor(grey));
  for (const char* velocity :
       {"beta = [0.9, 0, 0]\n", "beta = [0.4, 0, -0.7]\n", "gamma = 1000\nalong = [1, 0, 2]\n"}) {
    expect_same_mirrored(still, render_text(over_floor(grey + velocity)), 2e-6, velocity);
  }
  // A coloured one reflects at its own wavelengths: its picture differs.
  const Rendering coloured = render_text(over_floor(plane));
  const Rendering moving = render_text(over_floor(plane + "beta = [0.9, 0, 0]\n"));
  double difference = 0.0;
  for_each_pixel(coloured, [&](int x, int y) {
    if (coloured.id(x, y) == 3)
      difference = std::max(difference, largest(coloured.rgb(x, y) - moving.rgb(x, y)));
  });
  EXPECT_GT(difference, 0.01);
}

// A ball that turns moves in its own surface.
TEST(Mirror, OnABallThatTurnsShowsThePictureOfOneThatDoesNot) {
  const std::string ball =
      "shape = \"sphere\"\nradius = 1.5\nposition = [0, 1.2, 0]\nmaterial = { mirror = 0.9 }\n";
  const Rendering still = render_text(over_floor(ball));
  expect_same_mirrored(still, render_text(over_floor(ball + "rotate = [0, \"25*t\", 0]\n")), 2e-6, "slow");
  expect_same_mirrored(still, render_text(over_floor(ball + "rotate = [20, 30, \"30*t\"]\n")), 2e-6,
                       "oblique");
}

std::string in_bath(const std::string& camera, const std::string& ball) {
  return film_with_mirrors(64, 48, "wavelengths = 96\n") +
         "[background]\ntemperature = 5000\n[camera]\ndirection = [0, 0, 1]\nfov = 110\n" + camera + ball;
}

// A perfect mirror at rest in an isotropic bath cannot be seen, however the camera moves.
TEST(Mirror, AtRestInAnIsotropicBathIsNotSeen) {
  const std::string ball =
      "[[object]]\nshape = \"sphere\"\nradius = 1.5\nposition = [0.3, 0.2, 6]\nmaterial = { mirror = 1 }\n";
  for (const char* velocity :
       {"beta = [0, 0, 0.9]\n", "beta = [0.5, 0.1, -0.6]\n", "beta = [0.8, 0, 0.1]\n"}) {
    const Rendering with = render_text(in_bath(velocity, ball)), without = render_text(in_bath(velocity, ""));
    Worst colour;
    int seen = 0;
    for_each_pixel(with, [&](int x, int y) {
      seen += with.id(x, y);
      const Vec3 rgb = without.rgb(x, y);
      colour.take(largest(with.rgb(x, y) - rgb) / largest(rgb));
    });
    EXPECT_GT(seen, 0) << velocity;
    EXPECT_LT(colour.error, 1e-6) << velocity;
  }
}

// One that moves in the bath shows a blackbody of D T everywhere, D by its own frame.
TEST(Mirror, MovingInAnIsotropicBathShowsABlackbodyEverywhere) {
  for (const Vec3 velocity : {Vec3{0.8, 0, 0}, Vec3{0.3, 0.2, -0.6}, Vec3{0, 0, -0.7}}) {
    const Vec3 seen_at{0.3, 0.2, 6.0};
    const Rendering picture =
        render_text(in_bath("", "[[object]]\nshape = \"sphere\"\nradius = 1.5\nposition = " +
                                    list(seen_at + glm::length(seen_at) * velocity) +
                                    "\nbeta = " + list(velocity) + "\nmaterial = { mirror = 1 }\n"));
    Worst doppler, colour;
    for_each_pixel(picture, [&](int x, int y) {
      if (picture.id(x, y) != 1) return;
      const double d = -1.0 / reflected(picture.direction(x, y), velocity, picture.normal(x, y)).t;
      doppler.take(relative(picture.at("mirror.D", x, y), d));
      const Spectrum body = Spectrum::blackbody(5000.0 * d, 5000.0);
      const Vec3 rgb = film_colour(body);
      colour.take(largest(picture.rgb(x, y) - rgb) / largest(rgb));
    });
    EXPECT_GT(doppler.compared, 50);
    EXPECT_LT(doppler.error, 1e-5) << velocity.x;
    EXPECT_LT(colour.error, 1e-4) << velocity.x;
  }
}

// Between two mirrors 4 apart, a ball is seen again and again, farther off by the way to and fro.
TEST(Mirror, TwoThatFaceEachOtherShowAsManyImagesAsAreAllowed) {
  const auto hall = [](int bounces) {
    return "[film]\nresolution = [400, 40]\nbounces = " + std::to_string(bounces) +
           "\naovs = [\"objectId\", \"mirror\", \"Z\"]\n"
           "[camera]\nposition = [1, 0.02, 0]\ndirection = [0, 0, 1]\nfov = 120\n"
           "[[object]]\nshape = \"plane\"\nrotate = [0, 0, 90]\nposition = [2, 0, 0]\nmaterial = { mirror = "
           "0.8 }\n"
           "[[object]]\nshape = \"plane\"\nrotate = [0, 0, 90]\nposition = [-2, 0, 0]\nmaterial = { mirror = "
           "0.8 "
           "}\n"
           "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [-0.5, 0, 9]\nmaterial = { emission = 1 "
           "}\n";
  };
  for (const int bounces : {0, 1, 4}) {
    const Rendering picture = render_text(hall(bounces));
    int images = 0;
    for (int k = -7; k <= 7; ++k) {
      // The k-th image is at 4k ± (-0.5), |k| reflections away; the camera has x = 1.
      const double x = 4.0 * k + (k % 2 == 0 ? -0.5 : 0.5);
      const Vec3 way = Vec3{x, 0, 9} - Vec3{1, 0.02, 0};
      const auto point = point_of(picture.scene.camera.lens, glm::normalize(way));
      if (!point || point->x < 1 || point->x > 399) continue;
      const int px = static_cast<int>(point->x), py = static_cast<int>(point->y);
      const bool shown = std::abs(k) <= bounces;
      images += shown ? 1 : 0;
      EXPECT_NEAR(picture.at("R", px, py), shown ? std::pow(0.8, std::abs(k)) : 0.0, 1e-3) << k;
      if (k == 0) continue;
      EXPECT_EQ(mirrored_id(picture, px, py) == 3, shown) << k;
      if (!shown) continue;
      EXPECT_NEAR(picture.at("mirror.Z", px, py), glm::length(way) - 0.5, 0.1) << k;
    }
    EXPECT_EQ(images, std::min(2 * bounces + 1, 8)) << bounces;
    EXPECT_GT(picture.statistics.rays.ended, 0U);
  }
}

SceneModel mirrors_in_motion() {
  SceneModel m;
  m.film = film_with_mirrors(72, 54, "wavelengths = 96\n");
  m.frames = {{"ground", {0, 0, 0}, {}},
              {"eye", {0.3, 0.05, 0.6}, {0.5, 0.2, 1.5, -8}},
              {"glass", {-0.4, 0.1, -0.3}, {0.0, 0.5, 1.0, 3.0}},
              {"ball", {-0.7, 0.6, 0.2}, {-9.02, 1.5, 1.5, 0}},
              {"lamp", {0.9, 0, 0.9}, {-8, -9, 7, -12}}};
  m.camera = {"eye", {0, 0, 0}, {0.1, -0.15, 1}, {0, 1, 0}, 0.4};
  m.objects = {
      {"ground",
       "shape = \"plane\"\nmaterial = { color = [0.6, 0.6, 0.5], mirror = [0.5, 0.4, 0.2] }",
       {0, -1, 0},
       {0, 0, 0}},
      {"glass", "shape = \"box\"\nsize = [5, 3, 0.2]\nmaterial = { mirror = 0.9 }", {0, 0, 0}, {10, 25, 5}},
      {"ball",
       "shape = \"sphere\"\nradius = 0.9\nmaterial = { mirror = [0.9, 0.6, 0.3] }",
       {0, 0, 0},
       {0, 0, 0}},
      {"ball",
       "shape = \"sphere\"\nradius = 0.5\nmaterial = { color = [0.8, 0.8, 0.2] }",
       {-1.6, 0.3, 0.5},
       {0, 0, 0}},
      {"ground",
       "shape = \"box\"\nsize = [1.5, 3, 1.5]\nmaterial = { color = [0.5, 0.5, 0.7] }",
       {-4, 0.5, 3},
       {0, 20, 0}}};
  m.lights = {
      {"lamp", "type = \"point\"\nintensity = \"300*(1.5 + sin(2*t))\"\ntemperature = 5000", {0, 0, 0}}};
  return m;
}

TEST(Mirror, ScenesToldFromAnotherFrameAreTheSamePicture) {
  const SceneModel original = mirrors_in_motion();
  const Rendering a = render_text(to_toml(original));
  std::set<int> in_mirrors;
  for_each_pixel(a, [&](int x, int y) { in_mirrors.insert(mirrored_id(a, x, y)); });
  EXPECT_GE(in_mirrors.size(), 3U);
  for (const double celerity : {0.3, 3.0, 100.0, 1000.0}) {
    const Redescription other = redescribed(original, celerity * Vec3{0.48, -0.6, 0.64});
    expect_same_mirrored(a, render_text(to_toml(other.model)), 3e-6, digits(celerity));
  }
  for (const double celerity : {1e3, 1e6, 1e8}) {
    const Redescription other = within_frame(original, celerity * Vec3{0.48, -0.6, 0.64});
    expect_same_mirrored(a, render_text(to_toml(other.model)), 3e-6, digits(celerity));
  }
}

// A line arrives at one wavelength; what the mirror leaves of it is its reflectance where the line is in the
// mirror's frame.
TEST(Mirror, ReflectsALineAtItsOwnWavelength) {
  const Vec3 velocity{0.0, 0.0, -0.12};
  const Rendering picture = render_text(
      film_with_mirrors(40, 30) +
      "[camera]\ndirection = [0.1, 0, 1]\nfov = 60\n"
      "[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nposition = [0, 0, 5]\nbeta = " +
      list(velocity) +
      "\nmaterial = { mirror = [0.9, 0.4, 0.1] }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 3\nposition = [0, 0, -6]\n"
      "material = { color = [0, 0, 0], emission = 1, lines = { wavelengths = [589], values = [1] } }\n");
  const Spectrum share = Spectrum::reflectance({0.9, 0.4, 0.1});
  const auto film = [](double nm) { return rgb_from_xyz(colour_matching_functions(nm)); };
  Worst colour;
  for_each_pixel(picture, [&](int x, int y) {
    if (mirrored_id(picture, x, y) != 2) return;
    const Vec3 looking = picture.direction(x, y);
    const double to_mirror = -1.0 / boosted({-1.0, looking}, velocity).t;
    const double d = -1.0 / reflected(looking, velocity, {0, 0, 1}).t;
    const double at_mirror = 589.0 / d * to_mirror;
    const Vec3 expected = std::pow(d, 4) * share.at(at_mirror) / luminance(film(589)) * film(589.0 / d);
    colour.take(largest(picture.rgb(x, y) - expected) / largest(expected));
  });
  EXPECT_GT(colour.compared, 80);
  EXPECT_LT(colour.error, 1e-4);
}

// What is white or grey has the mirror's own colour, whether red, green and blue or, because something else
// moves, spectra are multiplied. (Of coloured things the two differ: a product of spectra is not that of
// their colours.)
TEST(Mirror, ColoursAtRestAgreeWithTheSpectra) {
  const std::string scene =
      film_with_mirrors(48, 36) +
      "[camera]\nposition = [0, 1.5, -6]\ndirection = [0, -0.2, 1]\n[background]\ncolor = [0.5, 0.5, 0.5]\n"
      "[[light]]\nposition = [2, 5, -4]\nintensity = 100\n"
      "[[object]]\nshape = \"plane\"\nmaterial = { mirror = [0.8, 0.5, 0.3] }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [0, 1.3, 0]\nmaterial = { color = [0.6, 0.6, "
      "0.6] }\n";
  const std::string passing =
      "[[object]]\nshape = \"sphere\"\nradius = 0.1\nposition = [0, -50, 0]\nbeta = [0.5, 0, 0]\n";
  const Rendering rgb = render_text(scene), spectral = render_text(scene + passing);
  ASSERT_FALSE(needs_of(rgb.scene).spectral);
  ASSERT_TRUE(needs_of(spectral.scene).spectral);
  Worst colour;
  for_each_pixel(rgb, [&](int x, int y) {
    if (rgb.id(x, y) == 1 && largest(rgb.rgb(x, y)) > 0.0)
      colour.take(largest(rgb.rgb(x, y) - spectral.rgb(x, y)) / largest(rgb.rgb(x, y)));
  });
  EXPECT_GT(colour.compared, 300);
  EXPECT_LT(colour.error, 1e-4);
}

// Without light delay light arrives at a mirror as it does from a lamp: late, and shifted by their motion
// alone.
TEST(Mirror, WithoutLightDelayIsLitAsByLamps) {
  const Vec3 velocity{0.0, 0.0, 0.4};
  const Rendering picture = render_text(
      film_with_mirrors(40, 30) +
      "[effects]\nlight_delay = false\n[camera]\ndirection = [0, 0, 1]\n[background]\ntemperature = 6000\n"
      "[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nposition = [0, 0, 5]\nbeta = " +
      list(velocity) + "\nmaterial = { mirror = 1 }\n");
  EXPECT_TRUE(needs_of(picture.scene).spectral);
  Worst doppler;
  for_each_pixel(picture, [&](int x, int y) {
    // The way there in the mirror's frame, by the simultaneous (0; d); from there on light.
    const Vec3 way = glm::normalize(boosted({0.0, picture.direction(x, y)}, velocity).x);
    const FourVector n = boosted({-1.0, way * Vec3{1, 1, -1}}, -velocity);
    doppler.take(relative(picture.at("mirror.D", x, y), -1.0 / n.t));
  });
  EXPECT_EQ(doppler.compared, 40 * 30);
  EXPECT_LT(doppler.error, 1e-6);
}

}  // namespace
}  // namespace backlight::test
