// The cell alone: images, edges, flow, and what is refused.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "dem/random/random.h"
#include "dem/space/moving_cell.h"
#include "dem/space/space3.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

template <int D>
using Matrix = typename Cell<D>::Matrix;

/// Periodic along all D axes, up to strongly sheared.
template <int D>
Cell<3> random_cell(Random& random, double slant) {
  Cell<3> cell;
  for (int a = 0; a < D; ++a) {
    cell.periodic[a] = true;
    cell.low[a] = random.uniform(-3, 3);
    for (int b = 0; b < D; ++b) cell.edges(a, b) = random.uniform(-0.2, 0.2);
    cell.edges(a, a) = random.uniform(1, 3);
  }
  for (int a = 0; a < D; ++a) {
    const int b = (a + 1) % D;
    cell.edges.col(a) += std::round(random.uniform(-slant, slant)) * cell.edges.col(b);
  }
  return cell;
}

template <int D>
VectorOf<D> random_place(Random& random, double size) {
  VectorOf<D> x;
  for (int a = 0; a < D; ++a) x[a] = random.uniform(-size, size);
  return x;
}

/// Least |way + edges n| over all images, and over all but way itself when it is 0.
template <int D>
double least_distance(const Matrix<D>& edges, const VectorOf<D>& way, int most) {
  double least = std::numeric_limits<double>::infinity();
  const int count = 2 * most + 1;
  for (int k = 0; k < (D == 2 ? count * count : count * count * count); ++k) {
    VectorOf<D> n;
    int rest = k;
    for (int a = 0; a < D; ++a, rest /= count) n[a] = rest % count - most;
    const double distance = (way + edges * n).norm();
    if (distance > 0) least = std::min(least, distance);
  }
  return least;
}

template <int D>
void expect_images(std::uint64_t seed) {
  Random random(seed);
  for (int trial = 0; trial < 200; ++trial) {
    const double slant = trial % 3 == 0 ? 0 : 4;
    const Cell<3> given = random_cell<D>(random, slant);
    if (std::fabs(given.edges.template topLeftCorner<D, D>().determinant()) < 0.3) continue;
    check_cell(given, D, 1e-5);
    const MovingCell<D> cell(given, 1e-5);
    // The same lattice: whole numbers there and back.
    const Matrix<D> change =
        Matrix<D>(given.edges.template topLeftCorner<D, D>()).inverse() * cell.edges();
    for (int k = 0; k < D * D; ++k) {
      EXPECT_NEAR(change.data()[k], std::round(change.data()[k]), 1e-9);
    }
    EXPECT_NEAR(std::fabs(change.determinant()), 1, 1e-9);
    EXPECT_NEAR(cell.shortest(), least_distance<D>(cell.edges(), VectorOf<D>::Zero(), 5), 1e-12);
    for (int probe = 0; probe < 20; ++probe) {
      const VectorOf<D> x = random_place<D>(random, 10), y = random_place<D>(random, 10);
      const VectorOf<D> s = Matrix<D>(cell.edges()).inverse() *
                            (x - cell.shift(cell.home(x)) - given.low.template head<D>());
      for (int a = 0; a < D; ++a) {
        EXPECT_GE(s[a], -1e-12);
        EXPECT_LE(s[a], 1 + 1e-12);
      }
      const VectorOf<D> in_x = x - cell.shift(cell.home(x)), in_y = y - cell.shift(cell.home(y));
      const double least = least_distance<D>(cell.edges(), in_y - in_x, 5);
      if (least < 0.499 * cell.shortest()) {
        const PairImage n = cell.nearest(in_x, in_y);
        EXPECT_NEAR((in_y + cell.shift(n) - in_x).norm(), least, 1e-12);
      }
    }
  }
}

TEST(Cell, ImagesInThePlane) { expect_images<2>(1); }
TEST(Cell, ImagesInSpace) { expect_images<3>(2); }

TEST(Cell, SimpleShearTurnsOverAtHalfATilt) {
  for (const double width : {1.0, 10.0}) {
    Cell<3> given;
    given.periodic = {true, true, false};
    given.edges.col(0) = Eigen::Vector3d(width, 0, 0);
    given.edges.col(1) = Eigen::Vector3d(0.49 * width, 1, 0);
    EXPECT_NEAR(MovingCell<2>(given, 1).edges()(0, 1), 0.49 * width, 1e-15);
    given.edges.col(1) = Eigen::Vector3d(0.51 * width, 1, 0);
    EXPECT_NEAR(MovingCell<2>(given, 1).edges()(0, 1), -0.49 * width, 1e-14);
    given.edges.col(1) = Eigen::Vector3d(7.3 * width, 1, 0);
    EXPECT_NEAR(MovingCell<2>(given, 1).edges()(0, 1), 0.3 * width, 1e-13);
  }
}

/// Error of the edges after t = 1 against exp(L) edges.
double edge_error(const Eigen::Matrix3d& gradient, int steps) {
  Cell<3> given;
  given.periodic = {true, true, true};
  given.edges << 2, 0.3, 0.1, 0, 1.5, -0.2, 0, 0, 1;
  given.velocity_gradient = gradient;
  check_cell(given, 3, 1.0 / steps);
  MovingCell<3> cell(given, 1.0 / steps);
  for (int s = 0; s < steps; ++s) cell.advance();
  cell.finish();
  // Eigen's exponential is not among the supported modules: squares of a Taylor series.
  Eigen::Matrix3d part = gradient / 1024, power = Eigen::Matrix3d::Identity(),
                  exact = Eigen::Matrix3d::Identity();
  for (int k = 1; k < 12; ++k) {
    power = power * part / k;
    exact += power;
  }
  for (int k = 0; k < 10; ++k) exact = (exact * exact).eval();
  const Eigen::Matrix3d flow = cell.change_of_flow(gradient, Eigen::Vector3d(1, 1, 1)).asDiagonal();
  EXPECT_LT(flow.norm(), 100.0 / steps);
  return (Eigen::Matrix3d(cell.edges()) - exact * given.edges).norm();
}

TEST(Cell, EdgesFollowTheFlow) {
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(0, 1) = 0.4;
  shear(0, 2) = -0.2;
  EXPECT_LT(edge_error(shear, 100), 1e-13);
  Eigen::Matrix3d other;
  other << -0.3, 0.2, 0, 0.1, -0.4, 0.1, 0, -0.2, 0.25;
  double before = edge_error(other, 100);
  for (const int steps : {200, 400, 800}) {
    const double error = edge_error(other, steps);
    EXPECT_NEAR(std::log2(before / error), 2, 0.1);
    before = error;
  }
}

std::string refusal(const Cell<3>& cell, int dim) {
  return refusal_of([&] { check_cell(cell, dim, 1e-3); });
}

TEST(Cell, RefusesWhatIsNone) {
  Cell<3> cell;
  EXPECT_EQ(refusal(cell, 2), "accepted");
  cell.velocity_gradient(0, 1) = 1;
  EXPECT_EQ(refusal(cell, 2),
            "cell.velocity_gradient: found one, allowed where some axis is periodic");
  cell.periodic = {true, true, false};
  cell.edges.col(0) = Eigen::Vector3d(1, 0, 0);
  cell.edges.col(1) = Eigen::Vector3d(2, 1, 0);
  EXPECT_EQ(refusal(cell, 2), "accepted");
  EXPECT_EQ(refusal(cell, 3), "accepted");
  cell.velocity_gradient(0, 1) = 11;
  EXPECT_EQ(refusal(cell, 2),
            "cell.velocity_gradient: found 11 1/s, allowed: at most 10 1/s at a time step of 0.001 "
            "s");
  cell.velocity_gradient = Cell<3>::Matrix::Zero();
  cell.velocity_gradient(2, 1) = 1;
  EXPECT_THAT(refusal(cell, 3), StartsWith("cell.velocity_gradient: found a flow that goes"));
  EXPECT_THAT(refusal(cell, 2), StartsWith("cell.velocity_gradient: found a flow that goes"));
  cell.velocity_gradient = Cell<3>::Matrix::Zero();
  cell.edges.col(1) = Eigen::Vector3d(2, 0, 0);
  EXPECT_THAT(refusal(cell, 2), HasSubstr("cell.edges: found (1, 0, 0), (2, 0, 0) m, allowed"));
  cell.edges.col(1).setZero();
  EXPECT_THAT(refusal(cell, 2), HasSubstr("that are not 0"));
  cell.edges.col(1) = Eigen::Vector3d(0, 1, 0.5);
  EXPECT_THAT(refusal(cell, 2), HasSubstr("in two dimensions: no third component"));
  EXPECT_EQ(refusal(cell, 3), "accepted");
  cell.edges(1, 1) = std::nan("");
  EXPECT_THAT(refusal(cell, 3), HasSubstr("not a finite number"));
  cell.edges(1, 1) = 1;
  cell.periodic[2] = true;
  EXPECT_THAT(refusal(cell, 2), StartsWith("cell.periodic: found the third axis"));
}

}  // namespace
}  // namespace grainfield::dem
