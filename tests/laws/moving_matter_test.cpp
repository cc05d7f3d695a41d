// A path of constant velocity is the inertial body stretched by γ along it: docs/physics.md section 13.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "matter_scenes.h"

namespace backlight::test {
namespace {

struct Body {
  const char* keys;
  Vec3 seen_at;  ///< where its centre is when the camera sees it
};

// All shapes; each table ends with the object's own keys where it has parts.
std::vector<Body> bodies() {
  return {{"shape = \"sphere\"\nradius = 0.9\nmaterial = { checker = { colors = [[0.8, 0.2, 0.1], [0.1, 0.3, "
           "0.7]], size = "
           "0.125 } }\n",
           {-3.2, 1.8, 9}},
          {"shape = \"box\"\nsize = [0.6, 1.2, 1.5]\nmaterial = { color = [0.3, 0.7, 0.2], specular = 0.4, "
           "shininess = 9 "
           "}\n",
           {0, 2.2, 9}},
          {"shape = \"cylinder\"\nradius = 0.7\nheight = 1.3\nmaterial = { color = [0.7, 0.7, 0.2] }\n",
           {3, 1.8, 10}},
          {"shape = \"cone\"\nradius = 0.9\nheight = 1.4\ntop_radius = 0.3\nmaterial = { color = [0.5, 0.1, "
           "0.6], emission = "
           "0.2, temperature = 3500 }\n",
           {-3, -0.2, 8}},
          {"shape = \"torus\"\nmajor = 0.7\nminor = 0.3\nmaterial = { color = [0.1, 0.6, 0.7] }\n",
           {-0.4, 0.1, 8}},
          {"shape = \"disk\"\nradius = 0.9\nmaterial = { checker = { colors = [[0.9, 0.9, 0.9], [0.2, 0.1, "
           "0.1]], size = 0.25 "
           "} }\n",
           {2.4, -0.1, 8}},
          {"shape = \"implicit\"\nf = \"x^4 + y^4 + z^4 - 0.5*x*y - 0.6\"\nmaterial = { color = [0.8, 0.5, "
           "0.4] }\n",
           {1.4, 0.9, 7}},
          {"shape = \"quadric\"\ncoefficients = [1, 2, 3, 0.2, 0, 0, 0.3, 0, 0, -1]\nmaterial = { color = "
           "[0.4, 0.4, 0.9] }\n",
           {-1.7, 1.2, 7}},
          {"shape = \"difference\"\nmaterial = { color = [0.6, 0.6, 0.6] }\n[[object.part]]\nshape = "
           "\"box\"\nsize = [1, 1, "
           "1]\n[[object.part]]\nshape = \"sphere\"\nradius = 0.6\nposition = [0.1, 0.2, -0.4]\nmaterial = { "
           "color = [0.9, 0.2, "
           "0.2] }\n",
           {-1.6, -1.0, 7}},
          {"shape = \"union\"\nblend = 0.4\nmaterial = { color = [0.2, 0.6, 0.4] }\n[[object.part]]\nshape = "
           "\"sphere\"\nradius = 0.5\n[[object.part]]\nshape = \"box\"\nsize = [0.5, 0.7, 0.5]\nposition = "
           "[0.4, 0.4, 0]\n",
           {0.9, -1.0, 7}}};
}

std::string body_keys(const Body& body, const std::string& place) {
  const std::string keys = body.keys;
  const std::size_t parts = keys.find("[[object.part]]");
  return "[[object]]\n" + keys.substr(0, parts) + place +
         (parts == std::string::npos ? "" : keys.substr(parts));
}

// Bodies above and before a floor and a wall, under a lamp at rest, one that passes and a distant light.
std::string stage(const std::string& film_text) {
  return film_text +
         "[[light]]\ntype = \"point\"\nposition = [2, 9, 1]\nintensity = 300\ntemperature = 4000\n"
         "[[light]]\ntype = \"point\"\nposition = [-4, 5, -2]\nbeta = [0.4, 0.1, 0.5]\nintensity = "
         "\"150*(1.2 + "
         "sin(3*t))\"\n"
         "[[light]]\ntype = \"distant\"\ndirection = [1, -1, 0.7]\nirradiance = 1\n"
         "[[object]]\nshape = \"box\"\nsize = [40, 0.5, 30]\nposition = [0, -2.4, 12]\nmaterial = { color = "
         "[0.6, 0.6, "
         "0.55] }\n[[object]]\nshape = \"box\"\nsize = [40, 30, 0.5]\nposition = [0, 0, 16]\n";
}

constexpr const char* still_camera = "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0.05, 1]\nfov = 62\n";
constexpr const char* moving_camera =
    "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0.05, 1]\nfov = 75\nbeta = [0.1, 0.05, -0.3]\n";

double turn_of(std::size_t body) {
  return 17.0 * static_cast<double>(body);
}

// Where it is at time 0, so that its centre's light of `seen_at` reaches the origin then.
Vec3 start_of(const Body& body, const Vec3& velocity) {
  return body.seen_at + glm::length(body.seen_at) * velocity;
}

std::string on_paths(const Oblique& motion) {
  std::string text;
  const std::vector<Body> all = bodies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += body_keys(
        all[i], path(start_of(all[i], motion.velocity()), motion.velocity()) + motion.rotate(turn_of(i)));
  }
  return text;
}

// `rest_sizes`: not stretched, so that it is another body in the world.
std::string inertial(const Oblique& motion) {
  std::string text;
  const std::vector<Body> all = bodies();
  const double gamma = lorentz_factor(motion.velocity());
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += body_keys(all[i], "position = " + list(start_of(all[i], motion.velocity())) +
                                  "\nbeta = " + list(motion.velocity()) +
                                  "\nscale = " + list({gamma, 1.0, 1.0}) + "\n" + motion.rotate(turn_of(i)));
  }
  return text;
}

void expect_seen_alike(const Match& m, double tolerance, double of_colours, const std::string& what) {
  EXPECT_GT(m.seen, 700) << what;
  EXPECT_EQ(m.other_id, 0) << what;
  EXPECT_LT(m.distance.error, tolerance) << what << " Z at " << m.distance.where;
  EXPECT_LT(m.doppler.error, tolerance) << what << " D at " << m.doppler.where;
  EXPECT_LT(m.emission_time.error, tolerance) << what << " emission time at " << m.emission_time.where;
  EXPECT_LT(m.normal.error, tolerance) << what << " normal at " << m.normal.where;
  EXPECT_LT(m.colour.error, of_colours) << what << " colour at " << m.colour.where;
}

// P and the own time are told in the base frame: equations (1) and (36).
void expect_own_coordinates(const Rendering& moving, const Rendering& inertial_picture,
                            const Vec3& velocity) {
  const std::vector<Body> all = bodies();
  const double gamma = lorentz_factor(velocity);
  for (int y = 0; y < moving.height(); ++y) {
    for (int x = 0; x < moving.width(); ++x) {
      const int body = moving.id(x, y) - 3;
      if (body < 0 ||
          !moving.is_inside(std::clamp(x, 1, moving.width() - 2), std::clamp(y, 1, moving.height() - 2)) ||
          inertial_picture.id(x, y) != moving.id(x, y))
        continue;
      const double time = moving.at("emissionTime.T", x, y);
      EXPECT_NEAR(moving.at("properTime.T", x, y), time / gamma, 1e-6 * std::abs(time));
      const Vec3 from_start = moving.position(x, y) - start_of(all[std::size_t(body)], velocity);
      const Vec3 along = glm::normalize(velocity);
      const Vec3 own =
          from_start + (gamma - 1.0) * glm::dot(from_start, along) * along - gamma * time * velocity;
      EXPECT_LT(glm::length(own - inertial_picture.position(x, y)),
                2e-6 * gamma * (10.0 + glm::length(from_start)));
    }
  }
}

class ConstantVelocity : public testing::TestWithParam<double> {};

TEST_P(ConstantVelocity, IsTheInertialBodyStretchedAlongTheMotion) {
  const Oblique motion{GetParam()};
  for (const char* camera : {still_camera, moving_camera}) {
    const std::string rest = stage(film(64, 48)) + camera;
    const Rendering a = render_text(rest + on_paths(motion));
    const Rendering b = render_text(rest + inertial(motion));
    expect_seen_alike(match(a, b), 1e-6, 1e-5, camera);
    expect_own_coordinates(a, b, motion.velocity());
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, ConstantVelocity, testing::Values(0.01, 0.3, 0.7, 0.95, 0.999));

// What goes straight on keeps its form, and is searched as a formula where that is hidden from the program.
TEST(MovingMatter, GoesStraightOnByItsFormAndByAFormulaAlike) {
  const Oblique motion{0.8};
  const std::string known = on_paths(motion);
  std::string hidden = known;
  for (std::size_t at = 0; (at = hidden.find(")*t\"", at)) != std::string::npos;)
    hidden.insert(at += 3, " + 1e-300*sqrt(1 + t^2)");
  for (const char* camera : {still_camera, moving_camera}) {
    const std::string rest = stage(film(64, 48)) + camera;
    expect_same(match(render_text(rest + known), render_text(rest + hidden)), camera);
  }
}

struct Way {
  const char* name;
  const char* more;
  std::vector<std::string> overrides;
};

class EveryWayToLook : public testing::TestWithParam<int> {};

const std::array<Way, 8> ways{{{"equirectangular", "", {"camera.projection=\"equirectangular\""}},
                               {"mercator", "", {"camera.projection=\"mercator\""}},
                               {"fisheye", "", {"camera.projection=\"fisheye\"", "camera.fov=150"}},
                               {"without light delay", "[effects]\nlight_delay = false\n", {}},
                               {"without colour shift", "[effects]\ndoppler = false\n", {}},
                               {"without the searchlight effect", "[effects]\nsearchlight = \"off\"\n", {}},
                               {"the paper's factor", "[effects]\nsearchlight = \"paper\"\n", {}},
                               {"later", "", {"camera.time=0.7"}}}};

TEST_P(EveryWayToLook, ShowsAConstantVelocityAsInertial) {
  const Oblique motion{0.8};
  const Way& way = ways[static_cast<std::size_t>(GetParam())];
  RenderChoices choices;
  choices.overrides = way.overrides;
  const std::string rest = stage(film(64, 48)) + moving_camera + way.more;
  const Rendering a = render_text(rest + on_paths(motion), choices);
  const Rendering b = render_text(rest + inertial(motion), choices);
  expect_seen_alike(match(a, b), 1e-6, 1e-5, way.name);
}

INSTANTIATE_TEST_SUITE_P(Ways, EveryWayToLook, testing::Range(0, static_cast<int>(ways.size())));

TEST(MovingMatter, IsSeenByTwoEyesAsInertialMatterIs) {
  const Oblique motion{0.6};
  RenderChoices choices;
  choices.overrides = {"camera.stereo={ separation = 0.8 }"};
  const std::string rest = stage(film(48, 32)) + moving_camera;
  const Rendering a = render_text(rest + on_paths(motion), choices);
  const Rendering b = render_text(rest + inertial(motion), choices);
  int apart = 0;
  int compared = 0;
  for (const std::string view : {"left", "right"}) {
    const auto named = [&](const char* layer, const char* channel) {
      return layer + ("." + view) + "." + channel;
    };
    const std::string id = named("objectId", "V"), doppler = named("doppler", "D");
    const std::string distance = view == "left" ? "Z" : "right.Z", green = view == "left" ? "G" : "right.G";
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 48; ++x) {
        if (a.at(id.c_str(), x, y) != b.at(id.c_str(), x, y)) {
          ++apart;
          continue;
        }
        if (a.at(id.c_str(), x, y) == 0.0) continue;
        ++compared;
        const auto relative = [&](const std::string& channel) {
          return a.at(channel.c_str(), x, y) / b.at(channel.c_str(), x, y) - 1.0;
        };
        EXPECT_LT(std::abs(relative(distance)), 1e-6);
        EXPECT_LT(std::abs(relative(doppler)), 1e-6);
        if (a.at(green.c_str(), x, y) != b.at(green.c_str(), x, y)) {
          EXPECT_LT(std::abs(relative(green)), 1e-4) << x << ' ' << y << ' ' << view;
        }
      }
    }
  }
  EXPECT_LE(apart, 2);
  EXPECT_GT(compared, 2000);
}

// A velocity beside a position of t means another place for each image, and no motion.
TEST(MovingMatter, WithAVelocityOfZeroIsAtRestElsewhereInEachImage) {
  const std::string rest = stage(film(32, 24)) + still_camera;
  const std::string ball = "[[object]]\nshape = \"sphere\"\nradius = 1\n";
  RenderChoices later;
  later.time = 2.0;
  const Rendering a =
      render_text(rest + ball + "velocity = [0, 0, 0]\nposition = [\"0.4*t - 1\", \"0.1*t\", 6]\n", later);
  const Rendering b = render_text(rest + ball + "position = [-0.2, 0.2, 6]\n", later);
  EXPECT_TRUE(same_bits(a, b));
  EXPECT_EQ(a.at("doppler.D", 16, 12), 1.0);
}

class Constant : public testing::TestWithParam<const char*> {};

// Formulas of t that are constant: what is folded is the body at rest, and what is not looks like it.
TEST_P(Constant, FormulasGiveThePictureOfTheBodyAtRest) {
  const std::string zero = GetParam();
  std::string moving = stage(film(64, 48)) + still_camera;
  std::string still = moving;
  const std::vector<Body> all = bodies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Vec3& at = all[i].seen_at;
    moving += body_keys(all[i], "position = [\"" + digits(at.x) + " + " + zero + "\", " + digits(at.y) +
                                    ", \"" + zero + " + " + digits(at.z) + "\"]\nrotate = [10, \"20 + " +
                                    zero + "\", 30]\n");
    still += body_keys(all[i], "position = " + list(at) + "\nrotate = [10, 20, 30]\n");
  }
  const Rendering a = render_text(moving);
  const Rendering b = render_text(still);
  if (zero == "0*t") {
    EXPECT_TRUE(same_bits(a, b));
  }
  const Match m = match(a, b);
  expect_seen_alike(m, 1e-6, 1e-5, zero);
  EXPECT_LT(m.position.error, 1e-6);
  EXPECT_LT(m.own_time.error, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Zeros, Constant,
                         testing::Values("0*t", "0*sin(t)", "t - t", "sin(t)^2 + cos(t)^2 - 1"));

}  // namespace
}  // namespace backlight::test
