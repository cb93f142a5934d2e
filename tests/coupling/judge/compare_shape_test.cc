// Shapes of profiles and smoothing of models.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "coupling/compare/shape.h"
#include "coupling/compare/smooth.h"
#include "tests/coupling/compare_scene.h"

namespace grainfield::coupling {
namespace {

using Eigen::VectorXd;

TEST(Shape, OfABell) {
  const VectorXd x = axis(401, 8);
  const ProfileShape s = profile_shape(x, bell(x, 0.5, 1.2, 3), {});
  EXPECT_NEAR(s.peak, 3, 1e-3);
  EXPECT_NEAR(s.peak_at, 0.5, 0.04);
  EXPECT_NEAR(s.fwhm, 2 * std::sqrt(2 * std::log(2.0)) * 1.2, 1e-3);
  EXPECT_NEAR(s.rms_width, 1.2, 1e-3);
  EXPECT_NEAR(s.integral, 3 * 1.2 * std::sqrt(2 * std::numbers::pi), 1e-6);
  EXPECT_EQ(s.peaks, 1);
}

TEST(Shape, OfAnOpenProfileHasNoWidth) {
  const VectorXd x = axis(41, 1);
  EXPECT_TRUE(std::isnan(profile_shape(x, bell(x, 0, 3, 1), {}).fwhm));
  EXPECT_EQ(profile_shape(x, VectorXd::Constant(41, -1.0), {}).peaks, 0);
}

// Ensembles of eight bells that differ in height, width and by smooth noise: what is estimated from
// one ensemble against the spread over 400 of them.
TEST(ShapeErrors, AreTheSpreadOfTheShape) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const VectorXd x = axis(81, 6);
  constexpr int ensembles = 400, realizations = 8;
  Eigen::Array4d sum = Eigen::Array4d::Zero(), squares = sum, estimated = sum;
  for (int e = 0; e < ensembles; ++e) {
    Eigen::MatrixXd samples(x.size(), realizations);
    VectorXd integrals(realizations);
    for (int r = 0; r < realizations; ++r) {
      const double height = 1 + 0.1 * normal(random), width = 1 + 0.1 * normal(random);
      samples.col(r) =
          bell(x, 0, width, height) + 0.02 * normal(random) * bell(x, normal(random), 0.7, 1);
      integrals[r] = profile_shape(x, samples.col(r), {}).integral;
    }
    const ProfileShape s = profile_shape(x, samples.rowwise().mean(), {});
    const ProfileShape error = shape_errors(x, samples);
    const Eigen::Array4d figures{s.peak, s.fwhm, s.rms_width, s.integral};
    sum += figures;
    squares += figures.square();
    estimated += Eigen::Array4d{error.peak, error.fwhm, error.rms_width, error.integral}.square();
    const double spread = std::sqrt((integrals.array() - integrals.mean()).square().sum() /
                                    (realizations * (realizations - 1.0)));
    EXPECT_NEAR(error.integral, spread, 1e-12);
    EXPECT_TRUE(std::isnan(error.peak_at));
  }
  const Eigen::Array4d variance = squares / ensembles - (sum / ensembles).square();
  const Eigen::Array4d ratio = (estimated / ensembles / variance).sqrt();
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(ratio[k], 1, 0.12) << k;
}

TEST(ShapeErrors, OfTooLittleAreUnknown) {
  const VectorXd x = axis(41, 3);
  EXPECT_TRUE(std::isnan(shape_errors(x, bell(x, 0, 1, 1)).peak));
  EXPECT_TRUE(std::isnan(shape_errors(x, {}).peak));
  Eigen::MatrixXd gaps(41, 2);
  gaps << bell(x, 0, 1, 1), bell(x, 0, 1, 1.2);
  EXPECT_NEAR(shape_errors(x, gaps).peak, 0.1, 1e-12);
  gaps.col(1).head(39).setConstant(NAN);
  EXPECT_TRUE(std::isnan(shape_errors(x, gaps).peak));
}

// Twenty noisy curves each: correlated noise whose size the errors state.
TEST(Shape, CountsOneAndTwoPeaksUnderNoise) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const VectorXd x = axis(161, 4);
  const double noise = 0.04;
  int one = 0, two = 0;
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd rough(161);
    for (double& v : rough) v = normal(random);
    VectorXd smooth = VectorXd::Zero(161);
    for (int k = 0; k < 161; ++k)
      for (int j = 0; j < 161; ++j)
        smooth[k] += rough[j] * std::exp(-(x[k] - x[j]) * (x[k] - x[j]) / (2 * 0.3 * 0.3));
    smooth *= noise / std::sqrt(smooth.squaredNorm() / 161);
    const VectorXd error = VectorXd::Constant(161, noise);
    one += profile_shape(x, bell(x, 0, 1, 1) + smooth, error).peaks == 1;
    two +=
        profile_shape(x, bell(x, -1.3, 0.6, 1) + bell(x, 1.3, 0.6, 0.9) + smooth, error).peaks == 2;
  }
  // 2 standard errors: about one false wiggle in twenty curves is expected; three are allowed.
  EXPECT_GE(one, 17);
  EXPECT_GE(two, 17);
}

TEST(Shape, ProminenceDecidesWhatAPeakIs) {
  VectorXd x = axis(7, 3), v(7), error = VectorXd::Constant(7, 0.01);
  v << 0, 1, 0.96, 1, 0.5, 0.52, 0;                // dips of 4 % and of 2 %
  EXPECT_EQ(profile_shape(x, v, error).peaks, 1);  // equal tops count as others do
  v << 0, 1, 0.96, 0.999, 0.5, 0.52, 0;
  EXPECT_EQ(profile_shape(x, v, error).peaks, 1);
  v << 0, 1, 0.9, 0.999, 0.5, 0.52, 0;
  EXPECT_EQ(profile_shape(x, v, error).peaks, 2);
  EXPECT_EQ(profile_shape(x, v, VectorXd::Constant(7, 0.06)).peaks, 1);  // below 2 standard errors
  v << 0, 1, 1, 1, 0.5, 0.4, 0;                                          // a plateau is one peak
  EXPECT_EQ(profile_shape(x, v, error).peaks, 1);
}

// Mirrored profiles have equal tops to the last bit: the dent between them decides, not round-off.
TEST(Shape, EqualTopsAreTwoPeaksOnlyWithADentBetween) {
  VectorXd v(7);
  for (const auto& [dent, peaks] : {std::pair{0.999, 1}, {0.96, 1}, {0.94, 2}, {0.5, 2}}) {
    v << 0, 0.5, 1, dent, 1, 0.5, 0;
    EXPECT_EQ(profile_shape(axis(7, 3), v, {}).peaks, peaks) << dent;
  }
}

TEST(Shape, Refuses) {
  EXPECT_EQ(refusal_of([] { profile_shape(axis(4, 1), VectorXd::Zero(3), {}); }),
            "a profile of 4 positions, 3 values and 0 errors");
  EXPECT_EQ(refusal_of([] { profile_shape(-axis(3, 1), VectorXd::Zero(3), {}); }),
            "a profile's positions must ascend; -0 m follows 1 m");
  EXPECT_EQ(refusal_of([] { profile_shape(axis(3, 1), VectorXd::Constant(3, NAN), {}); }),
            "a profile has 0 values; its shape needs at least 3");
}

Eigen::MatrixXd flamant(const Eigen::MatrixXd& p) {
  Eigen::MatrixXd s(p.rows(), 3);
  for (Eigen::Index k = 0; k < p.rows(); ++k) {
    const double x = p(k, 0), d = -p(k, 1), r2 = x * x + d * d;
    const double f = -2 / std::numbers::pi * d / (r2 * r2);
    s.row(k) << f * x * x, f * d * d, -f * d * x;
  }
  return s;
}

TEST(Smooth, LeavesALinearFieldAsItIs) {
  const StressFunction linear = [](const Eigen::MatrixXd& p) -> Eigen::MatrixXd {
    Eigen::MatrixXd s(p.rows(), 3);
    s << 2 * p.col(0) + p.col(1), p.col(1), p.col(0);
    return s;
  };
  Eigen::MatrixXd points(2, 2);
  points << 0.1, -0.5, -0.2, -0.4;
  for (const char* name : {"lucy", "gaussian", "heaviside"}) {
    const auto k = make_kernel(name, 0.05);
    EXPECT_TRUE(nodes_in_plane(points, *k, 1).of(linear).isApprox(linear(points), 1e-12)) << name;
    EXPECT_TRUE(nodes_along_x(points, *k).of(linear).isApprox(linear(points), 1e-12)) << name;
  }
}

// A fine grid of points under the kernel is the reference, far from the load and around it.
TEST(Smooth, IsTheConvolutionAlsoAroundTheLoad) {
  const auto k = make_kernel("lucy", 0.1);
  Eigen::MatrixXd points(4, 2);
  points << 0.2, -1.0, 0.0, -0.31, 0.05, -0.12, 0.1, -0.02;
  const Eigen::MatrixXd smooth = nodes_in_plane(points, *k, 0).of(flamant);
  const int n = 600;
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    double sum = 0;
    const double step = 2 * k->range() / n;
    for (int i = 0; i < n; ++i) {
      Eigen::MatrixXd column(n, 2);
      for (int j = 0; j < n; ++j)
        column.row(j) << points(p, 0) - k->range() + (i + 0.5) * step,
            points(p, 1) - k->range() + (j + 0.5) * step;
      const Eigen::MatrixXd value = flamant(column);
      for (int j = 0; j < n; ++j)
        if (column(j, 1) < 0)
          sum += k->value((column.row(j) - points.row(p)).norm()) * value(j, 1) * step * step;
    }
    EXPECT_NEAR(smooth(p, 1), sum, 3e-3 * std::abs(sum)) << points.row(p);
  }
}

TEST(Smooth, KeepsTheLoadOfAHalfPlane) {
  const auto k = make_kernel("gaussian", 0.1);
  const int n = 2001;
  Eigen::MatrixXd points(n, 2);
  points.col(0) = axis(n, 40);
  points.col(1).setConstant(-0.5);
  const double step = 80.0 / (n - 1);
  EXPECT_NEAR(-nodes_in_plane(points, *k, 0).of(flamant).col(1).sum() * step, 1, 1e-3);
  EXPECT_NEAR(-nodes_along_x(points, *k).of(flamant).col(1).sum() * step, 1, 1e-3);
}

}  // namespace
}  // namespace grainfield::coupling
