// The equations of a contact network of spheres: tangent, balance, invariance, periodic cells.
#include "dem/quasistatic/sphere_network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/random/random.h"

namespace grainfield::dem {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kRadius = 0.01;

Vec3 random_vector(Random& random, double size) {
  return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

struct Cluster {
  Snapshot start;
  Materials materials;
};

/// 27 random spheres that overlap a little, on a tilted floor or in a cell that repeats.
Cluster cluster(Random& random, const AnyLaw& law, bool periodic, bool any_fixed) {
  EngineSettings e;
  e.shape = ShapeKind::sphere;
  e.law = law;
  e.friction = 0.4;
  e.time_step = 1e-9;
  e.gravity_x = e.gravity_y = e.gravity_z = 0;
  e.rolling = {4e4, 0, 0.3, 2, 0, 0.002};
  constexpr int kSide = 3;
  const double cell = 1.95 * kRadius, width = kSide * cell;
  if (periodic) {
    e.cell.periodic = {true, true, false};
    e.cell.low = Vec3(-0.5 * cell, -0.5 * cell, 0);
    e.cell.edges = Vec3(width, width, 1).asDiagonal();
    e.cell.edges(0, 1) = 0.1 * width;  // sheared
  }
  const auto engine = make_engine(e);
  if (!periodic) {
    engine->add_wall({"floor", Vec3(0, 0, 0.35 * cell), Vec3(0.1, 0, 1).normalized(), 0.3});
  }
  for (int k = 0; k < kSide * kSide * kSide; ++k) {
    const Vec3 at = cell * Vec3(k % kSide, k / kSide % kSide, 0.8 + k / (kSide * kSide)) +
                    random_vector(random, 0.03 * kRadius);
    NewGrain g;
    g.x = at.x();
    g.y = at.y();
    g.z = at.z();
    g.radius = kRadius * random.uniform(0.97, 1.03);
    g.density = 2500;
    g.fixed = any_fixed && random.uniform() < 0.15;
    engine->add(g);
  }
  Cluster c;
  engine->step(1);
  c.start = engine->snapshot();
  c.materials = e;
  return c;
}

const std::vector<AnyLaw>& laws() {
  static const std::vector<AnyLaw> all{LinearLaw{1e5, 4e4, 0, 0}, HertzLaw{1e7, 0.3, 0},
                                       HertzLaw{1e7, 0.2, 0, true}, PenaltyLaw{1e5, 5e4, 0}};
  return all;
}

Vector random_step(Random& random, int n, double size) {
  Vector z(n);
  for (int k = 0; k < n; ++k) z[k] = size * random.uniform(-1, 1);
  return z;
}

TEST(SphereNetwork, TangentIsTheDerivativeOfTheResidual) {
  Random random(7);
  int wrong = 0, columns = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const AnyLaw& law = laws()[trial % laws().size()];
    const Cluster c = cluster(random, law, trial % 3 == 0, trial % 2 == 0);
    SphereNetwork network(c.start, c.materials);
    network.set_load({0, 0, -9.81});
    network.set_scale(10);
    const int n = network.size();
    network.commit(random_step(random, n, 1e-3));  // springs of slip, rolling and twisting
    const Vector z = random_step(random, n, 1e-3);
    Vector r, plus, minus;
    ASSERT_TRUE(network.residual(z, r));
    Eigen::SparseMatrix<double> matrix;
    network.tangent(z, Vector::Zero(n), Vector::Zero(n), matrix);
    const double h = 1e-8, size = network.drag_unit()[0];
    for (int k = 0; k < n; ++k) {
      Vector p = z, m = z;
      p[k] += h;
      m[k] -= h;
      ASSERT_TRUE(network.residual(p, plus) && network.residual(m, minus));
      const Vector exact = matrix.col(k);
      const double error = ((plus - minus) / (2 * h) - exact).cwiseAbs().maxCoeff();
      // Round-off of the difference, and the stiffness that holds loose grains, a millionth of the
      // unit. A column whose contacts stand at a corner of their law is wrong.
      ++columns;
      if (error > 1e-5 * (size + exact.cwiseAbs().maxCoeff())) ++wrong;
    }
  }
  EXPECT_GT(columns, 3000);
  EXPECT_LE(wrong, columns / 200) << columns;
}

// A part is the network with the other grains held, and what it commits becomes the network's.
TEST(SphereNetwork, PartsAreTheNetworkWithTheOthersHeld) {
  Random random(13);
  for (int trial = 0; trial < 24; ++trial) {
    const Cluster c =
        cluster(random, laws()[trial % laws().size()], trial % 3 == 0, trial % 2 == 0);
    SphereNetwork network(c.start, c.materials), whole(c.start, c.materials);
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    if (trial % 4 < 2) gradient = 1e-4 * Eigen::Matrix3d::Random();
    const Vector first = random_step(random, network.size(), 1e-3);
    for (SphereNetwork* one : {&network, &whole}) {
      one->set_load({0, 0, -9.81});
      one->set_scale(10);
      one->commit(first);
      one->strain(gradient);
    }
    std::vector<int> free;
    for (int k = 0; k < network.free_grains(); ++k)
      if (random.uniform() < 0.4) free.push_back(k);
    const auto part = network.part(free);
    ASSERT_EQ(part->size(), 6 * static_cast<int>(free.size()));
    const Vector of_part = random_step(random, part->size(), 1e-3);
    Vector z = Vector::Zero(network.size()), r, all;
    for (std::size_t k = 0; k < free.size(); ++k)
      z.segment<6>(6 * free[k]) = of_part.segment<6>(static_cast<Eigen::Index>(6 * k));
    ASSERT_TRUE(part->residual(of_part, r) && whole.residual(z, all));
    const double most = all.cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < free.size(); ++k)
      EXPECT_LT(
          (r.segment<6>(static_cast<Eigen::Index>(6 * k)) - all.segment<6>(6 * free[k])).norm(),
          1e-13 * most);
    part->commit(of_part);
    whole.commit(z);
    network.adopt(*part);
    EXPECT_FALSE(network.strains());
    const Vector next = random_step(random, network.size(), 1e-3);
    for (const Vector& at : {Vector(Vector::Zero(network.size())), next}) {
      ASSERT_TRUE(network.residual(at, r) && whole.residual(at, all));
      EXPECT_LT((r - all).norm(), 1e-12 * most) << trial;
    }
  }
}

TEST(SphereNetwork, InternalForcesAndMomentsSumToZero) {
  Random random(3);
  for (int trial = 0; trial < 12; ++trial) {
    Cluster c = cluster(random, laws()[trial % laws().size()], false, false);
    c.start.walls.clear();
    c.start.contacts.clear();
    SphereNetwork network(c.start, c.materials);
    const Vector z = random_step(random, network.size(), 1e-2);
    Vector r;
    ASSERT_TRUE(network.residual(z, r));
    Vec3 force(0, 0, 0), moment(0, 0, 0);
    for (std::size_t k = 0; k < c.start.grains.size(); ++k) {
      const Grain& g = c.start.grains[k];
      const auto u = static_cast<Eigen::Index>(6 * k);
      const Vec3 at = g.position + g.radius * z.segment<3>(u), f = r.segment<3>(u);
      force += f;
      moment += g.radius * r.segment<3>(u + 3) + at.cross(f);
    }
    const double most = r.cwiseAbs().maxCoeff();
    ASSERT_GT(most, 0.1);
    EXPECT_LT(force.norm(), 1e-12 * most);
    EXPECT_LT(moment.norm(), 1e-12 * most);
  }
}

// A rotation of the whole turns forces and springs with it, to the third order of its angle.
TEST(SphereNetwork, ARigidRotationTurnsTheForces) {
  Random random(5);
  for (const AnyLaw& law : laws()) {
    Cluster c = cluster(random, law, false, false);
    c.start.walls.clear();
    SphereNetwork network(c.start, c.materials);
    const int n = network.size();
    network.commit(random_step(random, n, 1e-3));
    const Snapshot committed = network.snapshot(c.start);
    Vector before, after, z = Vector::Zero(n);
    ASSERT_TRUE(network.residual(z, before));
    const Vec3 axis = random_vector(random, 1).normalized();
    double error[2];
    for (int half = 0; half < 2; ++half) {
      const double angle = half == 0 ? 4e-3 : 2e-3;
      const Eigen::Matrix3d turn = quaternion_of(angle * axis).toRotationMatrix();
      for (std::size_t k = 0; k < committed.grains.size(); ++k) {
        const Grain& g = committed.grains[k];
        const auto u = static_cast<Eigen::Index>(6 * k);
        z.segment<3>(u) = (turn * g.position - g.position) / g.radius;
        z.segment<3>(u + 3) = angle * axis;
      }
      ASSERT_TRUE(network.residual(z, after));
      error[half] = 0;
      for (int k = 0; k < n; k += 3) {
        error[half] = std::max(
            error[half], Vec3(after.segment<3>(k) - turn * Vec3(before.segment<3>(k))).norm());
      }
    }
    // 1e-8 of the forces is what the overlaps' round-off leaves.
    const double most = before.cwiseAbs().maxCoeff();
    EXPECT_LT(error[1], 1e-4 * most);
    EXPECT_GT(std::log2(error[0] / error[1]), 1.9);
  }
}

TEST(SphereNetwork, ATrialThatIsTakenBackLeavesNoTrace) {
  Random random(11);
  for (int trial = 0; trial < 8; ++trial) {
    const Cluster c = cluster(random, laws()[trial % laws().size()], trial % 2 == 1, true);
    SphereNetwork network(c.start, c.materials);
    network.commit(random_step(random, network.size(), 1e-3));
    const Vector zero = Vector::Zero(network.size());
    Vector before, after;
    ASSERT_TRUE(network.residual(zero, before));
    network.keep();
    const Vector far = random_step(random, network.size(), 0.49);
    ASSERT_TRUE(network.residual(far, after));
    ASSERT_TRUE(network.residual(zero, after));
    EXPECT_TRUE((before.array() == after.array()).all()) << trial;
    network.commit(random_step(random, network.size(), 0.1));
    network.take_back();
    ASSERT_TRUE(network.residual(zero, after));
    EXPECT_TRUE((before.array() == after.array()).all()) << trial;
  }
}

// The engine's own forces, walls, springs and images included.
TEST(SphereNetwork, StartsWithTheEnginesForces) {
  Random random(13);
  for (int trial = 0; trial < 8; ++trial) {
    const Cluster c = cluster(random, laws()[trial % laws().size()], trial % 2 == 1, true);
    SphereNetwork network(c.start, c.materials);
    const Snapshot same = network.snapshot(c.start);
    ASSERT_EQ(same.contacts.size(), c.start.contacts.size());
    ASSERT_GT(same.contacts.size(), 20u);
    double most = 0, error = 0;
    for (std::size_t k = 0; k < same.contacts.size(); ++k) {
      const Contact &a = same.contacts[k], &b = c.start.contacts[k];
      EXPECT_EQ(a.i, b.i);
      EXPECT_EQ(a.j, b.j);
      EXPECT_EQ(a.image, b.image);
      most = std::max(most, b.force.norm());
      error = std::max(error, (a.force - b.force).norm());
    }
    EXPECT_LT(error, 1e-6 * most);  // the engine moved the grains by one short step since
  }
}

}  // namespace
}  // namespace grainfield::dem
