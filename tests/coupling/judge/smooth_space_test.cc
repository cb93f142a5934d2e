// Models in space seen through kernels.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "continuum/model.h"
#include "coupling/compare/smooth.h"

namespace grainfield::coupling {
namespace {

Eigen::MatrixXd boussinesq(const Eigen::MatrixXd& points) {
  static const auto model = continuum::make_model("boussinesq", {{"F", "1"}});
  return model->stress(points);
}

TEST(SmoothSpace, LeavesALinearFieldAsItIs) {
  const StressFunction linear = [](const Eigen::MatrixXd& p) -> Eigen::MatrixXd {
    Eigen::MatrixXd s(p.rows(), 6);
    s << p, 2 * p.col(0) - p.col(2), p.col(1) + p.col(2), 3 * p.col(2);
    return s;
  };
  const Eigen::MatrixXd points = Eigen::RowVector3d(0.3, -0.2, -0.5);
  for (const char* name : {"lucy", "gaussian", "heaviside"})
    EXPECT_TRUE(nodes_in_space(points, *make_kernel(name, 0.05, 3), 1)
                    .of(linear)
                    .isApprox(linear(points), 1e-12))
        << name;
}

// A fine grid of places under the kernel is the reference, far from the load and around it.
TEST(SmoothSpace, IsTheConvolutionAlsoAroundTheLoad) {
  const auto k = make_kernel("lucy", 0.1, 3);
  Eigen::MatrixXd points(4, 3);
  points << 0.2, 0.1, -1.0, 0.0, 0.0, -0.35, 0.1, 0.1, -0.22, 0.05, 0.02, -0.12;
  const Eigen::MatrixXd smooth = nodes_in_space(points, *k, 0).of(boussinesq);
  const int n = 120;
  const double step = 2 * k->range() / n;
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(6);
    for (int i = 0; i < n; ++i) {
      Eigen::MatrixXd slice(n * n, 3);
      for (int j = 0; j < n * n; ++j)
        slice.row(j) =
            points.row(p) +
            step * Eigen::RowVector3d(i - (n - 1) / 2., j % n - (n - 1) / 2., j / n - (n - 1) / 2.);
      const Eigen::MatrixXd value = boussinesq(slice);
      for (int j = 0; j < n * n; ++j) {
        const double weight = k->value((slice.row(j) - points.row(p)).norm());
        if (slice(j, 2) < 0 && weight > 0) sum += weight * step * step * step * value.row(j);
      }
    }
    EXPECT_LT((smooth.row(p) - sum).norm(), 1e-2 * sum.norm()) << points.row(p);
  }
}

TEST(SmoothSpace, KeepsTheLoad) {
  const auto k = make_kernel("lucy", 0.1, 3);
  // Over rings: integral of 2 pi r sigma_zz at one depth, beyond r = 40 as Boussinesq's.
  const int n = 4000;
  const double depth = 0.15, step = 40.0 / n;
  Eigen::MatrixXd points(n, 3);
  for (int i = 0; i < n; ++i) points.row(i) << (i + 0.5) * step, 0, -depth;
  const Eigen::MatrixXd smooth = nodes_in_space(points, *k, 0, 4).of(boussinesq);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum -= 2 * std::acos(-1.0) * points(i, 0) * step * smooth(i, 2);
  EXPECT_NEAR(sum, 1, 5e-3);
}

TEST(SmoothSpace, RefusesThePlane) {
  EXPECT_THROW(nodes_in_space(Eigen::MatrixXd::Zero(1, 2), *make_kernel("lucy", 1, 3), 0),
               std::invalid_argument);
  EXPECT_THROW(nodes_in_space(Eigen::MatrixXd::Zero(1, 3), *make_kernel("lucy", 1), 0),
               std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::coupling
