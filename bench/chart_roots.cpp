// Root finders beside each other: rays a second against the worst error of a hit, and roots missed or
// invented.
//   chart_roots FOLDER [--quick] [SURFACE...]     CSV on stdout; FOLDER takes POV-Ray's scenes and answers
//
// The same rays for all: a square of pixels of one camera. The truth of each ray is its first change of sign:
// among 2048 samples in double precision, and 512 more about whatever any method reports before that; refined
// with 77 digits. POV-Ray's hits are those of its trace(), its speed is that of a frame of these rays without
// lights, less that of an empty frame.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "backlight/surface/implicit.h"
#include "backlight/surface/surface_set.h"
#include "support/known_surfaces.h"
#include "support/measure.h"

namespace backlight::bench {
namespace {

namespace fs = std::filesystem;

constexpr double none = std::numeric_limits<double>::infinity();
constexpr double wrong_beyond = 0.01;  // of the size: a hit farther off is another root, or none

struct Setup {
  KnownSurface surface;
  Vec3 eye;
  std::vector<Vec3> rays;  // unit directions
  int edge;
};

// The camera of both programs: looks at the origin, mirrored nowhere.
Setup setup_of(const KnownSurface& surface, int edge) {
  Setup s{surface, surface.half * Vec3(0.9, 1.3, -2.6), {}, edge};
  const Vec3 forward = glm::normalize(-s.eye), right = glm::normalize(glm::cross(forward, Vec3(0, 1, 0)));
  const Vec3 up = glm::cross(right, forward);
  const double half = std::tan(20.0 * M_PI / 180.0);
  for (int y = 0; y < edge; ++y) {
    for (int x = 0; x < edge; ++x) {
      const double u = half * (2.0 * (x + 0.5) / edge - 1.0), v = half * (1.0 - 2.0 * (y + 0.5) / edge);
      s.rays.push_back(glm::normalize(forward + u * right + v * up));
    }
  }
  return s;
}

// The part of the ray in the cube; begin > end: none.
std::pair<double, double> within(const Setup& s, const Vec3& ray) {
  double begin = 0.0, end = none;
  for (int i = 0; i < 3; ++i) {
    const double a = (-s.surface.half - s.eye[i]) / ray[i], b = (s.surface.half - s.eye[i]) / ray[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return {begin, end};
}

double along(const Setup& s, const Vec3& ray, double lambda) {
  const Vec3 p = s.eye + lambda * ray;
  return s.surface.value(p.x, p.y, p.z);
}

Precise precisely(const Setup& s, const Vec3& ray, const Precise& lambda) {
  return s.surface.precise(Precise(s.eye.x) + lambda * Precise(ray.x),
                           Precise(s.eye.y) + lambda * Precise(ray.y),
                           Precise(s.eye.z) + lambda * Precise(ray.z));
}

// Halves the bracket in double precision, then in 77 digits around what is left.
double refined(const Setup& s, const Vec3& ray, double a, double b) {
  const bool rises = along(s, ray, a) < 0.0;
  for (int i = 0; i < 36; ++i) {
    const double middle = 0.5 * (a + b);
    ((along(s, ray, middle) < 0.0) == rises ? a : b) = middle;
  }
  const double room = 1e-12 * s.surface.half;
  Precise low(a - room), high(b + room);
  const int before = precisely(s, ray, low).sign();
  if (before * precisely(s, ray, high).sign() > 0) return 0.5 * (a + b);  // rounding hid the very sign
  for (int i = 0; i < 24; ++i) {
    const Precise middle = (low + high) * Precise(0.5);
    (precisely(s, ray, middle).sign() == before ? low : high) = middle;
  }
  return double((low + high) * Precise(0.5));
}

double first_change(const Setup& s, const Vec3& ray, double begin, double end, int samples) {
  double a = begin;
  bool negative = along(s, ray, a) < 0.0;
  for (int i = 1; i <= samples; ++i) {
    const double b = begin + (end - begin) * i / samples;
    const bool then = along(s, ray, b) < 0.0;
    if (then != negative) return refined(s, ray, a, b);
    a = b;
    negative = then;
  }
  return none;
}

struct Answers {
  std::string method;
  std::vector<double> lambda;  // by ray
  std::vector<bool> unresolved;
  double seconds = 0.0;  // for so many rays
  double timed_rays = 1.0;
};

// By ray; NaN where the first root is so near the cube's faces that rounding of the faces decides.
std::vector<double> truth_of(const Setup& s, const std::vector<Answers>& all) {
  std::vector<double> truth;
  const double size = s.surface.half;
  for (std::size_t i = 0; i < s.rays.size(); ++i) {
    const Vec3& ray = s.rays[i];
    const auto [begin, end] = within(s, ray);
    double first = none;
    if (begin < end) first = first_change(s, ray, begin, end, 2048);
    for (const Answers& answers : all) {
      const double reported = answers.lambda[i];
      if (!(reported < first - 1e-3 * size) || !(begin < end)) continue;
      const double room = 5e-4 * size;
      first = std::min(
          first, first_change(s, ray, std::max(begin, reported - room), std::min(end, reported + room), 512));
    }
    const Vec3 hit = s.eye + (first < none ? first : 0.5 * (begin + end)) * ray;
    const double to_face = size - std::max({std::abs(hit.x), std::abs(hit.y), std::abs(hit.z)});
    if (first < none && std::abs(to_face) < wrong_beyond * size) first = NAN;
    // A ray that enters through the surface's own edge on a face: the next root is ambiguous too.
    if (begin < end && std::abs(along(s, ray, begin)) < 1e-6) first = NAN;
    truth.push_back(first);
  }
  return truth;
}

void report(const Setup& s, const std::vector<double>& truth, const Answers& answers) {
  std::size_t hits = 0, rays = 0, missed = 0, invented = 0, unresolved = 0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (std::isnan(truth[i])) continue;
    ++rays;
    hits += truth[i] < none ? 1 : 0;
    if (!answers.unresolved.empty() && answers.unresolved[i]) {
      ++unresolved;
      continue;
    }
    const double got = answers.lambda[i];
    if (got == truth[i]) {  // nothing is there, and nothing was found
      if (got < none) errors.push_back(0.0);
      continue;
    }
    const double error = std::abs(got - truth[i]) / s.surface.half;
    if (error <= wrong_beyond) {
      errors.push_back(error);
    } else {
      ++(got < truth[i] ? invented : missed);
    }
  }
  std::ranges::sort(errors);
  const auto part = [&](double share) {
    return errors.empty() ? NAN : errors[std::size_t(share * double(errors.size() - 1))];
  };
  std::printf("\"%s\",%s,%.5g,%.3g,%.3g,%zu,%zu,%zu,%zu,%zu\n", s.surface.name, answers.method.c_str(),
              answers.timed_rays / answers.seconds, part(1.0), part(0.5), missed, invented, unresolved, hits,
              rays);
  std::fflush(stdout);
}

// ---- Backlight ----

struct Own {
  std::string method;
  std::shared_ptr<SurfaceSet> set;
};

Own own(const std::string& method, const Shape& shape) {
  auto set = std::make_shared<SurfaceSet>();
  set->add(shape, Placement());
  set->build();
  return {method, set};
}

std::vector<Own> own_methods(const KnownSurface& surface) {
  const auto parsed = Expression::parse(surface.formula.backlight, {"x", "y", "z", "t"});
  const auto f = std::make_shared<const ImplicitFormula>(std::get<Expression>(parsed));
  const Vec3 high(surface.half), low = -high;
  const RootFinder chosen = root_finder(implicit(f, low, high));
  std::vector<Own> all;
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    if (finder == RootFinder::polynomial && !f->program().degree()) continue;
    const Shape shape = implicit(f, low, high, {.finder = finder});
    const std::string mark = finder == chosen ? " (chosen)" : "";
    all.push_back(own("Backlight: " + std::string(name(finder)) + mark, shape));
  }
  if (surface.closed_form == 1) all.push_back(own("Backlight: torus", torus(1.0, 0.3)));
  if (surface.closed_form == 2) all.push_back(own("Backlight: sphere", sphere(1.0)));
  return all;
}

void trace(const Own& method, const Setup& s, Answers& answers) {
  constexpr std::size_t most = sheet_size;
  RaySheet sheet;
  sheet.one_origin = true;
  sheet.start_time[0] = 0.0;
  for (int k = 0; k < 3; ++k) sheet.origin[k][0] = s.eye[k];
  answers.lambda.clear();
  answers.unresolved.clear();
  for (std::size_t first = 0; first < s.rays.size(); first += most) {
    const std::size_t count = std::min(most, s.rays.size() - first);
    sheet.padded = static_cast<int>((count + 7) / 8 * 8);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sheet.padded); ++i) {
      const Vec3& ray = s.rays[first + std::min(i, count - 1)];
      for (int k = 0; k < 3; ++k) sheet.direction[k][i] = ray[k];
      sheet.length[i] = glm::length(ray);
      sheet.time_rate[i] = -1.0;
    }
    SheetHits hits;
    hits.clear(most);
    method.set->nearest(sheet, count < most ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0}, 0.0, hits);
    for (int i = 0; i < static_cast<int>(count); ++i) {
      answers.lambda.push_back(hits.who[i] < 0.0 ? none : hits.lambda[i]);
      answers.unresolved.push_back(hits.who[i] >= 0.0 && hits.is_unresolved(i));
    }
  }
}

// What many programs do: 64 samples, a change of sign between two of them, and bisection.
void march(const Setup& s, Answers& answers) {
  answers.lambda.clear();
  for (const Vec3& ray : s.rays) {
    const auto [begin, end] = within(s, ray);
    double found = none, a = begin;
    bool negative = begin < end && along(s, ray, a) < 0.0;
    for (int i = 1; begin < end && i <= 64 && found == none; ++i) {
      const double b = begin + (end - begin) * i / 64;
      const bool then = along(s, ray, b) < 0.0;
      if (then != negative) {
        double low = a, high = b;
        for (int k = 0; k < 48; ++k) {
          const double middle = 0.5 * (low + high);
          ((along(s, ray, middle) < 0.0) == negative ? low : high) = middle;
        }
        found = 0.5 * (low + high);
      }
      a = b;
      negative = then;
    }
    answers.lambda.push_back(found);
  }
}

// ---- POV-Ray ----

struct Pov {
  std::string method;
  std::string object;  // without texture
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// The steepest that f is in the cube, by differences on a lattice: POV-Ray wants to be told.
double steepest(const KnownSurface& f) {
  constexpr int n = 40;
  double most = 0.0;
  const double step = 1e-6 * f.half;
  for (int i = 0; i <= n * n * n + 3 * n * n + 3 * n; ++i) {
    const double at[3] = {f.half * (2.0 * (i % (n + 1)) / n - 1.0),
                          f.half * (2.0 * (i / (n + 1) % (n + 1)) / n - 1.0),
                          f.half * (2.0 * (i / ((n + 1) * (n + 1))) / n - 1.0)};
    const auto slope = [&](int axis) {
      double a[3] = {at[0], at[1], at[2]}, b[3] = {at[0], at[1], at[2]};
      a[axis] -= step;
      b[axis] += step;
      return (f.value(b[0], b[1], b[2]) - f.value(a[0], a[1], a[2])) / (2.0 * step);
    };
    most = std::max(most, std::hypot(slope(0), slope(1), slope(2)));
  }
  return most;
}

std::vector<Pov> pov_methods(const KnownSurface& f, bool quick) {
  const std::string cube = "box { " + number(-f.half) + ", " + number(f.half) + " }";
  std::vector<Pov> all;
  if (!f.monomials.terms.empty()) {
    std::string terms;
    for (const auto& [e, c] : f.monomials.terms) {
      terms += ", xyz(" + std::to_string(e[0]) + "," + std::to_string(e[1]) + "," + std::to_string(e[2]) +
               "): " + number(c);
    }
    const std::string start = "polynomial { " + std::to_string(f.monomials.degree()) + terms;
    const std::string end = " clipped_by { " + cube + " } bounded_by { clipped_by }";
    all.push_back({"POV-Ray: polynomial", start + end});
    all.push_back({"POV-Ray: polynomial sturm", start + " sturm" + end});
  }
  if (f.closed_form == 1) {
    all.push_back({"POV-Ray: torus", "torus { 1, 0.3"});
    all.push_back({"POV-Ray: torus sturm", "torus { 1, 0.3 sturm"});
  }
  if (f.closed_form == 2) all.push_back({"POV-Ray: sphere", "sphere { 0, 1"});
  const std::string gradient = number(1.02 * steepest(f));
  const std::string start =
      "isosurface { function { " + f.formula.povray + " } contained_by { " + cube + " } open ";
  all.push_back({"POV-Ray: isosurface as it comes", start + "accuracy 0.001"});
  for (const char* accuracy : {"1e-3", "1e-6", "1e-9"}) {
    if (quick && std::string(accuracy) == "1e-9") continue;
    all.push_back({"POV-Ray: isosurface " + std::string(accuracy),
                   start + "max_gradient " + gradient + " accuracy " + accuracy});
  }
  return all;
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string vector_of(const Vec3& v) {
  return "<" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ">";
}

// Its own words; ends the program where POV-Ray fails.
std::string run_povray(const fs::path& folder, const std::string& scene, int edge) {
  const std::string command = "cd '" + folder.string() + "' && taskset -c 0 povray +I" + scene +
                              " -F -A -D +WT1 +W" + std::to_string(edge) + " +H" + std::to_string(edge) +
                              " >povray.log 2>&1";
  if (std::system(command.c_str()) != 0) {
    std::cerr << "chart_roots: POV-Ray failed; see " << (folder / "povray.log") << '\n';
    std::exit(1);
  }
  std::ostringstream words;
  words << std::ifstream(folder / "povray.log").rdbuf();
  return words.str();
}

double traced_seconds(const fs::path& folder, const std::string& scene, int edge) {
  const std::string words = run_povray(folder, scene, edge);
  std::smatch found;
  if (!std::regex_search(words, found,
                         std::regex(R"(Trace Time:[^)]*\)\s+using[^)]*\) with ([0-9.]+) CPU-seconds)"))) {
    std::cerr << "chart_roots: POV-Ray does not tell its time; see " << (folder / "povray.log") << '\n';
    std::exit(1);
  }
  return std::stod(found[1]);
}

constexpr const char* pov_head = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n";

std::vector<double> pov_hits(const fs::path& folder, const Setup& s, const Pov& method) {
  std::string rays;
  for (const Vec3& r : s.rays) rays += number(r.x) + ", " + number(r.y) + ", " + number(r.z) + ",\n";
  rays.resize(rays.size() - 2);  // no comma behind the last
  write(folder / "rays.txt", rays);
  write(folder / "hits.pov",
        std::string(pov_head) + "#declare Thing = " + method.object +
            " }\n#declare Eye = " + vector_of(s.eye) +
            ";\n#fopen In \"rays.txt\" read\n#fopen Out \"hits.txt\" write\n#while (defined(In))\n"
            "#read (In, X, Y, Z)\n#declare N = <0, 0, 0>;\n#declare P = trace(Thing, Eye, <X, Y, Z>, N);\n"
            "#if (vlength(N) > 0)\n#write (Out, str(vdot(P - Eye, <X, Y, Z>), 0, 17), \"\\n\")\n"
            "#else\n#write (Out, \"inf\\n\")\n#end\n#end\n#fclose In\n#fclose Out\n"
            "camera { location 0 look_at z }\n");
  run_povray(folder, "hits.pov", 4);
  std::ifstream in(folder / "hits.txt");
  std::vector<double> hits;
  for (std::string word; in >> word;) hits.push_back(std::strtod(word.c_str(), nullptr));
  if (hits.size() != s.rays.size()) {
    std::cerr << "chart_roots: POV-Ray answered " << hits.size() << " of " << s.rays.size() << " rays\n";
    std::exit(1);
  }
  return hits;
}

std::string frame_scene(const Setup& s, const std::string& object) {
  return std::string(pov_head) + "camera { perspective location " + vector_of(s.eye) +
         " look_at 0 right -x up y angle 40 }\n" + object;
}

struct PovTiming {
  std::string scene;
  int edge = 128;
  std::vector<double> seconds, empty;
};

bool has_povray() {
  static const bool has = std::system("command -v povray >/dev/null 2>&1") == 0;
  static const bool told =
      !has && std::fputs("chart_roots: POV-Ray is not installed: without it\n", stderr) >= 0;
  (void)told;
  return has;
}

void chart(const fs::path& folder, const KnownSurface& surface, bool quick) {
  const int edge = quick ? 24 : 56;
  const int rounds = quick ? 2 : 3;
  const Setup s = setup_of(surface, edge);
  const std::vector<Own> ours = own_methods(surface);
  const std::vector<Pov> theirs = has_povray() ? pov_methods(surface, quick) : std::vector<Pov>{};

  std::vector<Answers> all;
  for (const Own& method : ours) trace(method, s, all.emplace_back(Answers{method.method, {}, {}}));
  march(s, all.emplace_back(Answers{"64 samples and bisection", {}, {}}));
  for (const Pov& method : theirs) all.push_back({method.method, pov_hits(folder, s, method), {}});

  write(folder / "empty.pov", frame_scene(s, ""));
  std::vector<PovTiming> timings;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    PovTiming t{"frame" + std::to_string(i) + ".pov"};
    write(folder / t.scene,
          frame_scene(s, theirs[i].object + " pigment { rgb 1 } finish { ambient 1 diffuse 0 } }\n"));
    t.edge = 24;
    const double pilot = traced_seconds(folder, t.scene, t.edge);
    const double wanted = quick ? 0.1 : 0.4;
    t.edge = std::clamp(int(24.0 * std::sqrt(wanted / std::max(pilot, 0.001))), 24, 640);
    timings.push_back(t);
  }
  const Setup many = setup_of(surface, quick ? 96 : 256);
  std::vector<std::vector<double>> own_seconds(ours.size() + 1);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i <= ours.size(); ++i) {
      Answers ignored{"", {}, {}};
      const double start = cpu_seconds();
      i < ours.size() ? trace(ours[i], many, ignored) : march(many, ignored);
      own_seconds[i].push_back(cpu_seconds() - start);
    }
    for (PovTiming& t : timings) {
      // Little of the whole, and most of a run is its start: once is enough.
      if (round == 0) t.empty.push_back(traced_seconds(folder, "empty.pov", t.edge));
      t.seconds.push_back(traced_seconds(folder, t.scene, t.edge));
    }
  }
  for (std::size_t i = 0; i <= ours.size(); ++i) {
    all[i].seconds = median(own_seconds[i]);
    all[i].timed_rays = double(many.rays.size());
  }
  for (std::size_t i = 0; i < timings.size(); ++i) {
    Answers& answers = all[ours.size() + 1 + i];
    answers.seconds = std::max(median(timings[i].seconds) - median(timings[i].empty), 0.001);
    answers.timed_rays = double(timings[i].edge) * timings[i].edge;
  }
  const std::vector<double> truth = truth_of(s, all);
  for (const Answers& answers : all) report(s, truth, answers);
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  using namespace backlight::bench;
  if (argc < 2) {
    std::cerr << "chart_roots FOLDER [--quick] [SURFACE...]\n";
    return 2;
  }
  bool quick = false;
  std::vector<std::string> wanted;
  for (int i = 2; i < argc; ++i) {
    if (std::string(argv[i]) == "--quick" || std::string(argv[i]) == "--smoke")
      quick = true;
    else
      wanted.emplace_back(argv[i]);
  }
  std::puts("surface,method,rays_per_second,worst_error,median_error,missed,invented,unresolved,hits,rays");
  for (const KnownSurface& surface : known_surfaces()) {
    const auto is_it = [&](const std::string& name) {
      return std::string(surface.name).find(name) != std::string::npos;
    };
    if (wanted.empty() || std::ranges::any_of(wanted, is_it)) chart(argv[1], surface, quick);
  }
}
