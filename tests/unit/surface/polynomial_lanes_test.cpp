// First roots of polynomials over lanes: those that they were made of, and the same bits for every width.
#include "../../../src/surface/surface_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "backlight/base/instruction_sets.h"

namespace backlight {
namespace {

constexpr std::size_t count = LinePolynomials::most;

struct Made {
  PolynomialQuestions questions;
  std::vector<std::vector<double>> roots{count};  ///< real ones in [-1, 1], in order
};

/// Products of (ε - r) and of pairs without real roots.
Made products(int degree, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-1.6, 1.6);
  Made made;
  made.questions.polynomials.degree = degree;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<long double> c{1.0L};
    const auto times = [&](const std::vector<long double>& factor) {
      std::vector<long double> product(c.size() + factor.size() - 1, 0.0L);
      for (std::size_t a = 0; a < c.size(); ++a) {
        for (std::size_t b = 0; b < factor.size(); ++b) product[a + b] += c[a] * factor[b];
      }
      c = product;
    };
    while (static_cast<int>(c.size()) <= degree) {
      const double a = place(generator);
      if (static_cast<int>(c.size()) < degree && generator() % 2 == 0) {
        times({static_cast<long double>(a) * a + 0.01L, -2.0L * a, 1.0L});
      } else {
        times({-static_cast<long double>(a), 1.0L});
        if (std::abs(a) <= 1.0) made.roots[i].push_back(a);
      }
    }
    std::sort(made.roots[i].begin(), made.roots[i].end());
    double size = 0.0;
    for (int k = 0; k <= degree; ++k) {
      const auto at = static_cast<std::size_t>(k);
      made.questions.polynomials.coefficient[k][i] = static_cast<double>(c[at]);
      size += std::abs(static_cast<double>(c[at]));
    }
    made.questions.polynomials.error[i] = 1e-15 * size;
    made.questions.polynomials.half[i] = 1.0;
  }
  return made;
}

class PolynomialRoots : public testing::TestWithParam<int> {};

TEST_P(PolynomialRoots, AreTheFirstOnes) {
  int found = 0, none = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Made made = products(GetParam(), seed);
    auto q = std::make_unique<PolynomialQuestions>(made.questions);
    const PolynomialKernels kernels = baseline_surface_kernels().polynomials(GetParam());
    kernels.find_signs(*q, count);
    auto exists = std::make_unique<PolynomialQuestions>(*q);
    kernels.find_roots(*q, count, false);
    kernels.find_roots(*exists, count, true);
    for (std::size_t i = 0; i < count; ++i) {
      const std::vector<double>& roots = made.roots[i];
      // Roots that all but coincide may be left undecided.
      const bool close = roots.size() > 1 && roots[1] - roots[0] < 1e-3;
      if (q->verdict[i] == PolynomialQuestions::undecided) {
        EXPECT_TRUE(close || (!roots.empty() && roots[0] < -1.0 + 1e-6)) << seed << " " << i;
        continue;
      }
      ASSERT_EQ(q->verdict[i] == PolynomialQuestions::crossing, !roots.empty()) << seed << " " << i;
      if (exists->verdict[i] != PolynomialQuestions::undecided) {
        EXPECT_EQ(exists->verdict[i], q->verdict[i]) << seed << " " << i;
      }
      EXPECT_LE(exists->pieces[i], q->pieces[i]);
      ++(roots.empty() ? none : found);
      if (roots.empty()) continue;
      EXPECT_LE(q->low[i], roots[0]);
      EXPECT_GE(q->high[i], roots[0]);
      if (close) continue;
      if (roots.size() > 1) {
        EXPECT_LE(q->high[i], roots[1]);
      }
      // Twelve roots in such a room are as badly conditioned as that.
      EXPECT_NEAR(q->at[i], roots[0], GetParam() > 8 ? 1e-6 : 1e-8) << seed << " " << i;
    }
  }
  EXPECT_GT(found, 300);
  EXPECT_GT(none, 50);
}

TEST_P(PolynomialRoots, HaveTheSameBitsForEveryWidth) {
#if defined(__x86_64__)
  if (!has_avx2()) GTEST_SKIP() << "this processor has no AVX2";
  Made made = products(GetParam(), 77);
  auto narrow = std::make_unique<PolynomialQuestions>(made.questions);
  const PolynomialKernels two = baseline_surface_kernels().polynomials(GetParam());
  two.find_signs(*narrow, count);
  two.find_roots(*narrow, count, false);
  const auto expect_same = [&](const PolynomialKernels& kernels) {
    auto wide = std::make_unique<PolynomialQuestions>(made.questions);
    kernels.find_signs(*wide, count);
    kernels.find_roots(*wide, count, false);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(wide->sign[i], narrow->sign[i]) << i;
      EXPECT_EQ(wide->verdict[i], narrow->verdict[i]) << i;
      EXPECT_EQ(wide->low[i], narrow->low[i]) << i;
      EXPECT_EQ(wide->high[i], narrow->high[i]) << i;
      EXPECT_EQ(wide->at[i], narrow->at[i]) << i;
      EXPECT_EQ(wide->bend[i], narrow->bend[i]) << i;
      EXPECT_EQ(wide->pieces[i], narrow->pieces[i]) << i;
    }
  };
  expect_same(avx2_surface_kernels().polynomials(GetParam()));
  if (has_good_avx512()) expect_same(avx512_surface_kernels().polynomials(GetParam()));
#endif
}

INSTANTIATE_TEST_SUITE_P(Degrees, PolynomialRoots, testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 10, 12));

TEST(PolynomialRoots, OfADoubleRootAreUndecided) {
  auto q = std::make_unique<PolynomialQuestions>();
  q->polynomials.degree = 2;  // (ε - 1/4)²
  for (std::size_t i = 0; i < 8; ++i) {
    q->polynomials.coefficient[0][i] = 0.0625;
    q->polynomials.coefficient[1][i] = -0.5;
    q->polynomials.coefficient[2][i] = 1.0;
    q->polynomials.error[i] = 1e-16;
    q->polynomials.half[i] = 1.0;
  }
  const PolynomialKernels kernels = baseline_surface_kernels().polynomials(2);
  kernels.find_signs(*q, 8);
  EXPECT_EQ(q->sign[0], 1.0);
  kernels.find_roots(*q, 8, false);
  EXPECT_EQ(q->verdict[0], PolynomialQuestions::undecided);
}

// Where not even the formula itself is certain of the sign in front, nothing is found out.
TEST(PolynomialRoots, OfALineWithoutASignAreUndecided) {
  Made made = products(4, 1);
  auto& q = made.questions;
  std::fill_n(q.sign, count, 0.0);
  baseline_surface_kernels().polynomials(4).find_roots(q, count, false);
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(q.verdict[i], PolynomialQuestions::undecided);
}

}  // namespace
}  // namespace backlight
