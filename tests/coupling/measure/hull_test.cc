// Convex hulls of grains' centres and the strain that follows from them.
#include "coupling/strain/hull.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using ::testing::HasSubstr;

MatrixXd random_points(dem::Random& random, int n, double size = 1,
                       const Vector3d& at = {0, 0, 0}) {
  MatrixXd out(n, 3);
  for (int k = 0; k < n; ++k) {
    for (int a = 0; a < 3; ++a) out(k, a) = at[a] + size * random.uniform(-1, 1);
  }
  return out;
}

Matrix3d random_matrix(dem::Random& random) {
  Matrix3d out;
  for (double& x : out.reshaped()) x = random.uniform(-1, 1);
  return out;
}

// Sum over all triples with every other point on one side: a hull by definition, O(n^4).
double volume_by_definition(const MatrixXd& p) {
  const int n = static_cast<int>(p.rows());
  const Vector3d middle = p.colwise().mean().transpose();
  double volume = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        const Vector3d a = p.row(i), b = p.row(j), c = p.row(k), normal = (b - a).cross(c - a);
        bool above = false, below = false;
        for (int m = 0; m < n; ++m) {
          if (m == i || m == j || m == k) continue;
          (normal.dot(Vector3d(p.row(m).transpose()) - a) > 0 ? above : below) = true;
        }
        if (!(above && below)) volume += std::fabs(normal.dot(a - middle)) / 6;
      }
    }
  }
  return volume;
}

TEST(Hull, OfACubeIsTheCube) {
  MatrixXd corners(9, 3);
  for (int k = 0; k < 8; ++k) corners.row(k) << (k & 1), (k >> 1 & 1), (k >> 2);
  corners.row(8) << 0.4, 0.5, 0.6;  // inside
  const Hull hull = convex_hull(corners);
  EXPECT_EQ(hull.size(), 12U);  // Euler: 2 n - 4 triangles on 8 corners
  EXPECT_NEAR(hull_volume(hull, corners), 1, 1e-14);
  for (const auto& t : hull) {
    for (const int corner : t) EXPECT_NE(corner, 8);
  }
}

TEST(Hull, HasTheVolumeThatItsDefinitionGives) {
  dem::Random random(11);
  for (int k = 0; k < 60; ++k) {
    const MatrixXd points = random_points(random, 5 + k % 20);
    const Hull hull = convex_hull(points);
    EXPECT_NEAR(hull_volume(hull, points), volume_by_definition(points), 1e-12) << k;
  }
}

// The round-off of a place of size 1 over the cluster's own extent bounds what can be asked.
TEST(Hull, StrainIsExactForAffineMotion) {
  dem::Random random(12);
  for (int k = 0; k < 1000; ++k) {
    const double size = k % 3 == 0 ? 1e-3 : 1;  // grains of a millimetre, far from the origin too
    const Vector3d at = k % 2 == 0 ? Vector3d(0, 0, 0) : Vector3d(3, -2, 5) * size;
    const MatrixXd points = random_points(random, 4 + k % 60, size, at);
    const Matrix3d gradient = random_matrix(random);
    MatrixXd u = points * gradient.transpose();
    u.rowwise() += Eigen::RowVector3d(1, 2, 3) * size;
    const Hull hull = convex_hull(points);
    const double volume = hull_volume(hull, points);
    ASSERT_GT(volume, 0) << k;
    // Four points may be nearly in a plane.
    const double tolerance = 1e-13 * std::max(1.0, 10 * size * size * size / volume);
    EXPECT_LT((hull_gradient(hull, points, u) - gradient).norm(), tolerance) << k;
    EXPECT_LT((fitted_gradient(points, u) - gradient).norm(), 1e-3 * tolerance + 1e-9) << k;
  }
}

TEST(Hull, StrainOfALinearPieceIsItsMeanOverTheHull) {
  // u_x = |z|: the mean of its gradient over a body symmetric in z is 0, over the upper half 1.
  MatrixXd octahedron(7, 3);
  octahedron << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0.1;
  MatrixXd u = MatrixXd::Zero(7, 3);
  u.col(0) = octahedron.col(2).cwiseAbs();
  const Hull hull = convex_hull(octahedron);
  EXPECT_NEAR(hull_gradient(hull, octahedron, u)(0, 2), 0, 1e-15);
  const MatrixXd upper = octahedron.topRows(5);
  EXPECT_NEAR(hull_gradient(convex_hull(upper), upper, u.topRows(5))(0, 2), 1, 1e-15);
}

TEST(Hull, RefusesWhatHasNoVolume) {
  const auto refusal = [](const MatrixXd& points) {
    try {
      convex_hull(points);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  dem::Random random(3);
  MatrixXd flat = random_points(random, 12);
  EXPECT_EQ(refusal(flat), "accepted");
  EXPECT_THAT(refusal(flat.topRows(3)), HasSubstr("found 3 points, allowed: four or more"));
  flat.col(1).setConstant(0.3);
  EXPECT_THAT(refusal(flat), HasSubstr("that do not lie in a plane"));
  EXPECT_THROW(fitted_gradient(flat, flat), std::invalid_argument);
  EXPECT_THAT(refusal(MatrixXd::Constant(5, 3, 2)), HasSubstr("in one place"));
}

}  // namespace
}  // namespace grainfield::coupling
