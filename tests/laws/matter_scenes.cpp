#include "matter_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>

namespace backlight::test {
namespace {

double relative(double a, double b) {
  if (a == b) return 0.0;
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 1.0});
}

double colour_apart(const Vec3& a, const Vec3& b) {
  const double difference = glm::length(a - b);
  return difference == 0.0 ? 0.0 : difference / std::max(glm::length(a), glm::length(b));
}

}  // namespace

std::string digits(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

std::string list(const Vec3& v) {
  return "[" + digits(v.x) + ", " + digits(v.y) + ", " + digits(v.z) + "]";
}

std::string path(const Vec3& place, const Vec3& velocity) {
  std::string text = "position = [";
  for (int i = 0; i < 3; ++i) {
    text += (i > 0 ? ", \"" : "\"") + digits(place[i]) + " + (" + digits(velocity[i]) + ")*t\"";
  }
  return text + "]\n";
}

double lorentz_factor(const Vec3& velocity) {
  return 1.0 / std::sqrt(1.0 - glm::dot(velocity, velocity));
}

Vec3 Oblique::velocity() const {
  const double y = about_y * std::numbers::pi / 180.0;
  const double z = about_z * std::numbers::pi / 180.0;
  return speed * Vec3{std::cos(z) * std::cos(y), std::sin(z) * std::cos(y), -std::sin(y)};
}

std::string Oblique::rotate(double about_x) const {
  return "rotate = " + list({about_x, about_y, about_z}) + "\n";
}

double Match::worst_seen() const {
  return std::max({distance.error, doppler.error, emission_time.error, normal.error});
}

Match match(const Rendering& a, const Rendering& b, Pixels pixels) {
  Match m;
  const int edge = pixels == Pixels::inside ? 1 : 0;
  for (int y = edge; y + edge < a.height(); ++y) {
    for (int x = edge; x + edge < a.width(); ++x) {
      if (edge == 1 && !a.is_inside(x, y)) continue;
      if (a.id(x, y) != b.id(x, y)) {
        ++m.other_id;
        continue;
      }
      const std::string place = std::to_string(x) + "," + std::to_string(y);
      m.colour.take(colour_apart(a.rgb(x, y), b.rgb(x, y)), place);
      if (a.id(x, y) == 0) continue;
      ++m.seen;
      const std::array<std::pair<const char*, Worst*>, 4> numbers{{{"Z", &m.distance},
                                                                   {"doppler.D", &m.doppler},
                                                                   {"emissionTime.T", &m.emission_time},
                                                                   {"properTime.T", &m.own_time}}};
      for (const auto& [channel, worst] : numbers) {
        worst->take(relative(a.at(channel, x, y), b.at(channel, x, y)), place);
      }
      const double size = std::max(glm::length(a.position(x, y)), 1.0);
      m.position.take(glm::length(a.position(x, y) - b.position(x, y)) / size, place);
      m.normal.take(glm::length(a.normal(x, y) - b.normal(x, y)), place);
    }
  }
  return m;
}

bool same_bits(const Rendering& a, const Rendering& b) {
  const auto& names = a.image.layout().channels;
  for (std::size_t channel = 0; channel < names.size(); ++channel) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const double one = a.image.at(channel, x, y);
        const double other = b.image.at(channel, x, y);
        if (std::bit_cast<std::uint64_t>(one) != std::bit_cast<std::uint64_t>(other)) return false;
      }
    }
  }
  return true;
}

void expect_same(const Match& m, const std::string& what, int least_seen) {
  EXPECT_GT(m.seen, least_seen) << what;
  EXPECT_EQ(m.other_id, 0) << what;
  EXPECT_LT(m.worst_seen(), 1e-6) << what << m.distance.where << ' ' << m.doppler.where << ' '
                                  << m.normal.where;
  EXPECT_LT(m.own_time.error, 1e-6) << what << m.own_time.where;
  EXPECT_LT(m.position.error, 1e-6) << what;
  EXPECT_LT(m.colour.error, 1e-5) << what << m.colour.where;
}

}  // namespace backlight::test
