// Quasi-static relaxation of spheres against closed forms and against slow damped dynamics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/quasistatic/linear_solver.h"
#include "dem/quasistatic/quasistatic.h"
#include "dem/quasistatic/sphere_network.h"
#include "dem/random/random.h"
#include "dem/snapshot/contact_changes.h"
#include "tests/dem/imbalance.h"

namespace grainfield::dem {
namespace {

constexpr double kG = 9.81, kRadius = 0.005, kDensity = 2500;

EngineSettings settings_of(const AnyLaw& law, double friction) {
  EngineSettings e;
  e.shape = ShapeKind::sphere;
  e.law = law;
  e.friction = friction;
  e.integrator = IntegratorKind::verlet;
  e.time_step = 2e-5;
  e.gravity_y = 0;
  e.gravity_z = -kG;
  return e;
}

NewGrain sphere(const Vec3& at, double radius = kRadius) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.radius = radius;
  g.density = kDensity;
  return g;
}

double mass_of(double radius) {
  return kDensity * 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

double weight_of(const Snapshot& s) {
  double weight = 0;
  for (const Grain& g : s.grains) weight += g.fixed ? 0 : g.mass * s.gravity.norm();
  return weight;
}

/// Steps until the mean resultant is this share of the mean contact force.
void come_to_rest(Engine& engine, double ratio) {
  engine.set_background_damping(40);
  for (int k = 0; k < 4000; ++k) {
    engine.step(500);
    const Diagnostics d = engine.measure();
    if (d.unbalanced_force_ratio < ratio && d.unbalanced_moment_ratio < ratio) return;
  }
  FAIL() << "no rest: " << engine.measure().unbalanced_force_ratio;
}

/// Poly-disperse spheres dropped into a box without friction at the sides, or into one that repeats
/// sideways, at rest.
std::unique_ptr<Engine> settled(EngineSettings e, bool periodic, int columns, int layers) {
  const double cell = 2.3 * kRadius, width = columns * cell;
  if (periodic) {
    e.cell.periodic = {true, true, false};
    e.cell.edges = Vec3(width, width, 1).asDiagonal();
  }
  auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, e.friction});
  if (!periodic) {
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0});
    engine->add_wall({"right", {width, 0, 0}, {-1, 0, 0}, 0});
    engine->add_wall({"front", {0, 0, 0}, {0, 1, 0}, 0});
    engine->add_wall({"back", {0, width, 0}, {0, -1, 0}, 0});
  }
  Random random(2);
  for (int k = 0; k < columns * columns * layers; ++k) {
    const auto at = [&](int n) { return cell * (n + 0.5 + 0.05 * random.uniform(-1, 1)); };
    engine->add(sphere({at(k % columns), at(k / columns % columns), at(k / (columns * columns))},
                       kRadius * random.uniform(0.85, 1.1)));
  }
  come_to_rest(*engine, 1e-8);
  return engine;
}

/// rms difference of the displacements over their rms.
double difference(const Snapshot& start, const Snapshot& a, const Snapshot& b) {
  double sum = 0, square = 0;
  for (std::size_t k = 0; k < start.grains.size(); ++k) {
    if (start.grains[k].fixed) continue;
    const Vec3 u = a.grains[k].position - start.grains[k].position;
    const Vec3 v = b.grains[k].position - start.grains[k].position;
    square += (u - v).squaredNorm();
    sum += u.squaredNorm();
  }
  return std::sqrt(square / sum);
}

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
  // Steeper than both: no equilibrium.
  const double steep = 0.3;
  EXPECT_THROW(
      relax(engine->snapshot(), e, {kG * std::sin(steep), 0, -kG * std::cos(steep)}, {}, {}),
      ComputationFailed);
}

TEST(SphereRelaxation, AgreesWithSlowDampedDynamics) {
  struct Run {
    AnyLaw law;
    bool periodic, rolls;
  };
  for (const Run& run :
       {Run{HertzLaw{5e6, 0.3, 0.3}, false, false}, Run{LinearLaw{2e4, 1e4, 200, 100}, true, false},
        Run{LinearLaw{2e4, 1e4, 200, 100}, false, true}}) {
    EngineSettings e = settings_of(run.law, 0.5);
    if (run.rolls) e.rolling = {5e3, 0.5, 0.1, 0, 0, 0};
    const auto engine = settled(e, run.periodic, 5, 5);
    const Snapshot start = engine->snapshot();
    const double to = 0.995 * kG;
    for (int k = 1; k <= 100; ++k) {
      engine->set_gravity(0, 0, -(kG + (to - kG) * k / 100));
      engine->step(200);
    }
    come_to_rest(*engine, 1e-8);
    const Snapshot damped = engine->snapshot();
    const QuasistaticResult newton = relax(start, e, {0, 0, -to}, {}, {});
    const ContactChanges changes = compare_contacts(start, damped);
    EXPECT_EQ(newton.contacts_gained, changes.gained);
    EXPECT_EQ(newton.contacts_lost, changes.lost);
    if (!run.rolls) expect_balanced(newton.state, 1e-8);
    EXPECT_LT(difference(start, damped, newton.state), 0.01) << run.periodic << run.rolls;
    EXPECT_NEAR(base_force(newton.state).z() / weight_of(newton.state), 1, 1e-6);
  }
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
  network.set_load({0, 0, -kG}, -1, {0, 0, 0}, -1, {0, 0, 0});
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
