// The equations of a contact network: their tangent, balance and invariance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dem/quasistatic/plane_network.h"
#include "tests/dem/quasistatic_scene.h"

namespace grainfield::dem {
namespace {

/// Random grains, overlapping a little, some with springs.
Snapshot cluster(Random& random, bool polygons) {
  std::vector<NewGrain> grains;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      const double r = 0.01 * random.uniform(0.9, 1.1);
      const double px = 0.0195 * x + 0.001 * random.uniform(),
                   py = 0.0095 + 0.0195 * y + 0.001 * random.uniform();
      if (!polygons || random.uniform() < 0.2) {
        grains.push_back(disk(px, py, r));
        continue;
      }
      Outline o;
      const int n = 3 + static_cast<int>(random.uniform() * 6);
      for (int k = 0; k < n; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.4 * random.uniform()) / n;
        o.push_back({1.1 * r * std::cos(angle), 1.1 * r * std::sin(angle)});
      }
      grains.push_back(polygon(px, py, o));
      grains.back().angle = random.uniform(0, 6);
      grains.back().fixed = random.uniform() < 0.1;
    }
  }
  return put(grains, {wall("floor", 0, 0, 0.1 / std::hypot(0.1, 1), 1 / std::hypot(0.1, 1), 0.4)});
}

TEST(ContactNetwork, TangentIsTheDerivativeOfTheResidual) {
  Random random(7);
  int wrong = 0, columns = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Snapshot s = cluster(random, trial % 2 == 1);
    EngineSettings e = area_law(0.4);
    if (trial % 3 == 0) e.law = LinearLaw{1e6, 4e5, 0, 0};
    const bool frictionless = trial % 5 == 0;  // and without slip: nothing sticks all the same
    if (frictionless) {
      e.friction = 0;
      for (Wall& w : s.walls) w.friction = 0;
    }
    PlaneNetwork network(s, e);
    network.set_load({0, -kG, 0});
    network.set_scale(100);
    const int n = network.size();
    Eigen::VectorXd z(n), r, plus, minus;
    for (int k = 0; k < n; ++k) z[k] = (frictionless ? 0 : 1e-3) * random.uniform(-1, 1);
    ASSERT_TRUE(network.residual(z, r));
    // Without the part that the residual adds to the diagonal.
    Eigen::SparseMatrix<double> matrix;
    network.tangent(z, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), matrix);
    const double h = 1e-8;
    for (int k = 0; k < n; ++k) {
      Eigen::VectorXd p = z, m = z;
      p[k] += h;
      m[k] -= h;
      ASSERT_TRUE(network.residual(p, plus) && network.residual(m, minus));
      const Eigen::VectorXd exact = matrix.col(k);
      const double error = ((plus - minus) / (2 * h) - exact).cwiseAbs().maxCoeff();
      // Differences across h, and the stiffness on the diagonal that holds loose grains (1e-6 of
      // E r / scale = 1e-3). A few columns may straddle a corner of the law or of an outline.
      ++columns;
      if (error > 2e-3 + 1e-4 * exact.cwiseAbs().maxCoeff()) ++wrong;
    }
  }
  EXPECT_GT(columns, 1000);
  EXPECT_LE(wrong, columns / 200);
}

// A trial that carries grains out of each other's reach and is taken back leaves no trace.
TEST(ContactNetwork, ATrialThatIsTakenBackLeavesNoTrace) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    Snapshot s = cluster(random, trial % 2 == 1);
    PlaneNetwork network(s, area_law(0.4));
    network.set_load({0, -kG, 0});
    Eigen::VectorXd z(network.size()), before, after;
    for (int k = 0; k < network.size(); ++k) z[k] = 1e-3 * random.uniform(-1, 1);
    network.commit(z);  // with loaded springs
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(network.size());
    ASSERT_TRUE(network.residual(zero, before));
    for (int k = 0; k < network.size(); ++k) z[k] = 0.49 * (random.uniform() < 0.5 ? -1 : 1);
    ASSERT_TRUE(network.residual(z, after));
    ASSERT_TRUE(network.residual(zero, after));
    EXPECT_TRUE((before.array() == after.array()).all()) << trial;
  }
}

TEST(ContactNetwork, InternalForcesSumToZero) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    Snapshot s = cluster(random, true);
    s.walls.clear();
    for (Grain& g : s.grains) g.fixed = false;
    PlaneNetwork network(s, area_law(0.4));
    Eigen::VectorXd z(network.size()), r;
    for (int k = 0; k < network.size(); ++k) z[k] = 1e-2 * random.uniform(-1, 1);
    ASSERT_TRUE(network.residual(z, r));
    double fx = 0, fy = 0, torque = 0;
    for (std::size_t k = 0; k < s.grains.size(); ++k) {
      const Grain& g = s.grains[k];
      const auto u = static_cast<Eigen::Index>(3 * k);
      fx += r[u];
      fy += r[u + 1];
      torque += r[u + 2] * g.radius + (g.position.x() + g.radius * z[u]) * r[u + 1] -
                (g.position.y() + g.radius * z[u + 1]) * r[u];
    }
    EXPECT_NEAR(fx, 0, 1e-9 * r.cwiseAbs().maxCoeff());
    EXPECT_NEAR(fy, 0, 1e-9 * r.cwiseAbs().maxCoeff());
    EXPECT_NEAR(torque, 0, 1e-9 * r.cwiseAbs().maxCoeff());
  }
}

TEST(ContactNetwork, ARigidRotationLeavesTheForces) {
  Random random(5);
  Snapshot s = cluster(random, false);
  s.walls.clear();
  PlaneNetwork network(s, area_law(0.4));
  const int n = network.size();
  Eigen::VectorXd z(n), before, after;
  for (int k = 0; k < n; ++k) z[k] = 1e-3 * random.uniform(-1, 1);
  network.commit(z);  // springs
  z.setZero();
  ASSERT_TRUE(network.residual(z, before));
  const double a = 1e-3;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    // About the first grain's committed centre, which `displacements` of order 1e-5 r ignore.
    const Grain& g = s.grains[k];
    const double x = g.position.x(), y = g.position.y();
    z[3 * k] = (std::cos(a) * x - std::sin(a) * y - x) / g.radius;
    z[3 * k + 1] = (std::sin(a) * x + std::cos(a) * y - y) / g.radius;
    z[3 * k + 2] = a;
  }
  ASSERT_TRUE(network.residual(z, after));
  for (int k = 0; k < n; k += 3) {
    // Forces turn by a, torques stay. The committed centres are 1e-3 r off those that z rotates:
    // relative motions of a 1e-3 r = 1e-8 m, forces of E times that.
    EXPECT_NEAR(after[k], std::cos(a) * before[k] - std::sin(a) * before[k + 1], 0.5);
    EXPECT_NEAR(after[k + 1], std::sin(a) * before[k] + std::cos(a) * before[k + 1], 0.5);
    EXPECT_NEAR(after[k + 2], before[k + 2], 0.5);
  }
  EXPECT_GT(before.cwiseAbs().maxCoeff(), 50);
}

}  // namespace
}  // namespace grainfield::dem
