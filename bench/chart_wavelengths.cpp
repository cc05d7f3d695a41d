// How far colours are off by the number of wavelengths and the rule that weighs them, beside what a whole
// frame costs.
//   chart_wavelengths error|cost      CSV on stdout
//
// error: CIEDE2000 against the sum over the 471 samples of the observer's 1 nm table, over reflectances ×
// lamps × Doppler factors; the exposure makes a white surface in the same place Y = 1. cost: CPU seconds of a
// frame of scenes/fig7-tram-shadow.toml.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"
#include "support/measure.h"

namespace backlight::bench {
namespace {

// Wavelengths, and what a radiance of 1 at each alone adds to the film.
struct Rule {
  std::string name;
  std::vector<double> nm;
  std::vector<LinearRgb> weight;
};

// So that D65 is white, as every rule must have it.
void make_white(Rule& rule) {
  std::vector<double> d65(rule.nm.size());
  Spectrum::d65().evaluate(rule.nm.data(), int(rule.nm.size()), d65.data());
  LinearRgb white(0.0);
  for (std::size_t i = 0; i < d65.size(); ++i) white += d65[i] * rule.weight[i];
  for (LinearRgb& w : rule.weight) w /= white;
}

Rule from_nodes(const std::string& name, const std::vector<double>& nm, const std::vector<double>& width) {
  Rule rule{name, nm, {}};
  for (std::size_t i = 0; i < nm.size(); ++i)
    rule.weight.push_back(width[i] * rgb_from_xyz(colour_matching_functions(nm[i])));
  make_white(rule);
  return rule;
}

constexpr double range = visible_end_nm - visible_begin_nm;

Rule midpoints(int count) {
  std::vector<double> nm;
  for (int i = 0; i < count; ++i) nm.push_back(visible_begin_nm + range * (i + 0.5) / count);
  return from_nodes("midpoints", nm, std::vector<double>(nm.size(), 1.0));
}

Rule trapezia(int count) {
  std::vector<double> nm, width(std::size_t(count), 1.0);
  for (int i = 0; i < count; ++i) nm.push_back(visible_begin_nm + range * i / (count - 1));
  width.front() = width.back() = 0.5;
  return from_nodes("trapezia", nm, width);
}

// Gauss and Legendre: the roots by Newton's steps from Tricomi's first guess.
Rule gauss(int count) {
  std::vector<double> nm(static_cast<std::size_t>(count));
  std::vector<double> width = nm;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(M_PI * (count - i - 0.25) / (count + 0.5)), slope = 1.0;
    for (int step = 0; step < 60; ++step) {
      double p = 1.0, before = 0.0;
      for (int k = 0; k < count; ++k) {
        const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1.0);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    nm[std::size_t(i)] = visible_begin_nm + 0.5 * range * (x + 1.0);
    width[std::size_t(i)] = 2.0 / ((1.0 - x * x) * slope * slope);
  }
  return from_nodes("Gauss-Legendre", nm, width);
}

// Red, green and blue alone, at the wavelengths of the primaries: what a program that shifts three lines
// would show.
Rule three_lines() {
  return from_nodes("three lines", {464.0, 549.0, 611.0}, {1.0, 1.0, 1.0});
}

Rule exact() {
  std::vector<double> nm;
  for (int i = 0; i <= int(range); ++i) nm.push_back(visible_begin_nm + i);
  return from_nodes("table", nm, std::vector<double>(nm.size(), 1.0));
}

struct Light {
  Spectrum lamp;
  Spectrum reflectance;
  double doppler;
};

LinearRgb film_of(const Rule& rule, const Light& light, bool white) {
  // D = ω'/ω: what is seen at λ left at λ D; the brightness does not matter here.
  std::vector<double> nm = rule.nm, lamp(nm.size()), reflectance(nm.size(), 1.0);
  for (double& l : nm) l *= light.doppler;
  light.lamp.evaluate(nm.data(), int(nm.size()), lamp.data());
  if (!white) light.reflectance.evaluate(nm.data(), int(nm.size()), reflectance.data());
  LinearRgb sum(0.0);
  for (std::size_t i = 0; i < nm.size(); ++i) sum += lamp[i] * reflectance[i] * rule.weight[i];
  return sum;
}

// As the program does it: the lamp summed whole, the reflectance at `count` wavelengths, or more if it is
// steep.
LinearRgb own_film_of(int count, const Light& light) {
  const WavelengthSet& set = wavelength_set(count).for_steepness(steepness_of(light.reflectance));
  std::vector<double> nm(set.nm().begin(), set.nm().end()), reflectance(nm.size()), work(nm.size());
  for (double& l : nm) l *= light.doppler;
  light.reflectance.evaluate(nm.data(), set.size(), reflectance.data());
  const WavelengthSet::Sampled sampled{reflectance.data(), &light.reflectance, light.doppler};
  return set.film_under(light.lamp, light.doppler, &sampled, work.data(),
                        spectral_kernels(InstructionSet::widest));
}

std::vector<Light> lights() {
  std::mt19937 random(3);
  const auto uniform = [&random] { return double(random() >> 4) * 0x1p-28; };
  std::vector<Spectrum> lamps{Spectrum::d65()};
  for (const double kelvin : {2000.0, 3000.0, 5000.0, 10000.0}) lamps.push_back(Spectrum::blackbody(kelvin));
  std::vector<Spectrum> reflectances;
  for (int corner = 1; corner < 7; ++corner)
    reflectances.push_back(Spectrum::reflectance(LinearRgb(corner & 1, corner >> 1 & 1, corner >> 2)));
  for (int i = 0; i < 10; ++i)
    reflectances.push_back(Spectrum::reflectance(LinearRgb(uniform(), uniform(), uniform())));
  std::vector<Light> all;
  for (const Spectrum& lamp : lamps) {
    for (const Spectrum& reflectance : reflectances) {
      for (int i = 0; i < 24; ++i) all.push_back({lamp, reflectance, 0.3 * std::pow(3.0 / 0.3, i / 23.0)});
    }
  }
  return all;
}

template <class FilmOf>
void report(const std::string& name, std::size_t count, const std::vector<LinearRgb>& truth,
            const std::vector<double>& exposure, const FilmOf& film_of_light) {
  std::vector<double> errors;
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const LinearRgb got = exposure[i] * film_of_light(i);
    errors.push_back(delta_e_2000(lab_from_rgb(got), lab_from_rgb(truth[i])));
    sum += errors.back();
  }
  std::ranges::sort(errors);
  std::printf("%s,%zu,%.4g,%.4g,%.4g\n", name.c_str(), count, sum / double(errors.size()),
              errors[errors.size() * 99 / 100], errors.back());
  std::fflush(stdout);
}

void errors() {
  const std::vector<Light> all = lights();
  const Rule table = exact();
  std::vector<LinearRgb> truth;
  std::vector<double> exposure;
  for (const Light& light : all) {
    exposure.push_back(1.0 / luminance(film_of(table, light, true)));
    truth.push_back(exposure.back() * film_of(table, light, false));
  }
  std::puts("rule,wavelengths,mean,percentile99,worst");
  const auto report_rule = [&](const Rule& rule) {
    report(rule.name, rule.nm.size(), truth, exposure,
           [&](std::size_t i) { return film_of(rule, all[i], false); });
  };
  report_rule(three_lines());
  for (const int count : {8, 12, 16, 24, 32, 40, 48, 56, 64, 80, 96, 128}) {
    report("Backlight", std::size_t(count), truth, exposure,
           [&](std::size_t i) { return own_film_of(count, all[i]); });
    for (const auto& rule : {midpoints(count), trapezia(count), gauss(count)}) report_rule(rule);
  }
}

void cost(bool quick) {
  ImageRequest request;
  request.resolution = quick ? std::pair{36, 26} : std::pair{180, 132};
  request.samples = 1;
  const std::vector<int> counts{0, 8, 12, 16, 24, 32, 40, 48, 56, 64, 80, 96, 128};
  std::vector<Scene> scenes;
  for (const int count : counts) {
    request.wavelengths = count > 0 ? std::optional<int>(count) : std::nullopt;
    const std::vector<std::string> changes =
        count > 0 ? std::vector<std::string>{} : std::vector<std::string>{"effects.doppler=false"};
    scenes.push_back(load("scenes/fig7-tram-shadow.toml", changes, request));
  }
  std::vector<std::vector<double>> seconds(counts.size());
  for (int round = 0; round < (quick ? 2 : 6); ++round) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double start = cpu_seconds();
      render(scenes[i]);
      if (round > 0) seconds[i].push_back(cpu_seconds() - start);
    }
  }
  std::puts("wavelengths,cpu_seconds,times_rgb");
  for (std::size_t i = 0; i < counts.size(); ++i)
    std::printf("%d,%.5g,%.4g\n", counts[i], median(seconds[i]), median(seconds[i]) / median(seconds[0]));
}

}  // namespace
}  // namespace backlight::bench

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "error") {
    backlight::bench::errors();
  } else if (what == "cost") {
    backlight::bench::cost(argc > 2);
  } else {
    std::cerr << "chart_wavelengths error|cost [--quick]\n";
    return 2;
  }
}
