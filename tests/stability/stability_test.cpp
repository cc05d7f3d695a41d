// Where root finders fail: every ray of rays.txt against its answer of 100 digits (make_rays.py).
//
// A ray counts as missed or false unless the surface lies within a few rounding errors of another answer. The
// table that this suite writes is a part of docs/stability.md; with BACKLIGHT_UPDATE_STABILITY set it is put
// there, and otherwise the page must have it already.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/solid.h"
#include "backlight/surface/surface_set.h"
#include "table.h"

namespace backlight::test {
namespace {

__extension__ typedef __float128 Quad;

const std::string folder = std::string(BACKLIGHT_SOURCE_DIR) + "/tests/stability/";

struct Ray {
  std::string suite, surface;
  Vec3 origin, direction;
  bool hit = false;
  double lambda = 0.0;
  Quad exact_lambda = 0.0;
  double margin = 0.0;
};

// A decimal number of up to 38 digits, right to 113 bits: λ of a far ray has more digits than a double.
Quad exact(const std::string& text) {
  Quad digits = 0.0;
  Quad scale = 1.0;
  bool behind_point = false;
  for (const char c : text) {
    if (c == '.') behind_point = true;
    if (c < '0' || c > '9') {
      if (c != '.') break;
      continue;
    }
    digits = digits * 10 + (c - '0');
    if (behind_point) scale = scale * 10;
  }
  const std::size_t e = text.find('e');
  for (int i = e == std::string::npos ? 0 : std::stoi(text.substr(e + 1)); i != 0; i += i < 0 ? 1 : -1) {
    if (i < 0) {
      scale = scale * 10;
    } else {
      digits = digits * 10;
    }
  }
  return digits / scale;
}

std::vector<Ray> all_rays() {
  std::ifstream file(folder + "rays.txt");
  std::vector<Ray> rays;
  Ray r;
  int hit = 0;
  int roots = 0;
  std::string lambda;
  while (file >> r.suite >> r.surface >> r.origin.x >> r.origin.y >> r.origin.z >> r.direction.x >>
         r.direction.y >> r.direction.z >> hit >> lambda >> r.margin >> roots) {
    r.hit = hit != 0;
    r.exact_lambda = exact(lambda);
    r.lambda = static_cast<double>(r.exact_lambda);
    rays.push_back(r);
  }
  return rays;
}

std::string chebyshev(int n, const std::string& x) {
  if (n == 2) return "(2*(" + x + ")^2-1)";
  if (n == 3) return "(4*(" + x + ")^3-3*(" + x + "))";
  if (n == 5) return "(16*(" + x + ")^5-20*(" + x + ")^3+5*(" + x + "))";
  for (const int factor : {5, 3, 2}) {
    if (n % factor == 0) return chebyshev(factor, chebyshev(n / factor, x));
  }
  return x;
}

std::string chmutov(int n) {
  return chebyshev(n, "x") + "+" + chebyshev(n, "y") + "+" + chebyshev(n, "z") + "+1";
}

const std::string expanded_chmutov8 =
    "128*x^8-256*x^6+160*x^4-32*x^2+128*y^8-256*y^6+160*y^4-32*y^2+128*z^8-256*z^6+160*z^4-32*z^2+4";

struct Named {
  std::string f;
  double half;  // of the bounds; 0: let them be proved
};

const std::map<std::string, Named>& formulas() {
  static const std::map<std::string, Named> table{
      {"sphere", {"x^2+y^2+z^2-1", 0}},
      {"torus", {"(x^2+y^2+z^2+0.9375)^2-4*(x^2+z^2)", 0}},
      {"sphere_squared", {"(x^2+y^2+z^2-1)^2", 0}},
      {"sphere_cubed", {"(x^2+y^2+z^2-1)^3", 0}},
      {"steiner", {"x^2*y^2+y^2*z^2+z^2*x^2-x*y*z", 1}},
      {"whitney", {"x^2-y^2*z", 1}},
      {"barth6", {"4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)-(1+2*p)*(x^2+y^2+z^2-1)^2", 1.75}},
      {"barth10",
       {"8*(x^2-p^4*y^2)*(y^2-p^4*z^2)*(z^2-p^4*x^2)*(x^4+y^4+z^4-2*x^2*y^2-2*x^2*z^2-2*y^2*z^2)"
        "+(3+5*p)*(x^2+y^2+z^2-1)^2*(x^2+y^2+z^2-(2-p))^2",
        1.5}},
      {"chmutov8", {chmutov(8), 1.125}},
      {"chmutov12", {chmutov(12), 1.125}},
      {"chmutov16", {chmutov(16), 1.125}},
      {"chmutov20", {chmutov(20), 1.125}},
      {"klein", {"(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2)+16*x*z*(x^2+y^2+z^2-2*y-1)", 4}},
      {"clebsch",
       {"81*(x^3+y^3+z^3)-189*(x^2*(y+z)+y^2*(x+z)+z^2*(x+y))+54*x*y*z+126*(x*y+x*z+y*z)-9*(x^2+y^2+z^2)"
        "-9*(x+y+z)+1",
        2}},
      {"gyroid", {"sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)", 6}},
      {"bulb",
       {"sqrt(((x^2+y^2+z^2)^4*sin(8*acos(z/sqrt(x^2+y^2+z^2)))*cos(8*atan2(y,x))+x)^2"
        "+((x^2+y^2+z^2)^4*sin(8*acos(z/sqrt(x^2+y^2+z^2)))*sin(8*atan2(y,x))+y)^2"
        "+((x^2+y^2+z^2)^4*cos(8*acos(z/sqrt(x^2+y^2+z^2)))+z)^2)-1.2",
        1.25}},
      {"pole", {"y-0.3/x+0.2*z^2", 2}}};
  return table;
}

Shape implicit_shape(const std::string& text, double half, RootFinder finder) {
  ImplicitOptions options;
  options.finder = finder;
  const double phi = 0.5 * (1.0 + std::sqrt(5.0));
  const auto parsed = Expression::parse(text, {"x", "y", "z", "t", "p"});
  const auto f = std::make_shared<const ImplicitFormula>(
      std::get<Expression>(parsed).bind(ImplicitFormula::variables, std::vector<double>{phi}));
  if (half > 0.0) return implicit(f, Vec3{-half}, Vec3{half}, options);
  const auto bounds = prove_bounds(*f);
  EXPECT_TRUE(bounds.has_value()) << text;
  return bounds ? implicit(f, bounds->low, bounds->high, options) : sphere(1.0);
}

// The same surface by every method that there is for it.
std::vector<std::pair<std::string, Shape>> methods_for(const std::string& surface) {
  if (surface.rfind("shell", 0) == 0) {
    const std::string d = "1e-" + surface.substr(5);
    SolidTree tree;
    tree.operation = SolidOperation::difference;
    tree.parts = {{sphere(1.0 + std::stod(d)), Placement{}, SolidOperation::unite, {}, 0},
                  {sphere(1.0 - std::stod(d)), Placement{}, SolidOperation::unite, {}, 0}};
    const std::string formula = "abs(sqrt(x^2+y^2+z^2)-1)-" + d;
    return {{"solid", csg(tree)},
            {"intervals", implicit_shape(formula, 0, RootFinder::interval)},
            {"affine forms", implicit_shape(formula, 0, RootFinder::affine)}};
  }
  const Named& named = formulas().at(surface);
  std::vector<std::pair<std::string, Shape>> all;
  if (surface == "sphere") all.emplace_back("closed form", sphere(1.0));
  if (surface == "torus") all.emplace_back("closed form", torus(1.0, 0.25));
  all.emplace_back("intervals", implicit_shape(named.f, named.half, RootFinder::interval));
  all.emplace_back("affine forms", implicit_shape(named.f, named.half, RootFinder::affine));
  if (all.back().second.formula->program().degree()) {
    all.emplace_back("polynomials", implicit_shape(named.f, named.half, RootFinder::polynomial));
  }
  if (surface == "chmutov8") {
    all.emplace_back("expanded, polynomials",
                     implicit_shape(expanded_chmutov8, named.half, RootFinder::polynomial));
    all.emplace_back("expanded, intervals",
                     implicit_shape(expanded_chmutov8, named.half, RootFinder::interval));
    all.emplace_back("expanded, affine forms",
                     implicit_shape(expanded_chmutov8, named.half, RootFinder::affine));
  }
  return all;
}

// What double precision cannot decide: the surface moved by some rounding errors of its coordinates, or (for
// a formula) of the terms of its formula, gives the other answer.
constexpr double undecided = 1e-13;

void judge(const Ray& ray, const SurfaceSet& set, Count& count) {
  const Hit hit = set.nearest(ray.origin, ray.direction);
  const double size = set.bounds(0).radius;
  ++count.rays;
  count.hits += hit.found() ? 1 : 0;
  count.unresolved += hit.unresolved ? 1 : 0;
  const bool close = ray.margin < undecided * size;
  if (hit.found() != ray.hit) {
    if (close) {
      ++count.within_rounding;
    } else {
      ++(ray.hit ? count.missed : count.invented);
    }
    return;
  }
  if (!hit.found()) return;
  const SurfacePoint point = set.resolve(hit, ray.origin, ray.direction);
  Vec3 off{0.0};
  for (int i = 0; i < 3; ++i) {
    off[i] = static_cast<double>(Quad(point.position[i]) -
                                 (Quad(ray.origin[i]) + ray.exact_lambda * Quad(ray.direction[i])));
  }
  const double across = glm::length(off) * std::abs(glm::dot(point.normal, ray.direction));
  if (across > 1e-6 * size) {
    // Another root than the first one: it was missed, or one was invented before it.
    if (close || hit.unresolved) {
      ++count.within_rounding;
    } else {
      ++(hit.lambda > ray.lambda ? count.missed : count.invented);
    }
    return;
  }
  if (!hit.unresolved && !close) count.worst = std::max(count.worst, across / size);
}

const Table& measured() {
  static const Table table = [] {
    std::map<std::string, Count> result;
    std::map<std::string, std::vector<std::pair<std::string, SurfaceSet>>> sets;
    for (const Ray& ray : all_rays()) {
      auto [there, added] = sets.try_emplace(ray.surface);
      if (added) {
        for (auto& [method, shape] : methods_for(ray.surface)) {
          SurfaceSet set;
          set.add(shape, Placement{});
          set.build();
          there->second.emplace_back(method, std::move(set));
        }
      }
      for (const auto& [method, set] : there->second) {
        judge(ray, set, result[ray.suite + " | " + ray.surface + " | " + method]);
      }
    }
    return Table(result.begin(), result.end());
  }();
  return table;
}

TEST(Stability, NoRootIsMissedAndNoneInvented) {
  int rays = 0;
  for (const auto& [name, c] : measured()) {
    EXPECT_EQ(c.missed, 0) << name;
    EXPECT_EQ(c.invented, 0) << name;
    rays += c.rays;
  }
  EXPECT_GT(rays, 1000);
}

TEST(Stability, ResolvedHitsAreOnTheSurface) {
  for (const auto& [name, c] : measured()) EXPECT_LE(c.worst, 1e-11) << name;
}

TEST(Stability, PageShowsWhatWasMeasured) {
  expect_on_page("table", "suite | surface | method", measured());
}

}  // namespace
}  // namespace backlight::test
