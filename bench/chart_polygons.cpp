// Polygons against rays: the other way of drawing what moves fast (Chang, Lai & Chen 1996; Rau, Weiskopf &
// Ruder 1998). Each shape is cut into triangles, the corners are sent to their apparent places, and the
// triangles are filled as straight ones.
//   chart_polygons [--quick | --smoke]      CSV on stdout; CPU seconds
//
// A row of balls, boxes and tori flies past the camera; neither lamps nor shadows. What a pixel of the
// polygons shows is a point of a body, interpolated; its error is how far from the pixel that point is seen
// really, in pixels.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "../tests/support/meshes.h"
#include "support/measure.h"

namespace backlight::bench {
namespace {

constexpr double distance = 5.0, eye = 1.0, fov = 80.0;

struct Body {
  Vec3 place;  ///< in the frame of the row
  int kind;    ///< 0 ball, 1 box, 2 torus
};

std::vector<Body> row() {
  std::vector<Body> bodies;
  for (int i = -8; i <= 8; ++i) bodies.push_back({{3.0 * i, 0.0, i % 2 == 0 ? 0.0 : 1.0}, (i + 9) % 3});
  return bodies;
}

MeshData box_of(int n) {
  MeshData mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    const auto first = static_cast<std::uint32_t>(mesh.places.size());
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        Vec3 place{0.0};
        place[axis] = face % 2 == 0 ? -0.5 : 0.5;
        place[b] = double(i) / n - 0.5;
        place[c] = double(j) / n - 0.5;
        mesh.places.push_back(place);
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto at = static_cast<std::uint32_t>(i * (n + 1) + j) + first,
                   next = at + static_cast<std::uint32_t>(n) + 1;
        mesh.triangles.push_back({at, next, next + 1});
        mesh.triangles.push_back({at, next + 1, at + 1});
      }
    }
  }
  return mesh;
}

/// A ball as a torus without a hole has its parts: rings from pole to pole.
MeshData ball_of(int n) {
  MeshData mesh;
  const int around = 2 * n;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / n, turn = 2.0 * std::numbers::pi * j / around;
      mesh.places.push_back(
          0.5 * Vec3{std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)});
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < around; ++j) {
      const auto at = [&](int k, int l) { return static_cast<std::uint32_t>(k * around + l % around); };
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < n - 1) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

MeshData mesh_of(int kind, int n) {
  if (kind == 0) return ball_of(2 * n);
  if (kind == 1) return box_of(n);
  return test::torus_mesh(0.4, 0.15, static_cast<std::uint32_t>(4 * n), static_cast<std::uint32_t>(2 * n));
}

/// The camera, which is at rest, at its time 0; the row goes along x.
struct View {
  int width, height;
  double beta;
  double gamma = 1.0 / std::sqrt((1.0 - beta) * (1.0 + beta));
  double half = std::tan(0.5 * fov * std::numbers::pi / 180.0);

  /// The exposure's time in the world: when light from the row's middle arrives.
  [[nodiscard]] double time() const { return std::hypot(distance, eye); }
  /// Where a point of the row is seen from the camera, in its axes: x to the right (the world's -x), y up, z
  /// forward; of the length of the light's way.
  [[nodiscard]] Vec3 apparent(const Vec3& point) const {
    const double t = time();
    const Vec3 camera{-gamma * beta * t, eye, -distance};  // in the row's frame
    const Vec3 way = point - camera;
    const double past = -glm::length(way);
    return {-(gamma * (way.x + beta * past)), way.y, way.z};
  }
  [[nodiscard]] Vec3 on_image(const Vec3& seen) const {
    const double scale = 0.5 * width / (half * seen.z);
    return {0.5 * width + scale * seen.x, 0.5 * height - scale * seen.y, seen.z};
  }
};

struct Pixel {
  float depth = std::numeric_limits<float>::infinity();
  int id = 0;
  Vec3 point{0.0};
};

class Polygons {
 public:
  Polygons(const View& view, int n) : view_(view), bodies_(row()) {
    for (int kind = 0; kind < 3; ++kind) meshes_.push_back(mesh_of(kind, n));
  }
  [[nodiscard]] std::size_t triangles() const {
    std::size_t sum = 0;
    for (const Body& body : bodies_) sum += meshes_[static_cast<std::size_t>(body.kind)].triangles.size();
    return sum;
  }

  void draw(std::vector<Pixel>& image) const {
    image.assign(static_cast<std::size_t>(view_.width * view_.height), {});
    std::vector<Vec3> points, seen;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const MeshData& mesh = meshes_[static_cast<std::size_t>(bodies_[i].kind)];
      points.clear();
      seen.clear();
      for (const Vec3& place : mesh.places) {
        points.push_back(place + bodies_[i].place);
        seen.push_back(view_.on_image(view_.apparent(points.back())));
      }
      for (const auto& triangle : mesh.triangles)
        fill(triangle, points, seen, static_cast<int>(i) + 1, image);
    }
  }

 private:
  void fill(const std::array<std::uint32_t, 3>& t, const std::vector<Vec3>& points,
            const std::vector<Vec3>& seen, int id, std::vector<Pixel>& image) const {
    const Vec3 &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
    constexpr double nearest = 1e-3;
    if (!(a.z > nearest && b.z > nearest && c.z > nearest)) return;
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0.0) return;
    const int x0 = std::max(0, int(std::ceil(std::min({a.x, b.x, c.x}) - 0.5)));
    const int x1 = std::min(view_.width - 1, int(std::floor(std::max({a.x, b.x, c.x}) - 0.5)));
    const int y0 = std::max(0, int(std::ceil(std::min({a.y, b.y, c.y}) - 0.5)));
    const int y1 = std::min(view_.height - 1, int(std::floor(std::max({a.y, b.y, c.y}) - 0.5)));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
        const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
        const double w = 1.0 - u - v;
        if (!(u >= 0.0 && v >= 0.0 && w >= 0.0)) continue;
        const double depth = 1.0 / (u / a.z + v / b.z + w / c.z);
        Pixel& pixel = image[static_cast<std::size_t>(y * view_.width + x)];
        if (!(depth < double(pixel.depth))) continue;
        pixel = {float(depth), id,
                 depth * (u / a.z * points[t[0]] + v / b.z * points[t[1]] + w / c.z * points[t[2]])};
      }
    }
  }

  const View& view_;
  std::vector<Body> bodies_;
  std::vector<MeshData> meshes_;
};

std::string text(const Vec3& v) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, "[%.17g, %.17g, %.17g]", v.x, v.y, v.z);
  return buffer;
}

Scene scene_of(const View& view) {
  std::string scene =
      "c = 1\n[film]\nresolution = [" + std::to_string(view.width) + ", " + std::to_string(view.height) +
      "]\naovs = [\"objectId\"]\n[camera]\nposition = " + text({0, eye, -distance}) +
      "\ndirection = [0, 0, 1]\ntime = " +
      text({view.time(), 0, 0}).substr(1, text({view.time(), 0, 0}).find(',') - 1) +
      "\nfov = 80\n[frame.row]\nbeta = " + text({view.beta, 0, 0}) + "\n[effects]\ndoppler = false\n";
  const char* const shapes[3] = {"shape = \"sphere\"\nradius = 0.5", "shape = \"box\"\nsize = [1, 1, 1]",
                                 "shape = \"torus\"\nmajor = 0.4\nminor = 0.15"};
  for (const Body& body : row()) {
    scene += "[[object]]\nframe = \"row\"\nposition = " + text(body.place) +
             "\nmaterial = { color = [0, 0, 0], emission = 0.5 }\n" + shapes[body.kind] + "\n";
  }
  return load_text(scene);
}

void compare(const View& view, const std::vector<Pixel>& polygons, const Image& rays, double& wrong,
             double& rms, double& percentile99) {
  const auto ids = rays.plane(static_cast<std::size_t>(rays.find_channel("objectId.V")));
  std::vector<double> off;
  std::size_t covered = 0, other = 0;
  double squares = 0.0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * view.width + x);
      const int id = static_cast<int>(ids[i]);
      covered += id > 0 || polygons[i].id > 0 ? 1 : 0;
      other += id != polygons[i].id ? 1 : 0;
      if (id == 0 || id != polygons[i].id) continue;
      const Vec3 really = view.on_image(view.apparent(polygons[i].point));
      off.push_back(std::hypot(really.x - x - 0.5, really.y - y - 0.5));
      squares += off.back() * off.back();
    }
  }
  std::ranges::sort(off);
  wrong = double(other) / double(std::max<std::size_t>(covered, 1));
  rms = off.empty() ? 0.0 : std::sqrt(squares / double(off.size()));
  percentile99 = off.empty() ? 0.0 : off[(off.size() - 1) * 99 / 100];
}

void measure(int width, int height, int times, const std::vector<int>& fineness) {
  std::puts("beta,method,triangles,cpu_seconds,wrong_share,rms_pixels,percentile99_pixels");
  for (const double beta : {0.0, 0.5, 0.9, 0.99}) {
    const View view{width, height, beta};
    const Scene scene = scene_of(view);
    const RenderedImage reference = render(scene);
    const double seconds = median_cpu_seconds(times, [&] { (void)render(scene); });
    std::printf("%g,rays,0,%.6g,0,0,0\n", beta, seconds);
    for (const int n : fineness) {
      const Polygons polygons(view, n);
      std::vector<Pixel> image;
      const double taken = median_cpu_seconds(times, [&] { polygons.draw(image); });
      double wrong = 0.0, rms = 0.0, percentile99 = 0.0;
      compare(view, image, reference.image, wrong, rms, percentile99);
      std::printf("%g,polygons,%zu,%.6g,%.4g,%.4g,%.4g\n", beta, polygons.triangles(), taken, wrong, rms,
                  percentile99);
    }
  }
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  using backlight::bench::measure;
  const std::string flag = argc > 1 ? argv[1] : "";
  if (flag == "--smoke") {
    measure(90, 50, 1, {1, 4});
  } else if (flag == "--quick") {
    measure(360, 202, 3, {1, 2, 4, 8, 16, 32, 64});
  } else {
    measure(720, 405, 5, {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128});
  }
  return 0;
}
