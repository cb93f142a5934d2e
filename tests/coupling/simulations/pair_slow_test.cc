#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "coupling/studies/pair/simulation.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

RunResult finish(Run& run) {
  while (!run.done()) run.advance(10000);
  return run.result();
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
// What making a run refuses; "": nothing.
std::string refusal(const PairSetup& setup) {
  return refusal_of([&] { make_pair_run(setup, 1, 1); });
}
std::map<std::string, double> figures_of(const PairSetup& setup) {
  return finish(*make_pair_run(setup, 3, 1)).figures;
}

PairSetup linear(const char* shape) {
  PairSetup s;
  s.shape = shape;
  s.material.law = "linear";
  s.material.density = 2500;
  s.material.friction = 1e4;
  s.material.normal_damping = s.material.tangential_damping = 0;
  s.motion.time_step_fraction = 0.002;
  return s;
}
// The reduced mass of two equal bodies.
double reduced_mass(const PairSetup& s) {
  const double r = s.radius;
  const double volume =
      s.is_3d() ? 4.0 / 3 * std::numbers::pi * r * r * r : std::numbers::pi * r * r;
  return s.material.density * volume / 2;
}

class LinearPair : public testing::TestWithParam<const char*> {};

// A dashpot that never pulls: the contact ends where the force vanishes (Schwager, Poeschel 2007).
TEST_P(LinearPair, NormalRestitutionIsTheClosedForm) {
  PairSetup s = linear(GetParam());
  const double own = std::sqrt(s.material.normal_stiffness / reduced_mass(s));
  for (const double share : {0.0, 0.1, 0.4}) {
    const double beta = share * own, omega = std::sqrt(own * own - beta * beta);
    s.material.normal_damping = 2 * beta;
    const double time =
        (std::numbers::pi - std::atan2(2 * beta * omega, omega * omega - beta * beta)) / omega;
    const auto figures = figures_of(s);
    EXPECT_NEAR(figures.at("pair.restitution_normal"), std::exp(-beta * time), 1e-3) << share;
    EXPECT_NEAR(figures.at("pair.duration"), time, 2e-3 * time) << share;
  }
}

// Without sliding the slip swings with k_t over the mass m_t that it moves.
TEST_P(LinearPair, TangentialRestitutionIsTheClosedForm) {
  PairSetup s = linear(GetParam());
  s.angle = 30;
  s.offset = 0;
  const double mass = reduced_mass(s), inverse = s.is_3d() ? 3.5 : 3;
  const double ratio =
      std::sqrt(inverse * s.material.tangential_stiffness / s.material.normal_stiffness);
  EXPECT_GT(mass, 0);
  EXPECT_NEAR(figures_of(s).at("pair.restitution_tangential"), -std::cos(std::numbers::pi * ratio),
              1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, LinearPair, testing::Values("disk", "sphere"));

TEST(Pair, HertzImpactOfSpheres) {
  PairSetup s;
  s.shape = "sphere";
  s.material.law = "hertz";
  s.material.density = 2500;
  s.material.damping = 0;
  const double young = s.material.young / (2 * (1 - 0.09)), r = s.radius / 2, m = reduced_mass(s);
  const double depth = std::pow(15 * m * s.speed * s.speed / (16 * young * std::sqrt(r)), 0.4);
  const auto figures = figures_of(s);
  EXPECT_NEAR(figures.at("pair.max_depth"), depth, 1e-3 * depth);
  EXPECT_NEAR(figures.at("pair.duration"), 2.94328 * depth / s.speed, 0.01 * depth / s.speed);
  EXPECT_NEAR(figures.at("pair.restitution_normal"), 1, 1e-3);
}

TEST(Pair, ClosedLoopsOfPolygons) {
  PairSetup s;
  s.kind = "path";
  s.path = "random";
  s.shape = "rand1";
  s.loops = 40;
  s.material.law = "energy";
  s.material.damping = s.material.friction = 0;
  EXPECT_LT(figures_of(s).at("pair.loop_work_over_energy"), 1e-5);
  s.material.law = "overlap_area";
  EXPECT_GT(figures_of(s).at("pair.loop_work_over_energy"), 0.02);
}

// Bodies of unequal sizes: none is swallowed all the way, and none stays apart.
TEST(Pair, RandomLoopsCrossTheOutlineOfLargerAndSmallerBodies) {
  for (const double other : {0.0, 0.03, 0.002}) {
    PairSetup s;
    s.kind = "path";
    s.path = "random";
    s.shape = "rand1";
    s.radius_second = other;
    s.loops = 30;
    s.steps = 500;
    s.material.law = "energy";
    const auto crossings = column(finish(*make_pair_run(s, 3, 1)), "crossings");
    EXPECT_EQ(crossings.size(), 30U);
    for (const double n : crossings) EXPECT_GE(n, 2) << other;
  }
}

TEST(Pair, ProfileEndsWhereTheBodiesHaveParted) {
  for (const int records : {2, 50, 200, 1000}) {
    PairSetup s = linear("disk");
    s.records = records;
    const RunResult r = finish(*make_pair_run(s, 3, 1));
    const auto depth = column(r, "depth"), time = column(r, "time");
    EXPECT_EQ(depth.back(), 0) << records;
    EXPECT_EQ(column(r, "normal_force").back(), 0) << records;
    EXPECT_GE(time.back(), r.figures.at("pair.duration")) << records;
    EXPECT_LT(time.back(), r.figures.at("pair.duration") + 2 * r.figures.at("dem.time_step"));
    EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
    EXPECT_GT(depth.size(), static_cast<std::size_t>(records));
    EXPECT_LE(depth.size(), static_cast<std::size_t>(2 * records));
    EXPECT_NEAR(r.snapshots.back().second.time, time.back(), 1e-8 * time.back());  // as written
  }
}

// The softer the contact, the longer it takes: of this law without end as the speed goes to 0.
TEST(Pair, SlowImpactsPart) {
  PairSetup s;
  s.material.law = "energy";
  s.material.friction = 0;
  for (const double speed : {1e-3, 1e-9}) {
    s.speed = speed;
    const auto figures = figures_of(s);
    EXPECT_EQ(figures.at("pair.parted"), 1) << speed;
    EXPECT_NEAR(figures.at("pair.restitution_normal"), 0.383, 1e-3) << speed;
  }
}

TEST(Pair, RefusesBodiesThatMoveApartWithTheKeyAndWhatIsAllowed) {
  PairSetup s = linear("disk");
  s.offset = 1;  // the normal is 30 degrees below the x axis
  EXPECT_EQ(refusal(s), "accepted");
  s.angles = {-80, 80};
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.angles: found 80: the bodies move apart at "));
  EXPECT_THAT(refusal(s), testing::HasSubstr("allowed: above -120 and below 60"));
  s.angles = {59.9, -89};
  EXPECT_EQ(refusal(s), "accepted");
  s.angles = {};
  s.angle = 60.1;
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.angle: found 60.1: "));
  s.speeds = {0.2};
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.angle: found 60.1: "));
  // A square whose foremost corner, 10 degrees above the x axis, turns away from the wall.
  s = {};
  s.shape = "regular";
  s.corners = 4;
  s.partner = "wall";
  s.turned_first = 10;
  s.spin_first = {1000};
  const double away = 1000 * s.radius * std::sin(10 * std::numbers::pi / 180);
  s.speed = 1.001 * away;
  EXPECT_EQ(refusal(s), "accepted");
  s.speeds = {2 * away, 1};
  EXPECT_THAT(refusal(s), testing::HasSubstr(fmt::format("allowed: above {:.6g}", away)));
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.speeds: found 1: "));
  s.speeds = {};
  s.speed = 1;
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.speed: found 1: "));
}

TEST(Pair, RefusesSpeedsThatLeapOverABody) {
  PairSetup s = linear("sphere");
  const double step = make_pair_run(s, 1, 1)->result().figures.at("dem.time_step");
  const double most = 0.5 * s.radius / step;
  s.speed = 0.999 * most;
  EXPECT_EQ(refusal(s), "accepted");
  s.speed = 1.001 * most;
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.speed: found "));
  EXPECT_THAT(refusal(s), testing::HasSubstr("allowed: at most "));
  s.speed = 0.1;
  s.speeds = {0.2, 1.001 * most};
  EXPECT_THAT(refusal(s), testing::StartsWith("pair.speeds: found "));
}

TEST(Pair, PathsKnowNoTimeStep) {
  PairSetup s = linear("disk");
  s.kind = "path";
  s.path = "slide";
  s.steps = 100;
  const RunResult usual = finish(*make_pair_run(s, 3, 1));
  s.motion.time_step = 1;
  s.motion.integrator = "gear";
  const RunResult other = finish(*make_pair_run(s, 3, 1));
  EXPECT_EQ(usual.figures, other.figures);
  EXPECT_EQ(column(usual, "tangential_force"), column(other, "tangential_force"));
  EXPECT_EQ(foresee_pair(s, {1}, 1000).time_step, 0);
  s.kind = "collision";
  EXPECT_NE(refusal(s), "accepted");
}

TEST(Pair, GoesOnAfterItWasSaved) {
  PairSetup s = linear("disk");
  s.angle = 20;
  const RunResult whole = finish(*make_pair_run(s, 3, 1));
  const std::string file = std::filesystem::temp_directory_path() / "pair_slow_test.state";
  auto run = make_pair_run(s, 3, 1);
  while (!run->done()) {
    run->advance(2000);
    run->save(file);
    run = make_pair_run(s, 3, 1);
    run->restore(file);
  }
  std::filesystem::remove(file);
  const RunResult parts = run->result();
  EXPECT_EQ(parts.figures, whole.figures);
  ASSERT_EQ(parts.snapshots.size(), whole.snapshots.size());
  EXPECT_EQ(parts.snapshots.front().second.attributes, whole.snapshots.front().second.attributes);
}

TEST(Pair, RefusesWhatDoesNotGoTogether) {
  PairSetup s;
  s.material.law = "hertz";
  EXPECT_THROW(make_pair_run(s, 1, 1), std::invalid_argument);
  s = {};
  s.shape = "cube";
  EXPECT_THROW(make_pair_run(s, 1, 1), std::invalid_argument);
  s = {};
  s.shape = "regular";
  s.material.rolling_friction = 0.1;
  s.material.rolling_stiffness = 1e6;
  EXPECT_THROW(make_pair_run(s, 1, 1), std::invalid_argument);
  s = {};
  s.kind = "path";
  s.motion.local_damping = 0.3;
  EXPECT_THROW(make_pair_run(s, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
