#include "backlight/colour/film_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "backlight/base/thread_memory.h"
#include "rec709.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// No cell is longer than that in the frame of a spectrum, so that two points follow what is smooth there.
constexpr double longest_cell_nm = 4.0;

// Gauss's rule of two points, on [0, 1]: exact for cubics, as the product of three straight lines is.
constexpr double gauss_points[2] = {0.21132486540518713, 0.78867513459481287};

LinearRgb as_rgb(const cie::Tristimulus& t) {
  return {t[0], t[1], t[2]};
}

LinearRgb film_weight(std::size_t cell, double fraction) {
  return (1.0 - fraction) * as_rgb(rec709::film_weights[cell]) +
         fraction * as_rgb(rec709::film_weights[cell + 1]);
}

// The knots of a spectrum, at the camera's wavelengths, in rising order.
class Knots {
 public:
  Knots(const Spectrum& spectrum, double shift) : left_(spectrum.knots()), shift_(shift) {}

  // The first beyond `nm`.
  double after(double nm) {
    if (!started_) {
      left_ = {std::upper_bound(left_.begin(), left_.end(), nm * shift_), left_.end()};
      started_ = true;
    }
    while (!left_.empty() && left_.front() / shift_ <= nm) left_ = left_.subspan(1);
    return left_.empty() ? infinity : left_.front() / shift_;
  }

 private:
  std::span<const double> left_;
  double shift_;
  bool started_ = false;
};

// A light as the camera has it, and what it goes through.
struct Product {
  const Spectrum& light;
  double shift;
  std::span<const Filter> filters;
};

// Points of integration and what the observer makes of each.
struct Work {
  std::vector<double> nm, in_source, value;
  std::vector<LinearRgb> weight;

  void clear() {
    nm.clear();
    weight.clear();
  }
  // `value`: of the spectrum at its own wavelengths.
  void evaluate(const Spectrum& spectrum, double shift) {
    in_source.resize(nm.size());
    value.resize(nm.size());
    for (std::size_t i = 0; i < nm.size(); ++i) in_source[i] = shift * nm[i];
    spectrum.evaluate_light(in_source.data(), static_cast<int>(nm.size()), value.data());
  }
};

// The points between `from` and `to`, which no observer's knot divides, `parts` of equal length.
void add_cell(std::size_t cell, double from, double to, int parts, Work& work) {
  const double width = (to - from) / parts;
  const double origin = cie::first_nm + static_cast<double>(cell);
  for (int part = 0; part < parts; ++part) {
    for (const double place : gauss_points) {
      const double nm = from + width * (part + place);
      work.nm.push_back(nm);
      work.weight.push_back(0.5 * width * film_weight(cell, nm - origin));
    }
  }
}

void add_points(const Product& p, double begin, double end, Work& work) {
  static constinit thread_local ThreadMemory<std::vector<Knots>> memory;
  std::vector<Knots>& knots = memory.get();
  knots.assign(1, Knots(p.light, p.shift));
  double greatest = p.shift;
  for (const Filter& filter : p.filters) {
    knots.emplace_back(*filter.spectrum, filter.shift);
    greatest = std::max(greatest, filter.shift);
  }
  const double longest = longest_cell_nm / std::max(greatest, longest_cell_nm);
  double from = std::max(begin, static_cast<double>(cie::first_nm));
  end = std::min(end, static_cast<double>(cie::last_nm));
  while (from < end) {
    const auto cell = static_cast<std::size_t>(from - cie::first_nm);
    const double next = cie::first_nm + static_cast<double>(cell) + 1.0;
    double to = std::min(next, end);
    for (Knots& of : knots) to = std::min(to, of.after(from));
    add_cell(cell, from, to, static_cast<int>(std::ceil((to - from) / longest)), work);
    from = to;
  }
}

// By how much the CIE's sum over 1 nm of a blackbody differs from its integral: by nothing that shows above
// 400 K. Its colour is defined by the sum, with which a constant table is to agree.
double sum_over_integral(const Product& p, const Work& work) {
  static constinit thread_local ThreadMemory<Work> memory;
  Work& samples = memory.get();
  samples.clear();
  double sum = 0.0, integral = 0.0;
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    samples.nm.push_back(cie::first_nm + static_cast<double>(i));
  }
  samples.evaluate(p.light, p.shift);
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    sum += samples.value[i] * luminance(as_rgb(rec709::film_weights[i]));
  }
  for (const LinearRgb& weight : work.weight) integral += luminance(weight);
  return integral > 0.0 ? sum / integral : 1.0;
}

// Into work.weight: the light, the observer and the length of the cell.
void weigh_by_light(const Product& p, Work& work) {
  work.evaluate(p.light, p.shift);
  for (std::size_t i = 0; i < work.nm.size(); ++i) work.weight[i] *= work.value[i];
  if (p.light.form().kind != SpectrumForm::Kind::blackbody) return;
  const double factor = sum_over_integral(p, work);
  for (LinearRgb& weight : work.weight) weight *= factor;
}

// The lines: ∫ w(λ) P δ(shift λ - λ0) dλ = w(λ0 / shift) P / shift.
void add_lines(const Spectrum& light, double shift, Work& work) {
  for (const Spectrum::Line& line : light.lines()) {
    const double nm = line.nm / shift;
    if (!(nm >= cie::first_nm && nm <= cie::last_nm)) continue;
    const auto cell =
        std::min(static_cast<std::size_t>(nm - cie::first_nm), std::size_t{cie::sample_count - 2});
    const double fraction = nm - (cie::first_nm + static_cast<double>(cell));
    work.nm.push_back(nm);
    work.weight.push_back(light.scale() * line.power / shift * film_weight(cell, fraction));
  }
}

void collect(const Product& p, Work& work) {
  work.clear();
  for (const Spectrum::Span& bright : p.light.bright()) {
    add_points(p, bright.begin / p.shift, bright.end / p.shift, work);
  }
  weigh_by_light(p, work);
  add_lines(p.light, p.shift, work);
}

}  // namespace

LinearRgb integrate_film(const Spectrum& light, double shift, const Spectrum* reflectance,
                         double reflectance_shift) {
  const Filter filter{reflectance, reflectance_shift};
  return integrate_film(light, shift, {&filter, reflectance == nullptr ? 0U : 1U});
}

LinearRgb integrate_film(const Spectrum& light, double shift, std::span<const Filter> filters) {
  static constinit thread_local ThreadMemory<Work> memory;
  Work& work = memory.get();
  collect({light, shift, filters}, work);
  for (const Filter& filter : filters) {
    work.evaluate(*filter.spectrum, filter.shift);
    if (filter.power != 1.0) {
      spectral_kernels(InstructionSet::widest)
          .raise(filter.power, static_cast<int>(work.nm.size()), work.value.data());
    }
    for (std::size_t i = 0; i < work.nm.size(); ++i) work.weight[i] *= work.value[i];
  }
  LinearRgb sum{0.0};
  for (const LinearRgb& weight : work.weight) sum += weight;
  return sum;
}

FilmQuadrature film_quadrature(const Spectrum& light) {
  Work work;
  collect({light, 1.0, {}}, work);
  return {std::move(work.nm), std::move(work.weight)};
}

}  // namespace backlight
