#include "sigmoid_fit.h"

#include <array>

#include "rec709.h"

namespace backlight {
namespace sigmoid {
namespace {

constexpr double centre_nm = 595.0;
constexpr double half_width_nm = 235.0;

// s(x) reaches 0 and 1 to the last bit here, while x^2 does not overflow.
constexpr double saturation = 1e150;

struct Sample {
  double t;
  Vec3 weight;  // of a reflectance under D65, in the film's red, green, blue
};

std::array<Sample, cie::sample_count> make_samples() {
  std::array<Sample, cie::sample_count> samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double nm = cie::first_nm + static_cast<double>(i);
    const auto& w = rec709::film_weights[i];
    samples[i] = {(nm - centre_nm) / half_width_nm, cie::d65_in_table(nm) * Vec3{w[0], w[1], w[2]}};
  }
  return samples;
}

using Samples = std::array<Sample, cie::sample_count>;

Vec3 colour_of(const Samples& samples, const Coefficients& k) {
  Vec3 sum{0.0};
  for (const Sample& s : samples) {
    const double x = (k.a * s.t + k.b) * s.t + k.c;
    sum += s.weight * (0.5 + 0.5 * x / std::sqrt(1.0 + x * x));
  }
  return sum;
}

// Columns: the colour's derivatives by a, b, c.
Mat3 jacobian_of(const Samples& samples, const Coefficients& k) {
  Mat3 jacobian{0.0};
  for (const Sample& s : samples) {
    const double x = (k.a * s.t + k.b) * s.t + k.c;
    const double q = 1.0 + x * x;
    const Vec3 slope = s.weight * (0.5 / (q * std::sqrt(q)));
    jacobian[0] += slope * (s.t * s.t);
    jacobian[1] += slope * s.t;
    jacobian[2] += slope;
  }
  return jacobian;
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Gauss-Newton with Marquardt's damping: far from the solution the step shrinks towards steepest descent.
Coefficients damped_gauss_newton(const Samples& samples, Coefficients k, const Vec3& target, int max_steps) {
  const double goal = 1e-10 * largest(target);
  Vec3 residual = colour_of(samples, k) - target;
  double damping = 1e-4;
  for (int step = 0; step < max_steps && largest(residual) > goal && damping < 1e12;) {
    const Mat3 jacobian = jacobian_of(samples, k);
    const Mat3 normal = glm::transpose(jacobian) * jacobian;
    const Vec3 gradient = glm::transpose(jacobian) * residual;
    for (; step < max_steps && damping < 1e12; damping *= 4.0) {
      ++step;
      Mat3 damped = normal;
      for (int i = 0; i < 3; ++i) damped[i][i] *= 1.0 + damping;
      const Vec3 delta = glm::inverse(damped) * gradient;
      const Coefficients trial{k.a - delta.x, k.b - delta.y, k.c - delta.z};
      const Vec3 trial_residual = colour_of(samples, trial) - target;
      if (glm::dot(trial_residual, trial_residual) < glm::dot(residual, residual)) {
        k = trial;
        residual = trial_residual;
        damping *= 0.1;
        break;
      }
    }
  }
  return k;
}

double grey_coefficient(double value) {
  if (value <= 0.0) return -saturation;
  if (value >= 1.0) return saturation;
  return std::clamp((value - 0.5) / std::sqrt(value * (1.0 - value)), -saturation, saturation);
}

}  // namespace

Share share_of(const LinearRgb& rgb) {
  const double most = std::max({rgb.x, rgb.y, rgb.z});
  const double least = std::min({rgb.x, rgb.y, rgb.z});
  // 1 - s(x) = s(-x): a light colour is the complement of a dark one.
  Share share{rgb, 1.0, most + least > 1.0};
  if (share.complement) share.rgb = Vec3{1.0} - rgb;
  // The sigmoid of a dark colour may rise to 1 where the eye hardly notices, and be seen there after a shift.
  const double largest = share.complement ? 1.0 - least : most;
  if (largest < 0.5) {
    share.gain = 2.0 * largest;
    share.rgb = share.rgb / share.gain;
  }
  return share;
}

SigmoidReflectance reflectance_of(const Share& share, const Coefficients& coefficients) {
  Coefficients k = coefficients;
  if (share.complement) k = {-k.a, -k.b, -k.c};
  const double centre = centre_nm / half_width_nm;
  const double half = 0.5 * share.gain;
  return {k.a / (half_width_nm * half_width_nm), (k.b - 2.0 * centre * k.a) / half_width_nm,
          (k.a * centre - k.b) * centre + k.c, share.complement ? 1.0 - half : half, half};
}

LinearRgb colour_of(const Coefficients& coefficients) {
  return colour_of(make_samples(), coefficients);
}

Coefficients refine(Coefficients start, const LinearRgb& rgb) {
  return damped_gauss_newton(make_samples(), start, rgb, 200);
}

Coefficients fit(const LinearRgb& rgb) {
  const double most = std::max({rgb.x, rgb.y, rgb.z});
  const double least = std::min({rgb.x, rgb.y, rgb.z});
  const Samples samples = make_samples();
  const double grey = 0.5 * (most + least);
  Coefficients k{0.0, 0.0, grey_coefficient(grey)};
  constexpr int legs = 8;
  for (int leg = 1; leg <= legs; ++leg) {
    const double along = static_cast<double>(leg) / legs;
    k = damped_gauss_newton(samples, k, Vec3{grey} + along * (rgb - Vec3{grey}), leg == legs ? 200 : 20);
  }
  return k;
}

}  // namespace sigmoid

SigmoidReflectance grey_sigmoid(double value) {
  return {0.0, 0.0, sigmoid::grey_coefficient(std::clamp(value, 0.0, 1.0))};
}

SigmoidReflectance fit_sigmoid(const LinearRgb& rgb) {
  const LinearRgb possible = glm::clamp(rgb, 0.0, 1.0);
  if (possible.x == possible.y && possible.y == possible.z) return grey_sigmoid(possible.x);
  const sigmoid::Share share = sigmoid::share_of(possible);
  return sigmoid::reflectance_of(share, sigmoid::fit(share.rgb));
}

LinearRgb reflected_colour(const SigmoidReflectance& reflectance) {
  Vec3 sum{0.0};
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const double nm = cie::first_nm + static_cast<double>(i);
    const auto& w = rec709::film_weights[i];
    sum += (reflectance.at(nm) * cie::d65_in_table(nm)) * Vec3{w[0], w[1], w[2]};
  }
  return sum;
}

}  // namespace backlight
