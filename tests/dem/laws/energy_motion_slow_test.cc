// Grains under the energy law in motion: what they keep, and that they come to rest where Roul's
// law keeps them rocking.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"
#include "tests/dem/imbalance.h"

namespace grainfield::dem {
namespace {

Outline scattered(Random& random, int corners, double radius, double stretch) {
  Outline out;
  for (int k = 0; k < corners; ++k) {
    const auto [c, s] =
        rotation_of(2 * std::numbers::pi * (k + random.uniform(-0.25, 0.25)) / corners);
    out.push_back({radius * stretch * c, radius / stretch * s});
  }
  return centred_outline(out);
}

// A gas of polygons without friction and damping in a periodic cell.
TEST(EnergyMotionSlow, AGasKeepsItsEnergyOverAMillionSteps) {
  for (const bool power : {false, true}) {
    EnergyLaw law;
    law.young = 1e6;
    law.damping = law.tangential_ratio = 0;
    law.power = power;
    EngineSettings s;
    s.law = law;
    s.friction = 0;
    s.gravity_y = 0;
    s.shape = ShapeKind::polygon;
    constexpr int kSide = 5;
    constexpr double kCell = 0.024;
    s.cell.periodic = {true, true, false};
    s.cell.edges = Eigen::Vector3d(kSide * kCell, kSide * kCell, 0).asDiagonal();
    Random random(5);
    std::vector<NewGrain> grains;
    GrainExtremes extremes{1e300};
    for (int k = 0; k < kSide * kSide; ++k) {
      NewGrain g;
      g.density = 5000;
      g.outline = scattered(random, 5 + k % 4, 0.011, 1 + 0.1 * (k % 3));
      g.x = (k % kSide + 0.5) * kCell;
      g.y = (k / kSide + 0.5) * kCell;
      g.angle = random.uniform(0, 6);
      g.vx = random.uniform(-0.5, 0.5);
      g.vy = random.uniform(-0.5, 0.5);
      g.spin = random.uniform(-20, 20);
      grains.push_back(g);
      const double mass = g.density * area_of(g.outline), width = edge_width(g.outline);
      extremes.least_mass = std::min(extremes.least_mass, mass);
      extremes.wide_mass = extremes.least_mass;
      extremes.widest_edge = std::max(extremes.widest_edge, width);
      extremes.steepest_edge = 1;  // they are polygons
    }
    s.time_step = 0.1 * stable_time_step(s, extremes);
    const auto engine = make_engine(s);
    for (const NewGrain& g : grains) engine->add(g);
    const auto energy = [&] {
      const Diagnostics d = engine->measure();
      return d.kinetic_energy + d.elastic_energy;
    };
    engine->step(1);
    const double start = energy();
    double worst = 0, first_half = 0, second_half = 0, stored = 0;
    constexpr int kLooks = 200;
    for (int k = 0; k < kLooks; ++k) {
      engine->step(1000000 / kLooks);
      const double off = energy() / start - 1;
      worst = std::max(worst, std::fabs(off));
      (k < kLooks / 2 ? first_half : second_half) += off / (0.5 * kLooks);
      stored = std::max(stored, engine->measure().elastic_energy / start);
    }
    EXPECT_LT(worst, 1e-3) << power;
    EXPECT_LT(std::fabs(second_half - first_half), 3e-4) << power;  // no drift
    EXPECT_GT(stored, 0.02);                                        // they did collide
    std::printf("%s: energy off by at most %.1e, mean %.1e then %.1e; stored up to %.2g\n",
                power ? "power" : "square", worst, first_half, second_half, stored);
  }
}

// Ten blocks face to face, one upon the other, at the step that is allowed.
TEST(EnergyMotionSlow, TenBlocksEdgeOnEdgeComeToRest) {
  for (const bool power : {false, true}) {
    constexpr double kHalf = 0.005;
    EnergyLaw law;
    law.power = power;
    EngineSettings s;
    s.law = law;
    s.shape = ShapeKind::polygon;
    NewGrain g;
    g.density = 5000;
    g.outline = {{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}};
    const double mass = g.density * 4 * kHalf * kHalf;
    GrainExtremes extremes{mass, edge_steepness(g.outline), mass, edge_width(g.outline), mass};
    s.time_step = 0.8 * stable_time_step(s, extremes);
    const auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
    for (int k = 0; k < 10; ++k) {
      g.y = (2 * k + 1) * kHalf + 1e-5 * k;
      g.x = 2e-4 * (k % 3);
      engine->add(g);
    }
    engine->set_background_damping(100);
    engine->step(std::lround(2.0 / s.time_step));
    const Diagnostics d = engine->measure();
    EXPECT_LT(d.unbalanced_force_ratio, 1e-6) << power;
    EXPECT_LT(d.unbalanced_moment_ratio, 1e-6) << power;
    EXPECT_EQ(d.contacts, 10);
    expect_balanced(engine->snapshot(), 1e-6);
  }
}

/// Slender grains (axis ratio 5) fall into a box and are damped: seconds until the mean resultant
/// is below 1e-5 of the mean force, or -1.
double seconds_to_rest(const AnyLaw& law, std::uint64_t seed) {
  EngineSettings s;
  s.law = law;
  s.friction = 0.54;
  s.shape = ShapeKind::polygon;
  Random random(seed);
  std::vector<NewGrain> grains;
  GrainExtremes extremes{1e300};
  double steep = 0, wide = 0;
  for (int k = 0; k < 60; ++k) {
    NewGrain g;
    g.density = 5000;
    g.outline = scattered(random, 8 + k % 5, 0.003 * random.uniform(0.8, 1.2), std::sqrt(5.0));
    g.x = (k % 6 + 0.5) * 0.016;
    g.y = (k / 6 + 0.5) * 0.016;
    g.angle = random.uniform(0, 6);
    grains.push_back(g);
    const double mass = g.density * area_of(g.outline);
    const auto take = [mass](double edge, double& most, double& kept, double& its_mass) {
      if (edge / std::sqrt(mass) <= most) return;
      most = edge / std::sqrt(mass);
      kept = edge;
      its_mass = mass;
    };
    extremes.least_mass = std::min(extremes.least_mass, mass);
    take(edge_steepness(g.outline), steep, extremes.steepest_edge, extremes.steep_mass);
    take(edge_width(g.outline), wide, extremes.widest_edge, extremes.wide_mass);
  }
  s.time_step = 0.8 * stable_time_step(s, extremes);
  const auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.54});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0});
  engine->add_wall({"right", {0.096, 0, 0}, {-1, 0, 0}, 0});
  for (const NewGrain& g : grains) engine->add(g);
  engine->set_background_damping(5);
  while (engine->time() < 6) {
    engine->step(2000);
    if (engine->time() > 0.6) engine->set_background_damping(100);
    const Diagnostics d = engine->measure();
    if (engine->time() > 0.6 && d.unbalanced_force_ratio < 1e-5 &&
        d.unbalanced_moment_ratio < 1e-5) {
      return engine->time();
    }
  }
  return -1;
}

TEST(EnergyMotionSlow, SlenderGrainsComeToRest) {
  EnergyLaw power;
  power.power = true;
  int roul = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const double square_time = seconds_to_rest(EnergyLaw{}, seed),
                 power_time = seconds_to_rest(power, seed),
                 roul_time = seconds_to_rest(OverlapAreaLaw{}, seed);
    EXPECT_GT(square_time, 0) << seed;
    EXPECT_GT(power_time, 0) << seed;
    roul += roul_time > 0;
    std::printf("seed %d: at rest after %.2f s (square), %.2f (power), %.2f (overlap_area)\n",
                static_cast<int>(seed), square_time, power_time, roul_time);
  }
  std::printf("overlap_area: %d of 6 came to rest in 6 s\n", roul);
}

}  // namespace
}  // namespace grainfield::dem
