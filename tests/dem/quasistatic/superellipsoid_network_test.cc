// The equations of a contact network of superellipsoids: tangent, symmetry, invariance, the
// engine's forces, and those of spheres where they are round.
#include "dem/quasistatic/superellipsoid_network.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/quasistatic/sphere_network.h"
#include "dem/random/random.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kRadius = 0.01;

Vec3 random_vector(Random& random, double size) {
  return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

Vector random_step(Random& random, int n, double size) {
  Vector z(n);
  for (int k = 0; k < n; ++k) z[k] = size * random.uniform(-1, 1);
  return z;
}

struct Cluster {
  Snapshot start;
  Materials materials;
};

enum class Around { floor, cell };

/// 27 bodies of about kRadius that overlap a little, turned at random, on a tilted floor or in a
/// cell that repeats; round: spheres of one size.
Cluster cluster(Random& random, const AnyLaw& law, Around around, bool round,
                double friction = 0.4) {
  EngineSettings e;
  e.shape = ShapeKind::superellipsoid;
  e.law = law;
  e.friction = friction;
  e.time_step = 1e-9;
  e.gravity_x = e.gravity_y = e.gravity_z = 0;
  constexpr int kSide = 3;
  const double cell = (round ? 1.98 : 1.9) * kRadius, width = kSide * cell;
  if (around == Around::cell) {
    e.cell.periodic = {true, true, true};
    e.cell.low = Vec3::Constant(-0.5 * cell);
    e.cell.edges = Vec3(width, width, width).asDiagonal();
    e.cell.edges(0, 1) = 0.1 * width;  // sheared
  }
  const auto engine = make_engine(e);
  if (around == Around::floor) {
    engine->add_wall({"floor", Vec3(0, 0, 0.35 * cell), Vec3(0.1, 0, 1).normalized(), friction});
  }
  for (int k = 0; k < kSide * kSide * kSide; ++k) {
    const Vec3 at = cell * Vec3(k % kSide, k / kSide % kSide, 0.8 + k / (kSide * kSide)) +
                    random_vector(random, (round ? 0.005 : 0.02) * kRadius);
    NewGrain g;
    g.x = at.x();
    g.y = at.y();
    g.z = at.z();
    g.axes = {kRadius, kRadius, kRadius};
    if (!round) {
      for (double& r : g.axes) r *= random.uniform(0.9, 1.1);
      for (double& power : g.exponents) power = random.uniform(0.85, 1.15);
    }
    const auto turn = random_rotation(random);
    g.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
    g.density = 2500;
    engine->add(g);
  }
  Cluster c;
  engine->step(1);
  c.start = engine->snapshot();
  c.materials = e;
  return c;
}

const std::vector<AnyLaw>& laws() {
  static const std::vector<AnyLaw> all{LinearLaw{1e5, 4e4, 0, 0}, HertzEllipticLaw{1e7, 0.3, 0},
                                       HertzEllipticLaw{1e7, 0.2, 0, true},
                                       PenaltyLaw{1e5, 5e4, 0}};
  return all;
}

TEST(SuperellipsoidNetwork, TangentIsTheDerivativeOfTheResidual) {
  Random random(7);
  int wrong = 0, columns = 0;
  for (int trial = 0; trial < 8; ++trial) {
    const Cluster c = cluster(random, laws()[trial % laws().size()],
                              trial % 3 == 0 ? Around::cell : Around::floor, false);
    SuperellipsoidNetwork network(c.start, c.materials);
    network.set_load({0, 0, -9.81});
    network.set_scale(10);
    const int n = network.size();
    network.commit(random_step(random, n, 1e-3));  // springs of slip
    const Vector z = random_step(random, n, 1e-3);
    Vector r, plus, minus;
    ASSERT_TRUE(network.residual(z, r));
    Eigen::SparseMatrix<double> matrix;
    network.tangent(z, Vector::Zero(n), Vector::Zero(n), matrix);
    // Another step than the network's own.
    const double h = 2e-7, size = network.drag_unit()[0];
    for (int k = 0; k < n; ++k) {
      Vector p = z, m = z;
      p[k] += h;
      m[k] -= h;
      ASSERT_TRUE(network.residual(p, plus) && network.residual(m, minus));
      const Vector exact = matrix.col(k);
      const double error = ((plus - minus) / (2 * h) - exact).cwiseAbs().maxCoeff();
      ++columns;
      if (error > 1e-5 * (size + exact.cwiseAbs().maxCoeff())) ++wrong;
    }
  }
  EXPECT_GT(columns, 1000);
  // At corners of the law, as of spheres, and where a curvature comes to its bound.
  EXPECT_LE(wrong, columns / 50) << columns;
}

// Forces, springs and tangent of the sphere network, at rest and after a small motion.
TEST(SuperellipsoidNetwork, RoundOnesAreSpheres) {
  const std::vector<std::pair<AnyLaw, AnyLaw>> same{
      {LinearLaw{1e5, 4e4, 0, 0}, LinearLaw{1e5, 4e4, 0, 0}},
      {HertzEllipticLaw{1e7, 0.3, 0}, HertzLaw{1e7, 0.3, 0}},
      {HertzEllipticLaw{1e7, 0.2, 0, true}, HertzLaw{1e7, 0.2, 0, true}},
  };
  Random random(5);
  for (const auto& [elliptic, hertz] : same) {
    Cluster c = cluster(random, elliptic, Around::cell, true);
    SuperellipsoidNetwork shaped(c.start, c.materials);
    c.materials.law = hertz;
    for (Grain& g : c.start.grains) g.axes.setZero();
    SphereNetwork spheres(c.start, c.materials);
    const int n = spheres.size();
    ASSERT_EQ(shaped.size(), n);
    for (const double way : {0.0, 1e-5}) {
      const Vector z = random_step(random, n, way);
      Vector zero = Vector::Zero(n), a, b;
      Eigen::SparseMatrix<double> of_shaped, of_spheres;
      for (ContactNetwork* one : std::initializer_list<ContactNetwork*>{&shaped, &spheres}) {
        one->commit(z);
        one->set_scale(1);
      }
      ASSERT_TRUE(shaped.residual(zero, a) && spheres.residual(zero, b));
      shaped.tangent(zero, zero, zero, of_shaped);
      spheres.tangent(zero, zero, zero, of_spheres);
      ASSERT_EQ(of_shaped.nonZeros(), of_spheres.nonZeros());
      const double force = b.cwiseAbs().maxCoeff(),
                   slope = of_spheres.coeffs().cwiseAbs().maxCoeff();
      // Springs differ to the second order of the motion: other means over the way.
      const double tolerance = way > 0 ? 1e-4 : 1e-8;
      EXPECT_GT(force, 1e-3);
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance * force) << way;
      EXPECT_LT((of_shaped.coeffs() - of_spheres.coeffs()).cwiseAbs().maxCoeff(),
                std::max(tolerance, 1e-6) * slope)
          << way;
      EXPECT_NEAR(shaped.drag_unit()[0] / spheres.drag_unit()[0], 1, 1e-6);
    }
  }
}

// The linear law without friction is the gradient of k d^2/2, d the least thickness.
TEST(SuperellipsoidNetwork, WithoutFrictionTheTangentIsSymmetric) {
  Random random(9);
  for (int trial = 0; trial < 4; ++trial) {
    const Cluster c = cluster(random, LinearLaw{1e5, 4e4, 0, 0},
                              trial % 2 == 0 ? Around::cell : Around::floor, false, 0);
    SuperellipsoidNetwork network(c.start, c.materials);
    const Vector zero = Vector::Zero(network.size());
    Eigen::SparseMatrix<double> matrix;
    network.tangent(zero, zero, zero, matrix);
    // Columns are by u/r and theta, rows forces and M/r: times r they are those of the energy, but
    // for moments out of balance, of which half the cross product remains.
    Vector r;
    ASSERT_TRUE(network.residual(zero, r));
    Eigen::MatrixXd whole(matrix);
    for (std::size_t k = 0; k < c.start.grains.size(); ++k) {
      const auto u = static_cast<Eigen::Index>(6 * k);
      whole.middleRows<6>(u) *= c.start.grains[k].radius;
      const Vec3 half = 0.5 * c.start.grains[k].radius * r.segment<3>(u + 3);
      for (int a = 0; a < 3; ++a) whole.block<3, 1>(u + 3, u + 3 + a) += half.cross(Vec3::Unit(a));
    }
    EXPECT_LT((whole - whole.transpose()).cwiseAbs().maxCoeff(),
              1e-6 * whole.cwiseAbs().maxCoeff());
  }
}

TEST(SuperellipsoidNetwork, InternalForcesAndMomentsSumToZero) {
  Random random(3);
  for (int trial = 0; trial < 4; ++trial) {
    Cluster c = cluster(random, laws()[trial % laws().size()], Around::floor, false);
    c.start.walls.clear();
    c.start.contacts.clear();
    SuperellipsoidNetwork network(c.start, c.materials);
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
TEST(SuperellipsoidNetwork, ARigidRotationTurnsTheForces) {
  Random random(5);
  for (const AnyLaw& law : laws()) {
    Cluster c = cluster(random, law, Around::floor, false);
    c.start.walls.clear();
    c.start.contacts.clear();
    SuperellipsoidNetwork network(c.start, c.materials);
    const int n = network.size();
    network.commit(random_step(random, n, 1e-3));
    const Snapshot committed = network.snapshot(c.start);
    Vector before, after, z = Vector::Zero(n);
    ASSERT_TRUE(network.residual(z, before));
    const Vec3 axis = random_vector(random, 1).normalized();
    double error[2];
    for (int half = 0; half < 2; ++half) {
      const double angle = half == 0 ? 2e-2 : 1e-2;
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
    const double most = before.cwiseAbs().maxCoeff();
    EXPECT_LT(error[1], 1e-4 * most);
    EXPECT_GT(std::log2(error[0] / error[1]), 1.9);
  }
}

TEST(SuperellipsoidNetwork, ATrialThatIsTakenBackLeavesNoTrace) {
  Random random(11);
  for (int trial = 0; trial < 4; ++trial) {
    const Cluster c = cluster(random, laws()[trial % laws().size()],
                              trial % 2 == 1 ? Around::cell : Around::floor, false);
    SuperellipsoidNetwork network(c.start, c.materials);
    network.commit(random_step(random, network.size(), 1e-3));
    const Vector zero = Vector::Zero(network.size());
    Vector before, after;
    ASSERT_TRUE(network.residual(zero, before));
    network.keep();
    ASSERT_TRUE(network.residual(random_step(random, network.size(), 0.3), after));
    ASSERT_TRUE(network.residual(zero, after));
    EXPECT_TRUE((before.array() == after.array()).all()) << trial;
    network.commit(random_step(random, network.size(), 0.1));
    network.take_back();
    ASSERT_TRUE(network.residual(zero, after));
    EXPECT_TRUE((before.array() == after.array()).all()) << trial;
  }
}

// The engine's own forces and contact points, walls, springs and images included.
TEST(SuperellipsoidNetwork, StartsWithTheEnginesForces) {
  Random random(13);
  for (int trial = 0; trial < 8; ++trial) {
    const Cluster c = cluster(random, laws()[trial % laws().size()],
                              trial % 2 == 1 ? Around::cell : Around::floor, false);
    SuperellipsoidNetwork network(c.start, c.materials);
    const Snapshot same = network.snapshot(c.start);
    ASSERT_EQ(same.contacts.size(), c.start.contacts.size());
    ASSERT_GT(same.contacts.size(), 20u);
    double most = 0, error = 0, beside = 0;
    for (std::size_t k = 0; k < same.contacts.size(); ++k) {
      const Contact &a = same.contacts[k], &b = c.start.contacts[k];
      EXPECT_EQ(a.i, b.i);
      EXPECT_EQ(a.j, b.j);
      EXPECT_EQ(a.image, b.image);
      most = std::max(most, b.force.norm());
      error = std::max(error, (a.force - b.force).norm());
      beside = std::max(beside, (a.point - b.point).norm());
    }
    EXPECT_LT(error, 1e-5 * most);  // the engine moved the grains by one short step since
    EXPECT_LT(beside, 1e-5 * kRadius);
  }
}

}  // namespace
}  // namespace grainfield::dem
