#include "field.h"

#include <cmath>
#include <cstdio>
#include <random>

namespace backlight::bench {
namespace {

// The standard fixes the bits of the engine but not of its distributions.
class Numbers {
 public:
  double between(double low, double high) { return low + (high - low) * (double(engine_() >> 11) * 0x1p-53); }
  // Uniform over the sphere: the z of a uniform point on it is uniform.
  Vec3 direction() {
    const double z = between(-1.0, 1.0);
    const double angle = between(0.0, 2.0 * M_PI);
    const double ring = std::sqrt(1.0 - z * z);
    return {ring * std::cos(angle), ring * std::sin(angle), z};
  }
  Vec3 velocity(double most_gamma) {
    const double gamma = between(1.0, most_gamma);
    return std::sqrt(1.0 - 1.0 / (gamma * gamma)) * direction();
  }

 private:
  std::mt19937_64 engine_{20261124};
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string listed(const Vec3& v, const char* open, const char* close) {
  return open + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + close;
}

std::string bracketed(const Vec3& v) {
  return listed(v, "[", "]");
}

std::string angled(const Vec3& v) {
  return listed(v, "<", ">");
}

Vec3 mirrored(const Vec3& v) {
  return {-v.x, v.y, v.z};
}

/// Formulas of t.
std::string circle(const FieldSphere& sphere) {
  const Vec3& centre = sphere.seen_at;
  const std::string angle = '(' + number(sphere.turning) + " * t + " + number(sphere.phase) + ")\"";
  const std::string radius = " + " + number(sphere.orbit);
  return "[\"" + number(centre.x) + radius + " * cos" + angle + ", " + number(centre.y) + ", \"" +
         number(centre.z) + radius + " * sin" + angle + ']';
}

}  // namespace

std::vector<FieldSphere> sphere_field(const FieldRequest& request) {
  Numbers numbers;
  const double smaller = std::max(1.0, std::cbrt(request.spheres / 200.0));
  std::vector<Vec3> velocities;
  for (int i = 0; i < request.frames; ++i) velocities.push_back(numbers.velocity(request.most_gamma));
  std::vector<FieldSphere> field;
  for (int i = 0; i < request.spheres; ++i) {
    FieldSphere sphere;
    sphere.seen_at = {numbers.between(-9.0, 9.0), numbers.between(-0.7, 2.3), numbers.between(-6.0, 10.0)};
    sphere.radius = 0.3 / smaller;
    sphere.colour = {numbers.between(0.0, 1.0), numbers.between(0.0, 1.0), numbers.between(0.0, 1.0)};
    const Vec3 own = numbers.velocity(request.most_gamma);
    if (request.motion == FieldMotion::distinct) sphere.velocity = own;
    if (request.motion == FieldMotion::shared)
      sphere.velocity = velocities[static_cast<std::size_t>(i % request.frames)];
    if (request.motion == FieldMotion::circling) {
      sphere.orbit = numbers.between(0.5, 2.0);
      sphere.turning = glm::length(own) / sphere.orbit;
      sphere.phase = numbers.between(0.0, 2.0 * M_PI);
    }
    field.push_back(sphere);
  }
  return field;
}

std::string field_for_backlight(const FieldRequest& request) {
  std::string text =
      "[film]\nresolution = [720, 526]\nsamples = 1\n\n[camera]\nposition = " + bracketed(field_eye) +
      "\nlook_at = [0, 0, 0]\nfov = 60\n\n[[light]]\nposition = " + bracketed(field_lamp) +
      "\nintensity = 300\n\n[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\n"
      "material = { color = [0.8, 0.8, 0.8], specular = 0.4, shininess = 40 }\n";
  for (const FieldSphere& sphere : sphere_field(request)) {
    const double delay = glm::length(sphere.seen_at - field_eye);
    const bool circles = request.motion == FieldMotion::circling;
    text += "\n[[object]]\nshape = \"sphere\"\nradius = " + number(sphere.radius) + "\nposition = " +
            (circles ? circle(sphere) : bracketed(sphere.seen_at + delay * sphere.velocity)) + '\n';
    if (request.motion != FieldMotion::at_rest && !circles)
      text += "beta = " + bracketed(sphere.velocity) + '\n';
    text += "material = { color = " + bracketed(sphere.colour) + ", specular = 0.4, shininess = 40 }\n";
  }
  return text;
}

std::string field_for_povray(const FieldRequest& request) {
  std::string text =
      "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n"
      "#default { finish { ambient 0 diffuse 0.8 phong 0.4 phong_size 40 } }\n"
      "camera { perspective location " +
      angled(mirrored(field_eye)) + " look_at 0 right x*720/526 up y angle 60 }\nlight_source { " +
      angled(mirrored(field_lamp)) + " color rgb 1 }\nplane { y, -1 pigment { rgb 0.8 } }\n";
  for (const FieldSphere& sphere : sphere_field(request)) {
    text += "sphere { " + angled(mirrored(sphere.seen_at)) + ", " + number(sphere.radius) +
            " pigment { rgb " + angled(sphere.colour) + " } }\n";
  }
  return text;
}

}  // namespace backlight::bench
