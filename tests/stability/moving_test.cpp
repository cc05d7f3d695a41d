// Shapes that turn, swing and travel, asked by random lines of light, against steps along each line that are
// certain: in a body's own coordinates its distance from a point is known, and along light it changes by no
// more than twice the way, since matter is slower than light. So steps of half the distance pass over
// nothing. With 64 bits of mantissa, on which 10^-13 of a size is far from rounding.
//
// Of 20,000 lines here; BACKLIGHT_MOVING_RAYS=1000000 asks for as many.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

#include "backlight/scene/compile.h"
#include "backlight/scene/reader.h"
#include "random_numbers.h"

namespace backlight::test {
namespace {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64);
using Real3 = std::array<Real, 3>;

std::string number(double x) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "(%.17g)", x);
  return text.data();
}

enum class Body { sphere, box, torus, cylinder };

/// start + way t + bend √(1 + t²) + cosine cos(rate t) + sine sin(rate t), turned by angles + turn t + swing
/// sin(beat t) degrees.
struct Course {
  Body body = Body::sphere;
  Vec3 start{0.0}, way{0.0}, bend{0.0}, cosine{0.0}, sine{0.0};
  double rate = 1.0;
  Vec3 angles{0.0}, turn{0.0}, swing{0.0};
  double beat = 1.0;

  [[nodiscard]] std::string scene() const {
    const std::array<const char*, 4> shapes{"shape = \"sphere\"\nradius = 0.5\n",
                                            "shape = \"box\"\nsize = [0.6, 0.8, 0.4]\n",
                                            "shape = \"torus\"\nmajor = 0.4\nminor = 0.15\n",
                                            "shape = \"cylinder\"\nradius = 0.3\nheight = 0.7\n"};
    std::string position, rotate;
    for (int i = 0; i < 3; ++i) {
      const char* comma = i == 0 ? "\"" : ", \"";
      position += comma + number(start[i]) + " + " + number(way[i]) + "*t";
      if (bend != Vec3{0.0}) position += " + " + number(bend[i]) + "*sqrt(1 + t^2)";
      if (cosine != Vec3{0.0}) {
        position += " + " + number(cosine[i]) + "*cos(" + number(rate) + "*t) + " + number(sine[i]) +
                    "*sin(" + number(rate) + "*t)";
      }
      position += "\"";
      rotate += comma + number(angles[i]);
      if (turn != Vec3{0.0}) {
        rotate += " + " + number(turn[i]) + "*t + " + number(swing[i]) + "*sin(" + number(beat) + "*t)";
      }
      rotate += "\"";
    }
    return std::string("[camera]\nposition = [0, 0, -9]\n[[object]]\n") +
           shapes[static_cast<std::size_t>(body)] + "position = [" + position + "]\n" +
           (body == Body::sphere ? "" : "rotate = [" + rotate + "]\n");
  }

  /// How far a place is outside the body, or inside: negative.
  [[nodiscard]] Real distance(const Real3& place, Real t) const {
    Real3 x{};
    const Real bent = std::sqrt(1 + t * t), c = std::cos(rate * t), s = std::sin(rate * t);
    for (int i = 0; i < 3; ++i) {
      x[static_cast<std::size_t>(i)] = place[static_cast<std::size_t>(i)] -
                                       (start[i] + way[i] * t + bend[i] * bent + cosine[i] * c + sine[i] * s);
    }
    if (body == Body::sphere) return length(x) - Real(0.5);
    const Real swung = std::sin(beat * t);
    for (int axis = 2; axis >= 0; --axis) {
      const Real angle =
          (angles[axis] + turn[axis] * t + swing[axis] * swung) * Real(3.141592653589793238462643383L) / 180;
      Real& a = x[static_cast<std::size_t>((axis + 1) % 3)];
      Real& b = x[static_cast<std::size_t>((axis + 2) % 3)];
      const Real ca = std::cos(angle), sa = std::sin(angle), turned = ca * a + sa * b;
      b = ca * b - sa * a;
      a = turned;
    }
    return in_body(x);
  }

 private:
  static Real length(const Real3& x) { return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }
  static Real outside(const Real3& beyond) {
    const Real inside = std::min(std::max({beyond[0], beyond[1], beyond[2]}), Real(0));
    return length(
               {std::max(beyond[0], Real(0)), std::max(beyond[1], Real(0)), std::max(beyond[2], Real(0))}) +
           inside;
  }
  [[nodiscard]] Real in_body(const Real3& x) const {
    const Real ring = std::sqrt(x[0] * x[0] + x[2] * x[2]);
    switch (body) {
      case Body::box:
        return outside(
            {std::abs(x[0]) - Real(0.6) / 2, std::abs(x[1]) - Real(0.8) / 2, std::abs(x[2]) - Real(0.4) / 2});
      case Body::torus:
        return length({ring - Real(0.4), x[1], 0}) - Real(0.15);
      default:
        return outside({ring - Real(0.3), std::abs(x[1]) - Real(0.7) / 2, Real(-1)});
    }
  }
};

/// No part of it is faster than 0.96.
Course course(Numbers& numbers) {
  Course c;
  c.body = static_cast<Body>(static_cast<int>(numbers.between(0.0, 4.0)));
  // Some go straight on, and are searched otherwise.
  const bool straight = numbers.between(0.0, 1.0) < 0.2;
  const double turning = c.body == Body::sphere || straight ? 0.0 : numbers.between(0.0, 0.5);
  double left = numbers.between(0.1, 0.95) - turning;
  c.start = numbers.point(1.0);
  if (straight || numbers.between(0.0, 1.0) < 0.4) {
    const double part = left * numbers.between(0.0, 1.0);
    c.way = part * numbers.direction();
    left -= part;
  }
  if (!straight && numbers.between(0.0, 1.0) < 0.3) {
    const double part = left * numbers.between(0.0, 1.0);
    c.bend = part * numbers.direction();
    left -= part;
  }
  const double orbit = numbers.between(0.2, 1.5);
  c.rate = std::max(left, 0.0) / orbit;
  c.cosine = orbit * numbers.direction();
  const Vec3 other = numbers.direction();
  c.sine = orbit * glm::normalize(other - glm::dot(other, c.cosine) / (orbit * orbit) * c.cosine);
  if (straight) c.cosine = c.sine = Vec3{0.0};
  // Three angles, each about an axis from which the body reaches no farther than 0.56; in degrees.
  const double degrees = turning / (3.0 * 0.56) * 57.29;
  c.angles = numbers.point(180.0);
  c.beat = numbers.between(0.5, 3.0);
  for (int i = 0; i < 3; ++i) {
    const double part = numbers.between(0.0, 1.0);
    c.turn[i] = part * degrees;
    c.swing[i] = (1.0 - part) * degrees / c.beat;
  }
  return c;
}

struct Line {
  Vec3 origin, direction;
  double time;
};

/// The first crossing of a line of light.
struct Crossed {
  bool hit = false;
  Real way = 0;
  Real margin = 1;  ///< how far the surface would have to move for another answer
};

constexpr double farthest = 40.0;

Crossed crossed(const Course& course, const Line& line) {
  const auto at = [&](Real s) {
    Real3 place{};
    for (int i = 0; i < 3; ++i) place[static_cast<std::size_t>(i)] = line.origin[i] + s * line.direction[i];
    return course.distance(place, line.time - s);
  };
  constexpr Real close = 1e-15L;
  Crossed result;
  Real s = 0, g = at(0);
  const Real side = g < 0 ? -1 : 1;
  while (s < farthest && side * g > close) {
    result.margin = std::min(result.margin, side * g);
    s += std::max(side * g / 2, close);
    g = at(s);
  }
  if (s >= farthest) return result;
  result.hit = true;
  result.way = s;
  // What is near to it only here is no other answer: how far behind the surface the line then gets, is.
  result.margin = 0;
  for (int i = 0; i < 400 && result.margin < 1e-6L && s < farthest; ++i) {
    s += std::max(std::abs(g) / 2, Real(1e-11L));
    g = at(s);
    if (side * g > close) break;
    result.margin = std::max(result.margin, -side * g);
  }
  return result;
}

Scene compiled(const std::string& text) {
  const ReadResult read = read_scene_text(text, "moving.toml", {}, BACKLIGHT_SOURCE_DIR);
  if (!read.description) throw std::runtime_error("moving.toml cannot be read");
  ResourceCache resources;
  Diagnostics diagnostics;
  std::optional<Scene> scene = compile(*read.description, {}, resources, diagnostics);
  if (!scene) throw std::runtime_error(format(diagnostics.all().front()) + text);
  return std::move(*scene);
}

int rays_wanted() {
  const char* wanted = std::getenv("BACKLIGHT_MOVING_RAYS");
  return wanted != nullptr ? std::atoi(wanted) : 20'000;
}

struct Counts {
  int rays = 0, hits = 0, missed = 0, invented = 0, within_rounding = 0;
  Real worst = 0;  ///< of hits, off the surface
};

void judge(const Course& course, const Line& line, const Hit& hit, bool blocked, Counts& counts) {
  constexpr Real undecided = 1e-12L;
  const Crossed truth = crossed(course, line);
  ++counts.rays;
  const bool found = hit.found() && hit.lambda < farthest;
  if (truth.hit) ++counts.hits;
  const bool same =
      found == truth.hit && (!found || std::abs(hit.lambda - truth.way) < 1e-6L) && blocked == found;
  if (!same && truth.margin < undecided) {
    ++counts.within_rounding;
  } else if (!same) {
    ++(truth.hit ? counts.missed : counts.invented);
    ADD_FAILURE() << course.scene() << "from " << line.origin.x << ' ' << line.origin.y << ' '
                  << line.origin.z << " at " << line.time << " along " << line.direction.x << ' '
                  << line.direction.y << ' ' << line.direction.z << ": " << hit.lambda
                  << (blocked ? " (blocked)" : "") << ", not "
                  << (truth.hit ? static_cast<double>(truth.way) : -1.0);
  } else if (found) {
    Real3 place{};
    for (int i = 0; i < 3; ++i)
      place[static_cast<std::size_t>(i)] = line.origin[i] + Real(hit.lambda) * line.direction[i];
    counts.worst = std::max(counts.worst, std::abs(course.distance(place, line.time - Real(hit.lambda))));
  }
}

/// Through the body, or near it, at some time before the image.
Line line_near(const Course& course, Numbers& numbers) {
  const double time = numbers.between(-25.0, -1.0), ago = numbers.between(0.0, 6.0);
  const double then = time - ago, bent = std::sqrt(1.0 + then * then);
  const Vec3 centre = course.start + then * course.way + bent * course.bend +
                      std::cos(course.rate * then) * course.cosine +
                      std::sin(course.rate * then) * course.sine;
  const Vec3 target = centre + numbers.between(0.0, 0.8) * numbers.direction();
  const Vec3 direction = numbers.direction();
  return {target - ago * direction, direction, time};
}

void try_lines(const Course& course, Numbers& numbers, Counts& counts) {
  constexpr int lines_each = 64;
  const Scene scene = compiled(course.scene());
  const auto occupied = std::ranges::find_if(
      scene.frames, [](const SceneFrame& frame) { return frame.surfaces && frame.surfaces->size() > 0; });
  ASSERT_NE(occupied, scene.frames.end());
  for (int i = 0; i < lines_each; ++i) {
    const Line line = line_near(course, numbers);
    const RayClock clock{line.time, -1.0};
    const Hit hit = occupied->surfaces->nearest(line.origin, line.direction,
                                                std::numeric_limits<double>::infinity(), clock);
    judge(course, line, hit, occupied->surfaces->blocked(line.origin, line.direction, farthest, clock),
          counts);
  }
}

TEST(MovingShapes, NoRootIsMissedAndNoneInvented) {
  Counts counts;
  for (unsigned seed = 1; counts.rays < rays_wanted() && counts.missed + counts.invented < 10; ++seed) {
    Numbers numbers(seed);
    const Course its = course(numbers);
    ASSERT_NO_FATAL_FAILURE(try_lines(its, numbers, counts));
  }
  RecordProperty("rays", counts.rays);
  RecordProperty("hits", counts.hits);
  RecordProperty("within_rounding", counts.within_rounding);
  EXPECT_EQ(counts.missed, 0);
  EXPECT_EQ(counts.invented, 0);
  EXPECT_LE(counts.within_rounding, counts.rays / 10'000);
  EXPECT_GT(counts.hits, counts.rays / 4);
  EXPECT_LT(static_cast<double>(counts.worst), 1e-11);
}

// Over all times it gets far away, and is near when it is seen: its places keep all of their digits.
TEST(MovingShapes, WhatDriftsAwaySlowlyIsFoundAsWell) {
  for (const Body body : {Body::sphere, Body::box, Body::torus}) {
    Numbers numbers(static_cast<unsigned>(body) + 1);
    Course its;
    its.body = body;
    its.start = {-0.78, 0.79, 0.4};
    its.bend = {-2.7e-5, 8.4e-7, 1.08e-4};
    its.rate = 0.79;
    its.cosine = {0.03, -0.01, 0.42};
    its.sine = {0.15, 0.39, 0.0};
    Counts counts;
    ASSERT_NO_FATAL_FAILURE(try_lines(its, numbers, counts));
    EXPECT_EQ(counts.missed + counts.invented, 0);
    EXPECT_GT(counts.hits, counts.rays / 4);
    EXPECT_LT(static_cast<double>(counts.worst), 1e-12);
  }
}

}  // namespace
}  // namespace backlight::test
