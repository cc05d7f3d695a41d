// What moving things look like: docs/physics.md section 5, laws 4 to 8.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "rendering.h"

namespace backlight::test {
namespace {

std::string number(double v) {
  std::ostringstream out;
  out.precision(17);
  out << std::showpoint << v;
  return out.str();
}

std::string vector(const Vec3& v) {
  return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
}

// Where a thing moving with velocity v must be at world time 0 to be seen at `seen` from the origin at time
// 0: it was there when light left it, |seen| ago.
Vec3 position_seen_at(const Vec3& seen, const Vec3& v) {
  return seen + glm::length(seen) * v;
}

// Law 4. In the sphere's frame the outline is the cone of half-angle asin(R/|P|) about -P; in the camera's,
// the directions d whose aberrated image lies in it. Independent of the tracer: a quadratic form in (1, d).
bool cone_contains(const Vec3& velocity, const Vec3& position, double radius, const Vec3& d) {
  const double v2 = glm::dot(velocity, velocity);
  const double gamma = 1.0 / std::sqrt(1.0 - v2);
  const auto space = [&](double t, const Vec3& x) {
    return x + ((gamma - 1.0) * glm::dot(x, velocity) / v2 - gamma * t) * velocity;
  };
  const Vec3 eye = space(0.0, -position);  // the camera event (0; 0), from the sphere's origin event
  const Vec3 k = space(-1.0, d);
  const double distance2 = glm::dot(eye, eye);
  const double along = -glm::dot(eye, k);
  return along > 0.0 && along * along > glm::dot(k, k) * (distance2 - radius * radius);
}

class Outline : public testing::TestWithParam<Vec3> {};

TEST_P(Outline, OfASphereIsPenrosesCircle) {
  const Vec3 v = GetParam();
  const Vec3 position = position_seen_at({0.8, 0.5, 7.0}, v);
  const Rendering r =
      render_text(film(160, 120) + "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = 70\n" +
                  "[[object]]\nshape = \"sphere\"\nradius = 1.3\nposition = " + vector(position) +
                  "\nbeta = " + vector(v) + "\n");
  int inside = 0;
  for (int y = 0; y < r.height(); ++y) {
    for (int x = 0; x < r.width(); ++x) {
      const bool expected = cone_contains(v, position, 1.3, r.direction(x, y));
      EXPECT_EQ(r.id(x, y) == 1, expected) << x << ' ' << y;
      inside += expected ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 300);
  // And the outline is a circle on the sky: directions on it lie in one plane.
  std::vector<Vec3> rim;
  for (int y = 1; y + 1 < r.height(); ++y)
    for (int x = 1; x + 1 < r.width(); ++x)
      if (r.id(x, y) == 1 && !r.is_inside(x, y)) rim.push_back(r.direction(x, y));
  ASSERT_GT(rim.size(), 40U);
  const std::size_t n = rim.size();
  Vec3 normal = glm::cross(rim[n / 3] - rim[0], rim[2 * n / 3] - rim[0]);
  normal /= glm::length(normal);
  const double pixel = 2.0 * std::tan(35.0 * M_PI / 180.0) / 160.0;
  for (const Vec3& d : rim) EXPECT_NEAR(glm::dot(d - rim[0], normal), 0.0, 3.5 * pixel);
}

INSTANTIATE_TEST_SUITE_P(Velocities, Outline,
                         testing::Values(Vec3{0.5, 0, 0}, Vec3{0.9, 0, 0}, Vec3{0, 0, -0.8}, Vec3{0, 0, 0.7},
                                         Vec3{0.6, -0.3, 0.6}, Vec3{-0.7, 0.1, -0.65}, Vec3{0, 0.99, 0.05}));

TEST(TerrellRotation, TurnsSmallObjectsByTheAberrationAngle) {
  // The point of a small sphere at the middle of its image is where the camera stands as seen from the
  // sphere: at the aberrated angle α from its velocity, with tan(β/2) = √((1-v)/(1+v)) tan(α/2).
  for (const double v : {0.3, 0.8, 0.95}) {
    for (const double beta : {0.5, 1.2, 1.5707963267948966, 2.4}) {
      // Seen at angle β from the direction that the sphere comes from: -v.
      const Vec3 velocity{-v, 0.0, 0.0};
      const Vec3 seen = 100.0 * Vec3{std::cos(beta), 0.0, std::sin(beta)};
      const Rendering r =
          render_text(film(33, 33) + "[camera]\nposition = [0, 0, 0]\ndirection = " + vector(seen) +
                      "\nfov = 2\n[[object]]\nshape = \"sphere\"\nradius = 1\nposition = " +
                      vector(position_seen_at(seen, velocity)) + "\nbeta = " + vector(velocity) + "\n");
      ASSERT_EQ(r.id(16, 16), 1);
      // From the sphere's centre towards the camera; the sphere comes from +x, and looking at it is along -p.
      const Vec3 p = r.position(16, 16);
      const double alpha = std::acos(std::clamp(-p.x / glm::length(p), -1.0, 1.0));
      const double expected = 2.0 * std::atan(std::sqrt((1.0 + v) / (1.0 - v)) * std::tan(beta / 2.0));
      EXPECT_NEAR(alpha, expected, 1e-4) << "v " << v << " beta " << beta;
    }
  }
}

TEST(ApparentSpeed, IsTheTextbooks) {
  // v sinθ/(1 - v cosθ), θ between the velocity and the direction to the observer; superluminal near head-on.
  const double v = 0.95;
  const double theta = 0.35;
  const double distance = 1000.0;
  const Vec3 velocity = v * Vec3{std::sin(theta), 0.0, -std::cos(theta)};
  const Vec3 seen{0.0, 0.0, distance};
  const auto centre_at = [&](double time) {
    const Rendering r =
        render_text(film(401, 41) +
                    "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = 2\ntime = " + number(time) +
                    "\n[[object]]\nshape = \"sphere\"\nradius = 1\nposition = " +
                    vector(position_seen_at(seen, velocity)) + "\nbeta = " + vector(velocity) + "\n");
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < r.height(); ++y)
      for (int x = 0; x < r.width(); ++x)
        if (r.id(x, y) == 1) {
          const Vec3 d = r.direction(x, y);
          sum += d.x / d.z;
          ++count;
        }
    EXPECT_GT(count, 20);
    return distance * sum / count;
  };
  const double step = 2.0;
  const double speed = (centre_at(step) - centre_at(-step)) / (2.0 * step);
  const double expected = v * std::sin(theta) / (1.0 - v * std::cos(theta));
  EXPECT_GT(expected, 2.9);  // faster than light
  EXPECT_NEAR(speed, expected, 0.01 * expected);
}

TEST(Rod, PerpendicularToItsMotionIsSeenAsAHyperbola) {
  // A thin rod along y at x = vt, z = d: seen at time T in directions with (x - vT)² = v²(x² + y² + d²), x <
  // vT.
  const double v = 0.8;
  const double d = 5.0;
  const double time = 3.0;
  const Rendering r =
      render_text(film(200, 200) +
                  "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = 100\ntime = " + number(time) +
                  "\n[[object]]\nshape = \"cylinder\"\nradius = 0.03\nheight = 40\nposition = [0, 0, "
                  "5]\nbeta = [0.8, 0, 0]\n");
  int count = 0;
  double spread = 0.0;
  for (int y = 0; y < r.height(); ++y) {
    for (int x = 0; x < r.width(); ++x) {
      if (r.id(x, y) != 1) continue;
      const Vec3 dir = r.direction(x, y);
      const double px = d * dir.x / dir.z;
      const double py = d * dir.y / dir.z;
      const double expected_x = [&] {  // the root with x < vT
        const double a = 1.0 - v * v;
        const double b = v * time;
        const double c = b * b - v * v * (py * py + d * d);
        return (b - std::sqrt(b * b - a * c)) / a;
      }();
      EXPECT_NEAR(px, expected_x, 0.12) << py;
      spread = std::max(spread, std::abs(px));
      ++count;
    }
  }
  EXPECT_GT(count, 100);
  EXPECT_GT(spread, 3.0);  // far from straight
}

TEST(LampSwitchedOn, LightsThePointsWhosePathIsShortEnough) {
  // A lamp that starts at its time 0, at rest or moving; the plane lit is where lamp → point → camera < T.
  const Vec3 eye{0.0, 4.0, -6.0};
  const double time = 14.0;
  for (const Vec3 velocity : {Vec3{0.0}, Vec3{0.5, 0.0, 0.3}}) {
    const Vec3 lamp{-3.0, 3.0, 2.0};  // at time 0
    const Rendering r = render_text(
        film(80, 60) + "[camera]\nposition = " + vector(eye) +
        "\ndirection = [0, -0.6, 1]\nfov = 90\ntime = " + number(time) +
        "\n[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\n[[light]]\nintensity = \"100*floor(clamp(t "
        "+ 1, 0, 1))\"\nposition = " +
        vector(lamp) + (glm::length(velocity) > 0 ? "\nbeta = " + vector(velocity) + "\n" : "\n"));
    int lit = 0;
    int dark = 0;
    for (int y = 0; y < r.height(); ++y) {
      for (int x = 0; x < r.width(); ++x) {
        if (r.id(x, y) != 1) continue;
        const Vec3 p = r.position(x, y);
        // The lamp's clock starts at the event (0; lamp), wherever it goes afterwards.
        const double path = glm::length(p - lamp) + glm::length(p - eye);
        if (std::abs(path - time) < 1e-4) continue;
        const bool is_lit = r.rgb(x, y).g > 0.0;
        EXPECT_EQ(is_lit, path < time) << x << ' ' << y;
        (is_lit ? lit : dark) += 1;
      }
    }
    EXPECT_GT(lit, 500);
    EXPECT_GT(dark, 300);
  }
}

}  // namespace
}  // namespace backlight::test
