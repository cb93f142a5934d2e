// Paths of a pair with known answers: sliding, rolling, straight pieces.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/studies/pair/simulation.h"

namespace grainfield::dem {
namespace {

RunResult result_of(const PairSetup& setup) {
  const auto run = make_pair_run(setup, 3, 1);
  while (!run->done()) run->advance(100000);
  return run->result();
}

std::vector<double> column(const RunResult& result, const std::string& name) {
  const auto& tables = result.snapshots.front().second.tables;
  for (const char* table : {"pair", "loops"}) {
    if (!tables.contains(table)) continue;
    for (const NumberColumn& c : tables.at(table)) {
      if (c.name == name) return c.values;
    }
  }
  throw std::out_of_range(name);
}

PairSetup linear_path(const char* path, const char* shape) {
  PairSetup s;
  s.kind = "path";
  s.path = path;
  s.shape = shape;
  s.material.law = "linear";
  s.material.density = 2500;
  s.material.normal_damping = s.material.tangential_damping = 0;
  return s;
}

struct Slide {
  const char *shape, *partner;
};
class Sliding : public testing::TestWithParam<Slide> {};

// From the middle by A to one side, to the other and back: the spring of friction gives way first
// by s = mu N/k_t, and where the way turns round by 2 s. What remains is slid, 4 A - 5 s in all.
TEST_P(Sliding, IsCoulombsForceTimesTheWay) {
  PairSetup s = linear_path("slide", GetParam().shape);
  s.partner = GetParam().partner;
  s.material.friction = 0.4;
  s.material.tangential_stiffness = 1e7;
  s.depth = 0.01;
  s.amplitude = 0.2;
  const RunResult r = result_of(s);
  const double normal = s.material.normal_stiffness * s.depth * s.radius, way = 0.2 * s.radius;
  const double limit = 0.4 * normal, give = limit / s.material.tangential_stiffness;
  ASSERT_LT(give, 0.05 * way);
  double least = INFINITY, most = 0, force = 0;
  for (const double n : column(r, "normal_force")) {
    least = std::min(least, n);
    most = std::max(most, n);
  }
  for (const double t : column(r, "tangential_force")) force = std::max(force, std::fabs(t));
  EXPECT_NEAR(least, normal, 1e-6 * normal);
  EXPECT_NEAR(most, normal, 1e-6 * normal);
  EXPECT_NEAR(force, limit, 1e-6 * limit);
  EXPECT_NEAR(r.figures.at("pair.work"), limit * (4 * way - 5 * give) + 0.5 * limit * give,
              1e-3 * limit * way);
  int sliding = 0;
  for (const auto& [name, snapshot] : r.snapshots) {
    for (const Contact& c : snapshot.contacts) {
      EXPECT_EQ(c.sliding, std::fabs(c.tangential_force) >= 0.999999 * limit) << name;
      sliding += c.sliding ? 1 : 0;
    }
  }
  EXPECT_GT(sliding, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Sliding,
                         testing::Values(Slide{"disk", "grain"}, Slide{"disk", "wall"},
                                         Slide{"sphere", "grain"}, Slide{"sphere", "wall"}));

// A spring that sticks is linear in the way: the work of steps is that of the whole, and settles at
// once.
TEST(Sticking, TakesWhatItsSpringHolds) {
  for (const char* shape : {"disk", "sphere"}) {
    PairSetup s = linear_path("waypoints", shape);
    s.partner = "wall";
    s.material.friction = 0.9;
    s.waypoints = {0.01, 0, 0, 0.01, 0.002, 0, 0.01, -0.002, 0};
    const RunResult r = result_of(s);
    const double way = 0.002 * s.radius, stiffness = s.material.tangential_stiffness;
    EXPECT_NEAR(r.figures.at("pair.work"), 0.5 * stiffness * way * way,
                1e-9 * stiffness * way * way);
    EXPECT_EQ(r.figures.at("pair.loops_unsettled"), 0);
  }
}

class Rolling : public testing::TestWithParam<Slide> {};

TEST_P(Rolling, WithoutSlipNothingActsAcrossTheNormal) {
  PairSetup s = linear_path("roll", GetParam().shape);
  s.partner = GetParam().partner;
  s.material.friction = 0.5;
  s.swing = 40;
  const RunResult r = result_of(s);
  const double normal = s.material.normal_stiffness * s.depth * s.radius;
  const auto turned = column(r, "angle");
  double most = 0;
  for (const double a : turned) most = std::max(most, std::fabs(a));
  EXPECT_GT(most, 0.6);  // it does turn
  for (const double n : column(r, "normal_force")) EXPECT_NEAR(n, normal, 1e-6 * normal);
  for (const double t : column(r, "tangential_force")) EXPECT_LT(std::fabs(t), 1e-6 * normal);
  EXPECT_LT(std::fabs(r.figures.at("pair.work")), 1e-9 * r.figures.at("pair.stored_most"));
}

INSTANTIATE_TEST_SUITE_P(All, Rolling,
                         testing::Values(Slide{"disk", "grain"}, Slide{"disk", "wall"},
                                         Slide{"sphere", "grain"}, Slide{"sphere", "wall"}));

// Both disks have the radius R and R_eff = R/2. The first turns by a against the second, which is
// held: the rolling velocity is a' R/2, the moment at most mu_r N R/2. As above with way and force.
TEST(RollingResistance, TakesItsMomentTimesTheAngle) {
  PairSetup s = linear_path("roll", "disk");
  s.material.friction = 0;
  s.material.rolling_friction = 0.1;
  s.material.rolling_stiffness = 1e6;
  s.swing = 40;
  const RunResult r = result_of(s);
  const double normal = s.material.normal_stiffness * s.depth * s.radius;
  const double limit = 0.1 * normal, give = limit / s.material.rolling_stiffness;
  const double distance = 2 * s.radius - s.depth * s.radius, arm = 0.5 * distance;
  const double way = s.swing * std::numbers::pi / 180 * distance / arm * 0.5 * s.radius;
  ASSERT_LT(give, 0.2 * way);
  EXPECT_NEAR(r.figures.at("pair.work"), limit * (4 * way - 5 * give) + 0.5 * limit * give,
              1e-3 * limit * way);
  double most = 0;
  for (const double m : column(r, "torque_first")) most = std::max(most, std::fabs(m));
  EXPECT_NEAR(most, limit * 0.5 * s.radius, 1e-6 * limit * s.radius);

  s.shape = "regular";
  EXPECT_THROW(make_pair_run(s, 1, 1), std::invalid_argument);
}

PairSetup circuit(const char* law) {
  PairSetup s;
  s.kind = "path";
  s.path = "waypoints";
  s.shape = "rand1";
  s.waypoints = {0, 0, 0, 0.3, 0.1, 0.2, 0.35, -0.2, 0.5, 0.1, -0.25, -0.3, 0, 0, 0};
  s.material.law = law;
  s.material.friction = s.material.damping = 0;
  return s;
}

TEST(Waypoints, ClosedCircuitOfTheEnergyLawTakesNoWork) {
  const RunResult energy = result_of(circuit("energy"));
  EXPECT_GT(energy.figures.at("pair.max_depth"), 0.02 * PairSetup().radius);
  EXPECT_LT(energy.figures.at("pair.loop_work_over_energy"), 1e-5);
  EXPECT_GT(result_of(circuit("overlap_area")).figures.at("pair.loop_work_over_energy"), 1e-3);
}

// On an open one all work is stored. A record's work is half a step ahead of what it stores.
TEST(Waypoints, OpenPathStoresItsWork) {
  PairSetup s = circuit("energy");
  s.waypoints.resize(9);
  const RunResult r = result_of(s);
  EXPECT_EQ(r.figures.count("pair.loop_work_over_energy"), 0U);
  const double stored = r.figures.at("pair.stored_most");
  EXPECT_GT(r.figures.at("pair.work"), 0.5 * stored);
  const auto lost = column(r, "dissipated");
  ASSERT_GT(lost.size(), 100U);
  for (const double j : lost) EXPECT_LT(std::fabs(j), 1e-3 * stored);
}

// Dashpots alone: to and fro once at speed v takes what they lose; none without time.
TEST(Approach, TakesWhatTheDashpotsLose) {
  PairSetup s = linear_path("approach", "disk");
  s.material.normal_damping = 20;
  s.depth = 0.02;
  s.speed = 1e-3;
  const RunResult r = result_of(s);
  // m gamma int v^2 dt with the path x = (1 - cos)/2 depth, passed in the time T = 2 depth/speed.
  const double mass = 0.5 * 2500 * std::numbers::pi * s.radius * s.radius;
  const double depth = s.depth * s.radius, time = 2 * depth / s.speed;
  const double square = std::pow(std::numbers::pi * depth / time, 2) / 2 * time;
  EXPECT_NEAR(r.figures.at("pair.work"), mass * 20 * square, 1e-3 * mass * 20 * square);
  s.speed = 0;
  EXPECT_LT(std::fabs(result_of(s).figures.at("pair.work")),
            1e-6 * r.figures.at("pair.stored_most"));
}

}  // namespace
}  // namespace grainfield::dem
