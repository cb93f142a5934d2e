// Kernels: unit integral, closed line integrals against quadrature, side view, names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "coupling/averaging/kernel.h"

namespace grainfield::coupling {
namespace {

using boost::math::quadrature::gauss_kronrod;
using Quadrature = gauss_kronrod<double, 61>;

class EveryKernel : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Names, EveryKernel, testing::ValuesIn(kernel_names()));

TEST_P(EveryKernel, IntegratesToOneInThePlane) {
  for (double width : {1e-3, 0.02, 3.0}) {
    const auto k = make_kernel(GetParam(), width);
    const double total = Quadrature::integrate(
        [&](double r) { return 2 * std::numbers::pi * r * k->value(r); }, 0.0, k->range(), 10);
    EXPECT_NEAR(total, 1, 1e-12) << width;
  }
}

TEST_P(EveryKernel, IsZeroBeyondItsRangeAndNeverNegative) {
  const auto k = make_kernel(GetParam(), 0.3);
  for (int i = 0; i <= 100; ++i) EXPECT_GE(k->value(k->range() * i / 100), 0);
  EXPECT_EQ(k->value(k->range() * (1 + 1e-12)), 0);
}

TEST_P(EveryKernel, SideViewIntegratesToOneAndHasTheStandardDeviation) {
  const auto k = make_kernel(GetParam(), 0.3);
  double total = 0, square = 0, plane = 0;
  const int n = 20000;  // midpoint rule; the square-root ends of heaviside converge as n^-1.5
  for (int i = 0; i < n; ++i) {
    const double x = k->range() * ((i + 0.5) / n * 2 - 1), m = k->marginal(x);
    total += m * 2 * k->range() / n;
    square += x * x * m * 2 * k->range() / n;
    const double r = k->range() * (i + 0.5) / n;  // half the mean of r^2 over the plane
    plane += std::numbers::pi * r * r * r * k->value(r) * k->range() / n;
  }
  EXPECT_NEAR(total, 1, 1e-5);
  EXPECT_NEAR(std::sqrt(square), std::sqrt(plane), 1e-5);
}

// Random segments, long and short, through the kernel and past it, with the closed forms against
// adaptive quadrature of the kernel's value split at the support's edge.
TEST_P(EveryKernel, BranchWeightIsTheLineIntegral) {
  const auto k = make_kernel(GetParam(), 0.7);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-3, 3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector2d p(uniform(random), uniform(random)), a(uniform(random), uniform(random));
    const double shrink = trial % 3 == 0 ? 1e-3 : 1;  // also branches much shorter than the kernel
    const Eigen::Vector2d b = a + shrink * Eigen::Vector2d(uniform(random), uniform(random));
    const Eigen::Vector2d l = b - a;
    const double foot = (p - a).dot(l) / l.squaredNorm();
    const double d2 = (a + foot * l - p).squaredNorm();
    const double inside = k->range() * k->range() - d2;
    double expected = 0;
    if (inside > 0) {
      const double half = std::sqrt(inside) / l.norm();
      const double t0 = std::clamp(foot - half, 0.0, 1.0), t1 = std::clamp(foot + half, 0.0, 1.0);
      const double middle = std::clamp(foot, t0, t1);
      const auto f = [&](double t) {
        return k->value(std::min(k->range() * (1 - 1e-15), (a + t * l - p).norm()));
      };
      if (middle > t0) expected += Quadrature::integrate(f, t0, middle, 10, 1e-13);
      if (t1 > middle) expected += Quadrature::integrate(f, middle, t1, 10, 1e-13);
    }
    EXPECT_NEAR(branch_weight(*k, p, a, b), expected, 1e-10 * k->value(0)) << "trial " << trial;
  }
}

TEST_P(EveryKernel, BranchThroughThePointAndBranchOfNoLength) {
  const auto k = make_kernel(GetParam(), 0.7);
  const Eigen::Vector2d p(0, 0), far(100, 0);
  EXPECT_NEAR(branch_weight(*k, p, -far, far) * 200, k->marginal(0), 1e-9 * k->value(0));
  EXPECT_DOUBLE_EQ(branch_weight(*k, p, p, p), k->value(0));
}

// The default of Kernel::along_line, which a new kernel has before it has a closed form.
class Quadratic : public Kernel {
 public:
  std::string name() const override { return "quadratic"; }
  double range() const override { return 1; }
  double value(double r) const override { return r < 1 ? 1 - r * r : 0; }
};

TEST(Kernel, DefaultLineIntegralIsExactForPolynomials) {
  const Quadratic k;
  const auto primitive = [](double d, double s) { return s * (1 - d * d) - s * s * s / 3; };
  EXPECT_NEAR(k.along_line(0.3, -0.5, 0.8), primitive(0.3, 0.8) - primitive(0.3, -0.5), 1e-14);
  EXPECT_NEAR(k.along_line(0.3, 0.1, 0.8), primitive(0.3, 0.8) - primitive(0.3, 0.1), 1e-14);
}

TEST(Kernel, IndependentLengthOfAGaussian) {
  // 2 sqrt(pi) standard deviations for the uncut one; the cut takes 1 % of the weight.
  const auto k = make_kernel("gaussian", 0.01);
  EXPECT_NEAR(k->independent_length(), 2 * std::sqrt(std::numbers::pi) * 0.01, 0.02 * 0.035);
}

TEST(Kernel, RefusesWhatItCannotMake) {
  const auto text = [](const std::string& name, double width) -> std::string {
    try {
      make_kernel(name, width);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(text("lucky", 1),
            "unknown kernel \"lucky\"; known: lucy, gaussian, heaviside; did you mean \"lucy\"?");
  EXPECT_EQ(text("lucy", 0), "kernel width is 0 m; it must be positive and finite");
  EXPECT_EQ(text("lucy", -2), "kernel width is -2 m; it must be positive and finite");
  EXPECT_EQ(text("lucy", std::nan("")), "kernel width is nan m; it must be positive and finite");
}

}  // namespace
}  // namespace grainfield::coupling
