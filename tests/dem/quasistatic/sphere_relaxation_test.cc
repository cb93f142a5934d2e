// Quasi-static relaxation of spheres against closed forms and against slow damped dynamics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dem/engine/engine.h"
#include "dem/quasistatic/block_matrix.h"
#include "dem/quasistatic/linear_solver.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/sphere_network.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/imbalance.h"
#include "tests/dem/sphere_relaxation_scene.h"

namespace grainfield::dem {
namespace {

TEST(SphereRelaxation, TwoSpheresUnderWeightOverlapAsTheLawsSay) {
  const double m = mass_of(kRadius), k = 1e5;
  for (const bool hertz : {false, true}) {
    const HertzLaw law{1e7, 0.25, 0};
    EngineSettings e = settings_of(LinearLaw{k, 3e4, 0, 0}, 0.3);
    if (hertz) e.law = law;
    const auto engine = make_engine(e);
    engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.3});
    engine->add(sphere({0, 0, kRadius}));
    engine->add(sphere({0, 0, 3 * kRadius}));
    const QuasistaticResult out = relax(engine->snapshot(), e, {0, 0, -kG}, {}, {});
    expect_balanced(out.state, 1e-8);
    const auto depth = [&](double force, double radius) {
      if (!hertz) return force / k;
      return std::pow(force / (4.0 / 3 * law.effective_young() * std::sqrt(radius)), 2.0 / 3);
    };
    const double first = depth(2 * m * kG, kRadius), second = depth(m * kG, 0.5 * kRadius);
    EXPECT_NEAR(out.state.grains[0].position.z(), kRadius - first, 1e-6 * first);
    EXPECT_NEAR(out.state.grains[1].position.z(), 3 * kRadius - first - second, 1e-6 * first);
    EXPECT_EQ(out.contacts_gained, 2);
    ASSERT_EQ(out.state.contacts.size(), 2u);
    EXPECT_NEAR(out.state.contacts[0].force.z(), 2 * m * kG, 1e-8 * m * kG);
    EXPECT_NEAR(out.state.walls[0].force.z(), -2 * m * kG, 1e-8 * m * kG);
  }
}

// A sphere on a slope is held by friction and resistance against rolling; the springs carry
// m g sin(a) and m g R sin(a).
TEST(SphereRelaxation, ASphereOnASlopeIsHeldByRollingResistance) {
  const double m = mass_of(kRadius), angle = 0.1;
  EngineSettings e = settings_of(LinearLaw{1e5, 3e4, 0, 0}, 0.5);
  e.rolling = {2e4, 0, 0.2, 0, 0, 0};
  const auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
  engine->add(sphere({0, 0, kRadius - m * kG / 1e5}));
  const Vec3 gravity(kG * std::sin(angle), 0, -kG * std::cos(angle));
  const QuasistaticResult out = relax(engine->snapshot(), e, gravity, {}, {});
  ASSERT_EQ(out.state.contacts.size(), 1u);
  const Contact& c = out.state.contacts[0];
  const double pull = m * kG * std::sin(angle);
  EXPECT_NEAR(c.spring_vector.x(), -pull, 1e-7 * pull);
  EXPECT_NEAR(c.rolling_spring.norm() * kRadius, pull * kRadius, 1e-3 * pull * kRadius);
  EXPECT_FALSE(c.sliding);
  // About the place where it touches: of the resistance alone.
  EXPECT_NEAR(out.state.walls[0].force.x(), pull, 1e-7 * pull);
  const Vec3 arm = c.point - out.state.walls[0].point;
  const Vec3 rolling = out.state.walls[0].torque - arm.cross(out.state.walls[0].force);
  EXPECT_NEAR(rolling.norm(), pull * kRadius, 1e-3 * pull * kRadius);
  // Steeper than both: no equilibrium.
  const double steep = 0.3;
  EXPECT_THROW(
      relax(engine->snapshot(), e, {kG * std::sin(steep), 0, -kG * std::cos(steep)}, {}, {}),
      ComputationFailed);
}

TEST(SphereRelaxation, ASmallLoadIsCarriedByTheBaseAndIsLinear) {
  const EngineSettings e = settings_of(HertzLaw{5e6, 0.3, 0.3}, 0.5);
  const auto engine = settled(e, true, 5, 5);
  const Snapshot rest = relax(engine->snapshot(), e, {0, 0, -kG}, {}, {}).state;
  std::int64_t top = 0;
  for (const Grain& g : rest.grains) {
    if (g.position.z() > rest.grains[top].position.z()) top = g.id;
  }
  QuasistaticSettings fine;
  fine.unbalanced_force_ratio = 1e-9;
  double sunk[2];
  for (int k = 0; k < 2; ++k) {
    AppliedForce force;
    force.id = top;
    force.fz = -0.02 * (k + 1) * mass_of(kRadius) * kG;
    const QuasistaticResult out = relax(rest, e, rest.gravity, force, fine);
    EXPECT_EQ(out.contacts_gained + out.contacts_lost, 0);
    EXPECT_NEAR((base_force(out.state) - base_force(rest)).z() / -force.fz, 1, 1e-5);
    sunk[k] = rest.grains[top].position.z() - out.state.grains[top].position.z();
    expect_balanced(out.state, 1e-9);
  }
  EXPECT_GT(sunk[0], 0);
  EXPECT_NEAR(sunk[1] / sunk[0], 2, 0.05);  // Hertz: second order in force over contact forces
}

TEST(SphereRelaxation, BothLinearSolversAgree) {
  const EngineSettings e = settings_of(HertzLaw{5e6, 0.3, 0.3}, 0.3);
  const auto engine = settled(e, true, 4, 5);
  SphereNetwork network(engine->snapshot(), e);
  network.set_load({0, 0, -kG});
  network.set_scale(mass_of(kRadius) * kG);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(network.size());
  Eigen::SparseMatrix<double> matrix;
  Eigen::VectorXd r, direct, iterated, rhs(network.size());
  ASSERT_TRUE(network.residual(zero, r));
  network.tangent(zero, r, zero, matrix);
  Random random(4);
  for (double& value : rhs) value = random.uniform(-1, 1);
  const auto one = make_direct_solver(), other = make_iterative_solver();
  ASSERT_TRUE(one->prepare(matrix));
  ASSERT_TRUE(other->prepare(matrix));
  one->solve(rhs, direct);
  other->solve(rhs, iterated);
  EXPECT_LT((matrix * direct - rhs).norm(), 1e-9 * rhs.norm());
  EXPECT_LT((matrix * iterated - rhs).norm(), 2 * kLinearTolerance * rhs.norm());

  // Then matrices of other values, of another size, of blocks on the diagonal alone.
  const Eigen::SparseMatrix<double> first = matrix;
  const auto expect_solved = [&](const Eigen::SparseMatrix<double>& next) {
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(next.rows(), -1, 2);
    ASSERT_TRUE(one->prepare(next));
    ASSERT_TRUE(other->prepare(next));
    one->solve(right, direct);
    other->solve(right, iterated);
    EXPECT_LT((next * direct - right).norm(), 1e-9 * right.norm());
    EXPECT_LT((next * iterated - right).norm(), 2 * kLinearTolerance * right.norm());
  };
  matrix = 1.1 * first;
  expect_solved(matrix);
  for (int k = 0; k < matrix.rows(); ++k) matrix.coeffRef(k, k) *= k % 2 == 0 ? 1e4 : 2;
  expect_solved(matrix);
  matrix = matrix.block(0, 0, 60, 60);
  expect_solved(matrix);
  lay_out_blocks(10, 6, {}, matrix);
  matrix.diagonal().setConstant(-3);
  expect_solved(matrix);
  expect_solved(first);
}

TEST(SphereRelaxation, RefusesWhatItDoesNotKnow) {
  EngineSettings e = settings_of(HertzEllipticLaw{}, 0.3);
  const auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.3});
  engine->add(sphere({0, 0, kRadius}));
  const Snapshot start = engine->snapshot();
  const auto complaint = [&](const Snapshot& s, const EngineSettings& settings) {
    try {
      relax(s, settings, {0, 0, -kG}, {}, {});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(complaint(start, e).find("hertz_elliptic"), std::string::npos) << complaint(start, e);
  Snapshot flows = start;
  flows.cell.periodic = {true, true, true};
  flows.cell.edges = Eigen::Matrix3d::Identity();
  flows.cell.velocity_gradient(0, 2) = 1;
  EXPECT_NE(complaint(flows, settings_of(HertzLaw{}, 0.3)).find("flows"), std::string::npos);
  Snapshot shaped = start;
  shaped.grains[0].axes = Vec3(1, 1, 2) * kRadius;
  EXPECT_NE(complaint(shaped, settings_of(HertzLaw{}, 0.3)).find("superellipsoid"),
            std::string::npos);
}

}  // namespace
}  // namespace grainfield::dem
