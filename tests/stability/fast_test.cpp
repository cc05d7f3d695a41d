// Surfaces at γ = 1 ... 10¹⁴ as a camera sees them: every ray of fast_rays.txt through the tracer, against
// its answer of 130 digits (make_fast_rays.py). Counted as in stability_test.cpp, in the surface's own
// coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <stdexcept>

#include "backlight/scene/compile.h"
#include "backlight/scene/reader.h"
#include "backlight/trace/shading.h"
#include "backlight/trace/tracer.h"
#include "table.h"

namespace backlight::test {
namespace {

struct FastRay {
  std::string motion, surface;
  double gamma = 1.0;
  Vec3 celerity, origin, direction;
  bool hit = false;
  double lambda = 0.0;
  Vec3 point;
  double margin = 0.0;
};

std::istream& operator>>(std::istream& in, Vec3& v) {
  return in >> v.x >> v.y >> v.z;
}

std::vector<FastRay> all_rays() {
  std::ifstream file(std::string(BACKLIGHT_SOURCE_DIR) + "/tests/stability/fast_rays.txt");
  std::vector<FastRay> rays;
  FastRay r;
  while (file >> r.motion >> r.gamma >> r.surface >> r.celerity >> r.origin >> r.direction >> r.hit >>
         r.lambda >> r.point >> r.margin) {
    rays.push_back(r);
  }
  return rays;
}

// The object's keys, and the size of which errors are a part.
const std::map<std::string, std::pair<std::string, double>>& objects() {
  static const std::map<std::string, std::pair<std::string, double>> table{
      {"sphere | closed form", {"shape = \"sphere\"\nradius = 1\n", 1.0}},
      {"sphere | formula", {"shape = \"implicit\"\nf = \"x^2+y^2+z^2-1\"\n", 1.0}},
      {"torus | closed form", {"shape = \"torus\"\nmajor = 1\nminor = 0.25\n", 1.25}},
      {"torus | formula", {"shape = \"implicit\"\nf = \"(x^2+y^2+z^2+0.9375)^2-4*(x^2+z^2)\"\n", 1.25}},
      {"barth6 | formula",
       {"shape = \"implicit\"\nf = \"4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)"
        "-(1+2*p)*(x^2+y^2+z^2-1)^2\"\nbounds = [[-1.75, -1.75, -1.75], [1.75, 1.75, 1.75]]\n",
        1.75}},
      {"klein | formula",
       {"shape = \"implicit\"\nf = \"(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2)"
        "+16*x*z*(x^2+y^2+z^2-2*y-1)\"\nbounds = [[-4, -4, -4], [4, 4, 4]]\n",
        3.0}}};
  return table;
}

// The object in a frame of its own, whose motion each ray sets.
Scene scene_with(const std::string& object) {
  const std::string text =
      "[params]\np = 1.618033988749895\n[camera]\n[frame.fast]\nbeta = [0, 0, 0]\n[[object]]\nframe = "
      "\"fast\"\n" +
      object;
  const ReadResult read = read_scene_text(text, "fast.toml", {}, BACKLIGHT_SOURCE_DIR);
  if (!read.description) throw std::runtime_error("fast.toml cannot be read");
  ResourceCache resources;
  Diagnostics diagnostics;
  std::optional<Scene> scene = compile(*read.description, {}, resources, diagnostics);
  if (!scene) throw std::runtime_error(format(diagnostics.all().front()));
  return std::move(*scene);
}

struct Seen {
  SurfaceRecord record;
  Vec3 direction;  // of the ray in the surface's frame, unit
};

Seen seen(Scene& scene, const FastRay& ray) {
  for (SceneFrame& frame : scene.frames) {
    if (frame.surfaces->size() == 0) continue;
    frame.motion.celerity = ExtendedVec3{ray.celerity};
    frame.motion.origin = {Extended(0.0), ExtendedVec3{ray.origin}};
  }
  scene.camera.celerity = {};
  scene.camera.event = {};
  const Tracer tracer(scene, 0);
  Scratch scratch = tracer.make_scratch();
  CameraRay looking;
  looking.direction = ray.direction;
  const Hub& hub = tracer.hub();
  const FrameView& frame = hub.frames[static_cast<std::size_t>(hub.occupied.front())];
  return {tracer.surface(looking, scratch), glm::normalize(in_frame(frame, looking).direction)};
}

// As in stability_test.cpp.
constexpr double undecided = 1e-13;

void judge(const FastRay& ray, const Seen& seen, double size, Count& count) {
  const SurfaceRecord& record = seen.record;
  const bool found = record.object_id != 0;
  const bool close = ray.margin < undecided * size;
  ++count.rays;
  count.hits += found ? 1 : 0;
  count.unresolved += record.unresolved ? 1 : 0;
  if (found != ray.hit) {
    ++(close ? count.within_rounding : ray.hit ? count.missed : count.invented);
    return;
  }
  if (!found) return;
  const Vec3 off = record.position - ray.point;
  // Off the surface, and off the ray.
  const Vec3 aside = off - glm::dot(off, seen.direction) * seen.direction;
  const double error = std::max(std::abs(glm::dot(off, record.normal)), glm::length(aside));
  if (glm::length(off) > 1e-6 * size) {
    ++(close || record.unresolved     ? count.within_rounding
       : record.distance > ray.lambda ? count.missed
                                      : count.invented);
    return;
  }
  if (!record.unresolved && !close) count.worst = std::max(count.worst, error / size);
}

// The rows of the table: up to this γ.
struct Range {
  double last;
  const char* name;
};
constexpr Range ranges[] = {{29, "1 to 29"},   {1e3, "31 to 10³"}, {1e5, "10⁴, 10⁵"}, {1e6, "10⁶"},
                            {1e8, "10⁷, 10⁸"}, {1e10, "10¹⁰"},     {1e12, "10¹²"},    {1e14, "10¹⁴"}};

std::size_t range_of(double gamma) {
  std::size_t i = 0;
  while (ranges[i].last < gamma) ++i;
  return i;
}

struct Measured {
  double gamma = 0.0;  // the least of the row
  std::string name;
  Count count;
};

const std::vector<Measured>& measured() {
  static const std::vector<Measured> rows = [] {
    std::map<std::pair<std::string, std::size_t>, Measured> found;
    const std::vector<FastRay> rays = all_rays();
    for (const auto& [name, object] : objects()) {
      Scene scene = scene_with(object.first);
      for (const FastRay& ray : rays) {
        if (name.substr(0, name.find(' ')) != ray.surface) continue;
        Measured& row = found[{ray.motion, range_of(ray.gamma)}];
        if (row.name.empty()) row = {ray.gamma, ray.motion + " | " + ranges[range_of(ray.gamma)].name, {}};
        judge(ray, seen(scene, ray), object.second, row.count);
      }
    }
    std::vector<Measured> result;
    for (const auto& [key, row] : found) result.push_back(row);
    return result;
  }();
  return rows;
}

// What the page promises; beyond, the table says how it goes.
constexpr double promised = 1e8;

TEST(FastSurfaces, PageShowsWhatWasMeasured) {
  Table table;
  for (const Measured& row : measured()) table.emplace_back(row.name, row.count);
  expect_on_page("fast", "motion | γ", table);
}

TEST(FastSurfaces, NoRootIsMissedAndNoneInvented) {
  int rays = 0;
  for (const Measured& row : measured()) {
    rays += row.count.rays;
    if (row.gamma > promised) continue;
    EXPECT_EQ(row.count.missed, 0) << row.name;
    EXPECT_EQ(row.count.invented, 0) << row.name;
  }
  EXPECT_GT(rays, 1000);
}

TEST(FastSurfaces, HitsAreOnTheSurface) {
  for (const Measured& row : measured()) {
    if (row.gamma > promised) continue;
    EXPECT_LE(row.count.worst, 1e-11) << row.name;
  }
}

}  // namespace
}  // namespace backlight::test
