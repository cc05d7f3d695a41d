// Glass: docs/physics.md section 12, on rendered images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "matter_scenes.h"
#include "redescription.h"

namespace backlight::test {
namespace {

std::string film_through_glass(int width, int height, const std::string& more = "bounces = 40\n") {
  return "c = 1\n[film]\nresolution = [" + std::to_string(width) + ", " + std::to_string(height) +
         "]\naovs = [\"Z\", \"doppler\", \"objectId\", \"mirror\"]\n" + more;
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double relative(double a, double b) {
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

// Fresnel's share for unpolarised light, by the angles.
double reflected_share(double cosine, double n) {
  const double a = std::acos(cosine), b = std::asin(std::sin(a) / n);
  if (a < 1e-6) return (n - 1) * (n - 1) / ((n + 1) * (n + 1));
  const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
  return 0.5 * (s * s + p * p);
}

// A shining floor under water, under a shining sky: R of the one and the rest of the other.
TEST(Glass, PartsLightAsSnellAndFresnelSay) {
  const double n = 1.4, depth = 1.5, height = 2.0;
  const Rendering picture = render_text(
      film_through_glass(60, 40) + "[camera]\nposition = [0, 2, 0]\ndirection = [0, -1, 1.2]\nfov = 70\n" +
      "[background]\ncolor = [1, 1, 1]\n"
      "[[object]]\nshape = \"plane\"\nmaterial = { glass = { index = 1.4 } }\n"
      "[[object]]\nshape = \"plane\"\nposition = [0, -1.5, 0]\nmaterial = { color = [0, 0, 0], emission = "
      "0.25 "
      "}\n");
  Worst colour, way;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      if (picture.id(x, y) != 1) continue;
      const double cosine = -picture.direction(x, y).y;
      const double r = reflected_share(cosine, n);
      colour.take(std::abs(picture.at("R", x, y) - (r + 0.25 * (1 - r))));
      const double beyond = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
      way.take(relative(picture.at("mirror.Z", x, y), height / cosine + n * depth / beyond));
    }
  }
  EXPECT_GT(colour.compared, 1500);
  EXPECT_LT(colour.error, 1e-3);  // half floats
  EXPECT_LT(way.error, 1e-6);
}

// What is reflected and what goes through is all there is: at rest in an isotropic bath nobody sees glass.
TEST(Glass, AtRestInAnIsotropicBathIsNotSeen) {
  for (const char* velocity : {"", "beta = [0.5, 0.1, -0.6]\n", "beta = [0.1, 0.2, 0.8]\n"}) {
    const auto scene = [&](const std::string& ball) {
      return film_through_glass(48, 36, "bounces = 60\nwavelengths = 64\n") +
             "[background]\ntemperature = 5000\n[camera]\ndirection = [0, 0, 1]\nfov = 100\n" + velocity +
             ball;
    };
    const Rendering without = render_text(scene("")),
                    with = render_text(scene("[[object]]\nshape = \"sphere\"\nradius = 1.5\nposition = "
                                             "[0.3, 0.2, 4]\nmaterial = { glass = { index = 1.6 } }\n"));
    Worst colour;
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 48; ++x) {
        if (with.id(x, y) != 1) continue;
        const Vec3 rgb = without.rgb(x, y);
        colour.take(largest(with.rgb(x, y) - rgb) / largest(rgb));
      }
    }
    EXPECT_GT(colour.compared, 15) << velocity;
    EXPECT_LT(colour.error, 2e-3) << velocity;  // what is too faint is not followed
  }
}

// A slab leaves direction and frequency as they were, however it moves.
TEST(Glass, ASlabShiftsNoColourHoweverItMoves) {
  for (const Vec3 velocity : {Vec3{0.0}, Vec3{0, 0, -0.8}, Vec3{0.6, 0.3, 0.5}, Vec3{0.95, 0, 0}}) {
    const Rendering picture =
        render_text(film_through_glass(30, 20) +
                    "[camera]\nfov = 50\n[background]\ncolor = [1, 1, 1]\n"
                    "[[object]]\nshape = \"box\"\nsize = [4000, 4000, 0.7]\nrotate = [10, 20, 0]\nposition = "
                    "[0, 0, 40]\nbeta = " +
                    list(velocity) + "\nmaterial = { glass = { index = 1.5 } }\n");
    Worst doppler;
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 30; ++x) {
        if (picture.id(x, y) == 1 && std::isinf(picture.at("mirror.Z", x, y)))
          doppler.take(std::abs(picture.at("mirror.D", x, y) - 1.0));
      }
    }
    EXPECT_GT(doppler.compared, 400) << velocity.x;
    EXPECT_LT(doppler.error, 1e-6) << velocity.x;
  }
}

// Fizeau 1851: in glass that moves along with light or against it, light goes at (1/n ± v)/(1 ± v/n).
TEST(Glass, DragsLightAsFizeauFound) {
  const double n = 1.5, thickness = 3.0, front = 6.0, wall = 30.0;
  for (const double v : {0.0, 0.3, -0.5, 0.6}) {
    const Rendering picture =
        render_text(film_through_glass(3, 3) +
                    "[camera]\nfov = 1e-4\n"
                    "[[object]]\nshape = \"box\"\nsize = [9, 9, 3]\nposition = [0, 0, " +
                    digits(front + 0.5 * thickness * std::sqrt(1 - v * v)) + "]\nbeta = [0, 0, " + digits(v) +
                    "]\nmaterial = { glass = { index = 1.5 } }\n"
                    "[[object]]\nshape = \"plane\"\nrotate = [90, 0, 0]\nposition = [0, 0, 30]\nmaterial = { "
                    "color = [0, 0, "
                    "0], emission = 1 }\n");
    const double speed = (1 / n - v) / (1 - v / n);  // of light that comes against the glass's v
    const double left = -front / (1 + v);            // the front face, for the camera
    const double length = thickness * std::sqrt(1 - v * v);
    const double entered = left - length / (speed + v);
    const double behind = front + length + v * entered;
    EXPECT_LT(relative(picture.at("mirror.Z", 1, 1), -entered + wall - behind), 1e-6) << v;
    EXPECT_NEAR(picture.at("mirror.D", 1, 1), 1.0, 1e-6) << v;
    EXPECT_EQ(picture.at("mirror.V", 1, 1), 2) << v;
  }
}

// Beer's law holds in the glass's own frame, for as much of it as light crosses.
TEST(Glass, TakesItsTintByTheLengthOfTheWay) {
  for (const double v : {0.0, 0.6, -0.4}) {
    const Rendering picture =
        render_text(film_through_glass(3, 3) +
                    "[effects]\ndoppler = false\n[camera]\nfov = 1e-4\n"
                    "[[object]]\nshape = \"box\"\nsize = [9, 9, 1.5]\nposition = [0, 0, 8]\nbeta = [0, 0, " +
                    digits(v) +
                    "]\nmaterial = { glass = { index = 1, tint = [0.5, 0.8, 1] } }\n"
                    "[background]\ncolor = [1, 1, 1]\n");
    EXPECT_NEAR(picture.at("R", 1, 1), std::pow(0.5, 1.5), 3e-4) << v;
    EXPECT_NEAR(picture.at("G", 1, 1), std::pow(0.8, 1.5), 5e-4) << v;
    EXPECT_NEAR(picture.at("B", 1, 1), 1.0, 5e-4) << v;
  }
}

struct Place {
  double t;
  Vec3 x;
};

// From the frame of this velocity to the world; origins meet.
Place in_world(const Place& p, const Vec3& v) {
  const double speed = glm::length(v);
  if (speed == 0.0) return p;
  const double gamma = 1 / std::sqrt(1 - speed * speed), along = glm::dot(v, p.x);
  return {gamma * (p.t + along), p.x + ((gamma - 1) * along / (speed * speed) + gamma * p.t) * v};
}

// Snell, by the components along and across the normal; zero where all is reflected.
Vec3 bent(const Vec3& way, const Vec3& outward, double n) {
  const Vec3 across = n * (way - glm::dot(way, outward) * outward);
  const double sine = glm::length(across);
  return sine < 1 ? across + std::sqrt(1 - sine * sine) * outward : Vec3{0.0};
}

// Snell's window: under water all of the sky is within asin(1/n) of the zenith, and around it is the floor.
TEST(Glass, ShowsACameraUnderWaterTheSkyInSnellsWindow) {
  const double n = 1.33;
  for (const Vec3 v : {Vec3{0.0}, Vec3{0.4, 0.3, -0.6}, Vec3{0, 0.95, 0}}) {
    const Rendering picture = render_text(
        film_through_glass(80, 80) + "[effects]\ndoppler = false\nsearchlight = \"off\"\n" +
        "[frame.sea]\nvelocity = " + list(v) +
        "\n[camera]\nframe = \"sea\"\nposition = [0, -1, 0]\ndirection = [0, 1, 0]\nup = [0, 0, 1]\nfov = "
        "120\n"
        "[background]\ncolor = [1, 1, 1]\n"
        "[[object]]\nshape = \"plane\"\nframe = \"sea\"\nmaterial = { glass = { index = 1.33 } }\n"
        "[[object]]\nshape = \"plane\"\nframe = \"sea\"\nposition = [0, -3, 0]\nmaterial = { color = [0, 0, "
        "0], "
        "emission = 0.125 }\n");
    Worst window, around, way, shift;
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const Vec3 looking = picture.direction(x, y), beyond = bent(looking, {0, 1, 0}, n);
        ASSERT_EQ(picture.id(x, y), 1);
        way.take(relative(picture.at("Z", x, y), n / looking.y));
        const double light = picture.at("R", x, y), end = picture.at("mirror.Z", x, y);
        if (beyond == Vec3{0.0}) {
          around.take(std::abs(light - 0.125));
          around.take(relative(end, n * 4 / looking.y));
          shift.take(std::abs(picture.at("mirror.D", x, y) - 1));
        } else {
          const double r = reflected_share(beyond.y, n);
          window.take(std::isinf(end) ? std::abs(light - (1 - r + 0.125 * r)) : 1.0);
          shift.take(relative(picture.at("mirror.D", x, y),
                              std::sqrt(1 - glm::dot(v, v)) / (1 - glm::dot(v, beyond))));
        }
      }
    }
    EXPECT_GT(window.compared, 1000);
    EXPECT_GT(around.compared, 1000);
    EXPECT_LT(window.error, 1e-3);
    EXPECT_LT(around.error, 1e-3);
    EXPECT_LT(way.error, 1e-6);
    EXPECT_LT(shift.error, 1e-6);
  }
}

// A camera off the middle of a ball that flies by a wall at rest: when the light left the wall, by Snell in
// the ball's frame and the line of events from there on.
TEST(Glass, LetsACameraInABallSeeTheWorldPass) {
  const double n = 1.5, wall = 4.0;
  for (const Vec3 v : {Vec3{0.0}, Vec3{0.5, -0.3, 0.6}, Vec3{0.9, 0, 0.1}}) {
    const Rendering picture = render_text(
        film_through_glass(60, 60) + "[frame.ball]\nvelocity = " + list(v) +
        "\n[camera]\nframe = \"ball\"\nposition = [0.3, 0.2, -0.75]\nfov = 130\n"
        "[[object]]\nshape = \"sphere\"\nradius = 1\nframe = \"ball\"\nmaterial = { glass = { index = 1.5 } "
        "}\n"
        "[[object]]\nshape = \"plane\"\nrotate = [-90, 0, 0]\nposition = [0, 0, 4]\nmaterial = { color = "
        "[0, 0, 0], emission = 0.5 }\n");
    const Vec3 camera{0.3, 0.2, -0.75};
    Worst time;
    int kept = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) {
        const Vec3 looking = picture.direction(x, y);
        const double half = glm::dot(camera, looking);
        const double length = -half + std::sqrt(half * half + 1 - glm::dot(camera, camera));
        const Vec3 out = camera + length * looking, beyond = bent(looking, out, n);
        if (beyond == Vec3{0.0}) {
          kept += picture.at("mirror.V", x, y) == 1 ? 1 : 0;
          continue;
        }
        // The world's z along the line of events is linear.
        const Place start = in_world({-n * length, out}, v);
        const Place next = in_world({-n * length - 1, out + beyond}, v);
        const double more = (wall - start.x.z) / (next.x.z - start.x.z);
        if (!(more > 0) || picture.at("mirror.V", x, y) != 2) continue;
        const double then = start.t + more * (next.t - start.t);
        time.take(std::abs(picture.at("mirror.T", x, y) - then) / (1 + std::abs(then)));
      }
    }
    EXPECT_GT(kept, 100);
    EXPECT_GT(time.compared, 500);
    EXPECT_LT(time.error, 1e-6);
  }
}

// A lamp in the water, and the camera too: the tint of both ways.
TEST(Glass, TakesItsTintOfALampWithinItToo) {
  const auto picture = [](const std::string& tint) {
    return render_text(film_through_glass(24, 24) +
                       "[camera]\nposition = [0, -1, 0]\ndirection = [0, -1, 1.2]\n" +
                       "[[light]]\nposition = [1, -2, 2]\nintensity = 20\n"
                       "[[object]]\nshape = \"plane\"\nmaterial = { glass = { index = 1.33, tint = " +
                       tint + " } }\n[[object]]\nshape = \"plane\"\nposition = [0, -3, 0]\n");
  };
  const Rendering clear = picture("1"), tinted = picture("[0.7, 0.9, 1]");
  Worst share;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      if (clear.id(x, y) != 2) continue;
      const Vec3 looking = clear.direction(x, y), floor = Vec3{0, -1, 0} - 2 / looking.y * looking;
      const double length = glm::length(Vec3{1, -2, 2} - floor) - 2 / looking.y;
      share.take(relative(tinted.at("R", x, y) / clear.at("R", x, y), std::pow(0.7, length)));
      share.take(relative(tinted.at("G", x, y) / clear.at("G", x, y), std::pow(0.9, length)));
    }
  }
  EXPECT_GT(share.compared, 600);
  EXPECT_LT(share.error, 2e-3);  // half floats
}

std::string over_floor(const std::string& things) {
  return "c = 1\n" + film(60, 40) +
         "[camera]\nposition = [0, 1, -6]\ndirection = [0, -0.1, 1]\nbeta = [0.1, 0, 0.2]\n"
         "[background]\ncolor = [0.3, 0.5, 0.8]\n[[light]]\nposition = [3, 6, -3]\nintensity = 100\n"
         "[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\nmaterial = { checker = { colors = [[0.8, "
         "0.8, 0.8], "
         "[0.2, 0.1, 0.1]], size = 1 } }\n" +
         things;
}

TEST(Glass, OfIndexOneIsNotThere) {
  const std::string ball =
      "[[object]]\nshape = \"sphere\"\nradius = 1\nbeta = [0.3, 0, 0.1]\nmaterial = { glass = { index = 1 } "
      "}\n";
  EXPECT_TRUE(same_bits(render_text(over_floor("")), render_text(over_floor(ball))));
}

// Glass in glass of the same index, glass that touches glass: neither is seen.
TEST(Glass, ThatTouchesGlassOfItsIndexMakesNoEdge) {
  const std::string glass = "material = { glass = { index = 1.5 } }\n";
  const std::string one = "[[object]]\nshape = \"box\"\nsize = [2, 2, 2]\nrotate = [0, 0, 0]\n" + glass;
  const std::string two = "[[object]]\nshape = \"box\"\nsize = [1, 2, 2]\nposition = [-0.5, 0, 0]\n" + glass +
                          "[[object]]\nshape = \"box\"\nsize = [1, 2, 2]\nposition = [0.5, 0, 0]\n" + glass;
  const std::string within = one + "[[object]]\nshape = \"sphere\"\nradius = 0.7\n" + glass;
  const auto picture = [&](const std::string& things) {
    return render_text("c = 1\n[film]\nresolution = [60, 40]\nbounces = 30\naovs = [\"objectId\"]\n" +
                       over_floor(things).substr(over_floor(things).find("[camera]")));
  };
  // With velocities of their own, as if in one frame: the halves are 1 apart in theirs, and 0.8 in the world.
  const std::string moves = "beta = [0.6, 0, 0]\n";
  const auto half = [&](const std::string& x) {
    return "[[object]]\nshape = \"box\"\nsize = [1, 2, 2]\nposition = [" + x + ", 0.3, 0]\n" + moves + glass;
  };
  const std::string moving_one = one + "position = [0, 0.3, 0]\n" + moves,
                    moving_two = half("-0.4") + half("0.4");
  for (const auto& [whole, things] :
       {std::pair{one, two}, std::pair{one, within}, std::pair{moving_one, moving_two}}) {
    const Rendering a = picture(whole), b = picture(things);
    Worst colour;
    int far_off = 0;
    for (int y = 1; y < 39; ++y) {
      for (int x = 1; x < 59; ++x) {
        if (!a.is_inside(x, y) || a.id(x, y) != 2) continue;
        const double difference = largest(a.rgb(x, y) - b.rgb(x, y)) / largest(a.rgb(x, y));
        far_off += difference > 2e-3 ? 1 : 0;
        colour.take(difference);
      }
    }
    EXPECT_GT(colour.compared, 150);
    EXPECT_LE(far_off, 2) << things << colour.error;  // on the edges of a checker's square
  }
}

SceneModel glass_in_motion() {
  SceneModel m;
  m.film = film_through_glass(60, 45, "bounces = 12\nwavelengths = 64\n").substr(6);
  m.frames = {{"ground", {0, 0, 0}, {}},
              {"eye", {0.3, 0.05, 0.6}, {0.5, 0.2, 1.5, -8}},
              {"slab", {-0.4, 0.1, -0.3}, {0.0, 0.5, 1.0, 3.0}},
              {"ball", {-0.5, 0.0, 0.2}, {-9.02, 0.0, 1.0, -1}}};
  m.camera = {"eye", {0, 0, 0}, {0.1, -0.15, 1}, {0, 1, 0}, 0.4};
  m.objects = {
      {"ground", "shape = \"plane\"\nmaterial = { color = [0.6, 0.6, 0.5], emission = 0.1 }", {0, -1, 0}, {}},
      {"slab",
       "shape = \"box\"\nsize = [5, 3, 0.4]\nmaterial = { glass = { index = 1.5, tint = [0.9, 0.7, 0.5] } }",
       {0, 0, 0},
       {10, 25, 5}},
      {"ball", "shape = \"sphere\"\nradius = 1.3\nmaterial = { glass = { index = 1.3 } }", {0, 0, 0}, {}},
      {"ground",
       "shape = \"box\"\nsize = [1.5, 3, 1.5]\nmaterial = { color = [0.5, 0.5, 0.7] }",
       {-4, 0.5, 3},
       {0, 20, 0}}};
  m.lights = {{"ground", "type = \"point\"\nintensity = 200\ntemperature = 5000", {-5, 7, -6}}};
  return m;
}

TEST(Glass, ScenesToldFromAnotherFrameAreTheSamePicture) {
  const SceneModel original = glass_in_motion();
  const Rendering a = render_text(to_toml(original));
  for (const double celerity : {0.3, 10.0, 1000.0}) {
    const Redescription other = redescribed(original, celerity * Vec3{0.48, -0.6, 0.64});
    const Rendering b = render_text(to_toml(other.model));
    int seen = 0, off = 0;
    Worst doppler;
    for (int y = 1; y + 1 < a.height(); ++y) {
      for (int x = 1; x + 1 < a.width(); ++x) {
        if (!a.is_inside(x, y) || a.at("mirror.V", x, y) == 0.0) continue;
        ++seen;
        doppler.take(a.at("mirror.V", x, y) == b.at("mirror.V", x, y)
                         ? relative(a.at("mirror.D", x, y), b.at("mirror.D", x, y))
                         : 0.0);
        const Vec3 rgb = a.rgb(x, y);
        off += largest(rgb - b.rgb(x, y)) > 3e-3 * largest(rgb) ? 1 : 0;
      }
    }
    EXPECT_GT(seen, 30) << celerity;
    EXPECT_LT(doppler.error, 3e-6) << celerity;
    EXPECT_LE(off, seen / 100) << celerity;  // at inner edges
  }
}

TEST(Glass, RefusesWhatMovesInIt) {
  const std::string tank =
      "[[object]]\nname = \"tank\"\nshape = \"box\"\nsize = [3, 3, 3]\nmaterial = { glass = { index = 1.33 } "
      "}\n";
  const std::string fish = "[[object]]\nname = \"fish\"\nshape = \"sphere\"\nradius = 0.3\n";
  EXPECT_NO_THROW(render_text(over_floor(tank + fish)));
  try {
    render_text(over_floor(tank + fish + "beta = [0.1, 0, 0]\n"));
    ADD_FAILURE() << "it was rendered";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("'fish' moves relative to the glass of 'tank'"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace backlight::test
