#include "backlight/colour/rgb.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rec709.h"

namespace backlight {
namespace {

Vec3 apply(const rec709::Matrix& matrix, const Vec3& v) {
  const cie::Tristimulus product = rec709::multiply(matrix, {v.x, v.y, v.z});
  return {product[0], product[1], product[2]};
}

constexpr double degrees(double radians) {
  return radians * (180.0 / std::numbers::pi);
}
constexpr double radians(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}
constexpr double square(double x) {
  return x * x;
}

// sqrt(C^7 / (C^7 + 25^7)), which fades the formula's chroma corrections in.
double saturation_of_chroma(double chroma) {
  const double c7 = std::pow(chroma, 7.0);
  return std::sqrt(c7 / (c7 + 6103515625.0));
}

// Hue angle in [0, 360) degrees; 0 for a grey.
double hue(double a, double b) {
  if (a == 0.0 && b == 0.0) return 0.0;
  const double angle = degrees(std::atan2(b, a));
  return angle < 0.0 ? angle + 360.0 : angle;
}

// Chroma and hue after the stretch of a* near the neutral axis.
struct ChromaHue {
  double chroma;
  double hue;
};

struct HueDifference {
  double difference;  // degrees, -180..180
  double mean;        // degrees
};

HueDifference compare_hues(const ChromaHue& first, const ChromaHue& second) {
  const double sum = first.hue + second.hue;
  if (first.chroma * second.chroma == 0.0) return {0.0, sum};
  const double plain = second.hue - first.hue;
  if (std::abs(plain) <= 180.0) return {plain, 0.5 * sum};
  const double wrapped = plain > 180.0 ? plain - 360.0 : plain + 360.0;
  return {wrapped, sum < 360.0 ? 0.5 * (sum + 360.0) : 0.5 * (sum - 360.0)};
}

}  // namespace

LinearRgb rgb_from_xyz(const Xyz& xyz) {
  return apply(rec709::rgb_from_xyz, xyz);
}

Xyz xyz_from_rgb(const LinearRgb& rgb) {
  return apply(rec709::xyz_from_rgb, rgb);
}

double luminance(const LinearRgb& rgb) {
  constexpr auto& row = rec709::xyz_from_rgb[1];
  return row[0] * rgb.x + row[1] * rgb.y + row[2] * rgb.z;
}

Xyz white_xyz() {
  constexpr cie::Tristimulus white = cie::d65_white();
  return {white[0], white[1], white[2]};
}

Lab lab_from_xyz(const Xyz& xyz) {
  const auto f = [](double t) {
    constexpr double knee = 6.0 / 29.0;
    return t > knee * knee * knee ? std::cbrt(t) : t / (3.0 * knee * knee) + 4.0 / 29.0;
  };
  const Xyz relative = xyz / white_xyz();
  const double fx = f(relative.x), fy = f(relative.y), fz = f(relative.z);
  return {116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

Lab lab_from_rgb(const LinearRgb& rgb) {
  return lab_from_xyz(xyz_from_rgb(rgb));
}

double delta_e_2000(const Lab& first, const Lab& second) {
  // Equations 2 to 7.
  const double mean_raw_chroma = 0.5 * (std::hypot(first.y, first.z) + std::hypot(second.y, second.z));
  const double stretch = 1.0 + 0.5 * (1.0 - saturation_of_chroma(mean_raw_chroma));
  const auto polar = [stretch](const Lab& lab) {
    const double a = stretch * lab.y;
    return ChromaHue{std::hypot(a, lab.z), hue(a, lab.z)};
  };
  const ChromaHue p1 = polar(first), p2 = polar(second);
  const HueDifference hues = compare_hues(p1, p2);

  // Equations 8 to 13.
  const double delta_l = second.x - first.x;
  const double delta_c = p2.chroma - p1.chroma;
  const double delta_h = 2.0 * std::sqrt(p1.chroma * p2.chroma) * std::sin(radians(0.5 * hues.difference));
  const double mean_l = 0.5 * (first.x + second.x);
  const double mean_c = 0.5 * (p1.chroma + p2.chroma);

  // Equations 15 to 22.
  const double h = hues.mean;
  const double t = 1.0 - 0.17 * std::cos(radians(h - 30.0)) + 0.24 * std::cos(radians(2.0 * h)) +
                   0.32 * std::cos(radians(3.0 * h + 6.0)) - 0.20 * std::cos(radians(4.0 * h - 63.0));
  const double blue = 30.0 * std::exp(-square((h - 275.0) / 25.0));
  const double weight_l = 1.0 + 0.015 * square(mean_l - 50.0) / std::sqrt(20.0 + square(mean_l - 50.0));
  const double l = delta_l / weight_l;
  const double c = delta_c / (1.0 + 0.045 * mean_c);
  const double k = delta_h / (1.0 + 0.015 * mean_c * t);
  const double rotation = -2.0 * saturation_of_chroma(mean_c) * std::sin(radians(2.0 * blue));
  return std::sqrt(std::max(0.0, l * l + c * c + k * k + rotation * c * k));
}

}  // namespace backlight
