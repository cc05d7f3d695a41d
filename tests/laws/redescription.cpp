#include "redescription.h"

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

namespace backlight::test {
namespace {

using Real = long double;
using Vector = std::array<Real, 4>;
using Matrix = std::array<Vector, 4>;

Matrix boost(const std::array<Real, 3>& u) {
  const Real gamma = std::sqrt(1 + u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  Matrix m{};
  m[0][0] = gamma;
  for (std::size_t i = 0; i < 3; ++i) {
    m[0][i + 1] = m[i + 1][0] = -u[i];
    for (std::size_t j = 0; j < 3; ++j) m[i + 1][j + 1] = (i == j ? 1 : 0) + u[i] * u[j] / (1 + gamma);
  }
  return m;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) m[i][j] += a[i][k] * b[k][j];
  return m;
}

Vector product(const Matrix& a, const Vector& v) {
  Vector r{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) r[i] += a[i][j] * v[j];
  return r;
}

std::array<Real, 3> real(const Vec3& v) {
  return {Real(v.x), Real(v.y), Real(v.z)};
}

std::array<Real, 3> negated(const std::array<Real, 3>& v) {
  return {-v[0], -v[1], -v[2]};
}

Mat3 space_part(const Matrix& m) {
  Mat3 r{1.0};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[j][i] = double(m[std::size_t(i) + 1][std::size_t(j) + 1]);
  return r;
}

Mat3 rotation_about(int axis, double degrees) {
  const double a = degrees * std::numbers::pi / 180.0;
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  Mat3 m{1.0};
  m[j][j] = m[k][k] = std::cos(a);
  m[j][k] = std::sin(a);
  m[k][j] = -std::sin(a);
  return m;
}

// The angles of M = Rz Ry Rx.
Vec3 euler_degrees(const Mat3& m) {
  const double y = std::atan2(-m[0][2], std::hypot(m[0][0], m[0][1]));
  const double x = std::atan2(m[1][2], m[2][2]);
  const double z = std::atan2(m[0][1], m[0][0]);
  return Vec3{x, y, z} * (180.0 / std::numbers::pi);
}

std::string text(const Vec3& v) {
  std::ostringstream out;
  out.precision(17);
  out << std::showpoint << '[' << v.x << ", " << v.y << ", " << v.z << ']';
  return out.str();
}

std::string text(double v) {
  std::ostringstream out;
  out.precision(17);
  out << std::showpoint << v;
  return out.str();
}

// The rotation R of B(a) B(b)⁻¹ = R B(w), by Rodrigues' formula: about a×b, with
// tan(θ/2) = |a×b|/((1 + γ_a)(1 + γ_b) - a·b) (Ungar 1991).
Mat3 wigner(const Vec3& a, const Vec3& b) {
  const auto gamma = [](const Vec3& u) { return std::sqrt(1.0 + glm::dot(u, u)); };
  const Vec3 normal = glm::cross(a, b);
  const double size = glm::length(normal);
  if (size == 0.0) return Mat3{1.0};
  const double angle = 2.0 * std::atan2(size, (1.0 + gamma(a)) * (1.0 + gamma(b)) - glm::dot(a, b));
  const Vec3 n = normal / size;
  Mat3 r{1.0};
  for (int column = 0; column < 3; ++column) {
    Vec3 e{0.0};
    e[column] = 1.0;
    r[column] = std::cos(angle) * e + std::sin(angle) * glm::cross(n, e) +
                (1.0 - std::cos(angle)) * glm::dot(n, e) * n;
  }
  return r;
}

// All that is at rest in frames whose axes turn.
void turn(Redescription& result, std::map<std::string, Mat3>& rotation) {
  CameraModel& camera = result.model.camera;
  camera.position = rotation[camera.frame] * camera.position;
  camera.direction = rotation[camera.frame] * camera.direction;
  camera.up = rotation[camera.frame] * camera.up;
  for (ObjectModel& o : result.model.objects) {
    const Mat3& r = rotation[o.frame];
    o.position = r * o.position;
    o.rotate = euler_degrees(r * rotation_about(2, o.rotate.z) * rotation_about(1, o.rotate.y) *
                             rotation_about(0, o.rotate.x));
    result.rotation_of_object.push_back(r);
  }
  for (LightModel& l : result.model.lights) l.position = rotation[l.frame] * l.position;
}

}  // namespace

SceneModel passing_frames(const std::string& film) {
  SceneModel m;
  m.film = film;
  m.frames = {{"ground", {0, 0, 0}, {}},
              {"eye", {0.3, 0.05, 0.4}, {0.5, 0.2, 1.5, -8}},
              {"fair", {0.8, 0, -0.4}, {-3, -1.5, 0.5, 2}},
              {"lamp", {0.9, 0, 0.9}, {-8, -9, 7, -12}}};
  m.camera = {"eye", {0, 0, 0}, {0.1, -0.15, 1}, {0, 1, 0}, 0.4};
  return m;
}

std::string to_toml(const SceneModel& m) {
  std::string s = m.film + m.extra;
  for (const FrameModel& f : m.frames) {
    const double u = glm::length(f.celerity);
    s += "[frame." + f.name + "]\n";
    if (u > 0.0) s += "celerity = " + text(u) + "\nalong = " + text(f.celerity) + "\n";
    s += "origin = " + text(Vec3{f.origin[1], f.origin[2], f.origin[3]}) +
         "\norigin_time = " + text(f.origin[0]) + "\n";
    if (!f.within.empty()) s += "within = \"" + f.within + "\"\n";
  }
  s += "[camera]\nframe = \"" + m.camera.frame + "\"\nposition = " + text(m.camera.position) +
       "\ndirection = " + text(m.camera.direction) + "\nup = " + text(m.camera.up) +
       "\ntime = " + text(m.camera.time) + "\nfov = 65\n";
  for (const ObjectModel& o : m.objects) {
    s += "[[object]]\nframe = \"" + o.frame + "\"\nposition = " + text(o.position) +
         "\nrotate = " + text(o.rotate) + "\n" + o.body + "\n";
  }
  for (const LightModel& l : m.lights) {
    s += "[[light]]\nframe = \"" + l.frame + "\"\nposition = " + text(l.position) + "\n" + l.body + "\n";
  }
  return s;
}

Redescription redescribed(const SceneModel& model, const Vec3& celerity) {
  Redescription result{model, {}};
  std::map<std::string, Mat3> rotation;
  const Matrix to_new = boost(real(celerity));
  for (FrameModel& f : result.model.frames) {
    const auto old = real(f.celerity);
    const Real gamma = std::sqrt(1 + old[0] * old[0] + old[1] * old[1] + old[2] * old[2]);
    const Vector u = product(to_new, Vector{gamma, old[0], old[1], old[2]});
    const Vector origin = product(to_new, Vector{f.origin[0], f.origin[1], f.origin[2], f.origin[3]});
    const Matrix wigner = product(boost({u[1], u[2], u[3]}), product(to_new, boost(negated(old))));
    rotation[f.name] = space_part(wigner);
    f.celerity = {double(u[1]), double(u[2]), double(u[3])};
    f.origin = {double(origin[0]), double(origin[1]), double(origin[2]), double(origin[3])};
  }
  turn(result, rotation);
  return result;
}

Redescription within_frame(const SceneModel& model, const Vec3& celerity) {
  Redescription result{model, {}};
  std::map<std::string, Mat3> rotation;
  for (FrameModel& f : result.model.frames) {
    f.within = "outer";
    rotation[f.name] = glm::transpose(wigner(f.celerity, -celerity));
  }
  result.model.frames.push_back({"outer", celerity, {}, {}});
  turn(result, rotation);
  return result;
}

}  // namespace backlight::test
