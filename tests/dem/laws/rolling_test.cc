// Resistance against rolling and twisting: slopes, frequencies, caps, books, bits.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/damaged_files.h"
#include "tests/dem/rolling_scene.h"

namespace grainfield::dem {
namespace {

// A grain on a slope rolls beyond tan(theta) = mu_r R/arm, with the acceleration that is left; the
// arm is the radius less the overlap.
TEST(Rolling, StopsOnSlopesUpToItsCoefficient) {
  for (const bool space : {false, true}) {
    const double mass = mass_of(space), mu = 0.2, k = space ? 1e3 : 1e5;
    const double share = space ? 0.4 : 0.5;  // moment over m R^2
    const RollingLaw rolling{k, 2 * std::sqrt(k * mass), mu};
    for (const double ratio : {0.99, 1.01, 2.0}) {
      EngineSettings s = settings_of(space, rolling);
      const double angle = std::atan(ratio * mu);
      s.gravity_x = kGravity * std::sin(angle);
      (space ? s.gravity_z : s.gravity_y) = -kGravity * std::cos(angle);
      const double push = mass * kGravity * std::cos(angle);
      const auto engine = on_floor(s, push);
      engine->step(50000);
      const double x = engine->snapshot().grains[0].position.x();
      const double speed = engine->snapshot().grains[0].velocity.x();
      engine->step(10000);
      const double gained = engine->snapshot().grains[0].velocity.x() - speed;
      if (ratio < 1) {
        EXPECT_LT(x, 0.1 * kRadius) << space;
        EXPECT_LT(std::fabs(speed), 1e-9) << space;
        EXPECT_NEAR(engine->snapshot().grains[0].position.x(), x, 1e-9) << space;
        continue;
      }
      const double arm = kRadius - push / (space ? 1e4 : 1e6);
      const double left = mass * s.gravity_x - kRadius / arm * mu * push;
      const double a = left / (mass * (1 + share * kRadius * kRadius / (arm * arm)));
      EXPECT_NEAR(gained / 0.1, a, 1e-4 * kGravity * mu) << space << ratio;
      EXPECT_GT(x, (ratio - 1) * 10 * kRadius);
    }
  }
}

// About the contact a grain swings in its rolling spring with omega^2 = k_r R^2 / (I + m arm^2),
// and keeps its energy.
TEST(Rolling, SpringHasItsFrequencyAndKeepsItsEnergy) {
  for (const bool space : {false, true}) {
    const double mass = mass_of(space), k = space ? 0.5 : 50, push = mass * kGravity;
    EngineSettings s = settings_of(space, {k, 0, 1});
    s.law = LinearLaw{space ? 1e4 : 1e6, space ? 4e3 : 4e5, 0, 0};
    s.time_step = 2e-6;
    (space ? s.gravity_z : s.gravity_y) = -kGravity;
    s.energy_balance = true;
    const auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, up(space), 1});
    NewGrain g;
    g.radius = kRadius;
    g.density = 2500;
    (space ? g.z : g.y) = kRadius - push / (space ? 1e4 : 1e6);
    const double arm = kRadius - push / (space ? 1e4 : 1e6), spin = 0.5;
    g.vx = spin * arm;
    (space ? g.spin_y : g.spin) = space ? spin : -spin;
    engine->add(g);
    const double inertia = (space ? 0.4 : 0.5) * mass * kRadius * kRadius + mass * arm * arm;
    const double omega = kRadius * std::sqrt(k / inertia);
    const long quarter = std::lround(0.5 * std::numbers::pi / omega / s.time_step);
    engine->step(1);
    const Diagnostics first = engine->measure();
    engine->step(quarter - 1);
    const Diagnostics turned = engine->measure();
    // At the turning point all is in the spring, beside the weight's.
    const double kinetic = 0.5 * inertia * spin * spin;
    EXPECT_LT(turned.kinetic_energy, 1e-4 * kinetic) << space;
    EXPECT_NEAR(turned.elastic_energy - first.elastic_energy, kinetic, 1e-3 * kinetic) << space;
    EXPECT_NEAR(turned.energy_balance(), first.energy_balance(), 1e-5 * kinetic) << space;
    EXPECT_NEAR(turned.dissipated_energy(), 0, 1e-4 * kinetic) << space;
    const Contact c = engine->snapshot().contacts.at(0);
    EXPECT_NEAR(std::fabs(c.rolling_spring.x()), k * kRadius * spin / omega,
                1e-3 * k * kRadius * spin / omega);
  }
}

// A sphere that spins on the spot is slowed by mu_tw F_n and stops.
TEST(Twisting, StopsASphereThatSpinsOnThePlane) {
  const double mass = mass_of(true), push = mass * kGravity, mu = 5e-4, spin = 20;
  const double moment = 0.4 * mass * kRadius * kRadius;
  RollingLaw rolling;
  rolling.twisting_stiffness = 1e-3;
  rolling.twisting_damping = 2 * std::sqrt(1e-3 * moment);
  rolling.twisting_friction = mu;
  EngineSettings s = settings_of(true, rolling);
  s.gravity_z = -kGravity;
  const auto engine = on_floor(s, push, spin);
  const double stop = spin * moment / (mu * push);
  engine->step(std::lround(0.5 * stop / s.time_step));
  Snapshot now = engine->snapshot();
  // Until the cap is reached, it is spun for some 1/100 of that time.
  EXPECT_NEAR(now.grains[0].angular_velocity.z(), 0.5 * spin, 1e-2 * spin);
  EXPECT_NEAR(now.walls[0].torque.z(), mu * push, 1e-9 * mu * push);  // the cap, on the floor
  EXPECT_LE(std::fabs(now.contacts[0].twisting_spring), mu * push);
  engine->step(std::lround(2 * stop / s.time_step));
  now = engine->snapshot();
  EXPECT_LT(now.grains[0].angular_velocity.norm(), 1e-6 * spin);
  EXPECT_LT(now.grains[0].position.head<2>().norm(), 1e-12);
}

std::uint64_t hash_with_rolling(const Snapshot& s) {
  bits::Hash h;
  h.add(bits::hash_of(s));
  for (const Contact& c : s.contacts) {
    h.add(c.rolling_spring);
    h.add(c.twisting_spring);
  }
  return h.value();
}

TEST(Rolling, SameBitsOnAnyThreadsAndAfterARestart) {
  for (const bool space : {false, true}) {
    const bits::Scene scene = crowd(space);
    const Snapshot one = bits::end_of(scene, 1);
    int springs = 0, twists = 0;
    for (const Contact& c : one.contacts) {
      springs += !c.rolling_spring.isZero(0);
      twists += c.twisting_spring != 0;
    }
    EXPECT_GT(springs, 40);
    EXPECT_EQ(twists > 40, space);
    const std::uint64_t hash = hash_with_rolling(one);
    EXPECT_EQ(hash_with_rolling(bits::end_of(scene, 2)), hash);
    EXPECT_EQ(hash_with_rolling(bits::end_of(scene, 3, 3333, 2)), hash);
    EXPECT_EQ(hash_with_rolling(bits::end_of(scene, 1, 4000, 3)), hash);
    EXPECT_NE(bits::hash_of(bits::end_of(crowd(space, false), 1)), bits::hash_of(one));
    bits::Scene brief = scene;
    brief.steps = 1000;
    EXPECT_EQ(hash_with_rolling(bits::end_of(brief, 8)), hash_with_rolling(bits::end_of(brief, 1)));
  }
}

// What rolling loses and stores is in the books, with a wall that turns.
TEST(Rolling, IsInTheEnergyBalance) {
  for (const bool space : {false, true}) {
    bits::Scene scene = crowd(space);
    if (space) {  // a law that is a gradient
      for (MaterialPair& pair : scene.settings.material_pairs)
        pair.law = LinearLaw{1e3, 4e2, 100, 50};
    }
    scene.settings.energy_balance = true;
    const auto engine = make_engine(scene.settings);
    for (const Wall& wall : scene.walls) engine->add_wall(wall);
    for (const NewGrain& g : scene.grains) engine->add(g);
    engine->step(1);
    const Diagnostics before = engine->measure();
    engine->step(20000);
    const Diagnostics after = engine->measure();
    EXPECT_GT(after.dissipated_energy(), 0.1 * before.kinetic_energy);
    EXPECT_NEAR(after.energy_balance(), before.energy_balance(), 2e-3 * after.dissipated_energy())
        << space;
  }
}

TEST(Rolling, GoesOnFromASnapshotFile) {
  for (const bool space : {false, true}) {
    bits::Scene scene = crowd(space);
    scene.walls.pop_back();  // walls at rest: those that move have a velocity to give anew
    scene.walls.push_back({"floor", -0.04 * up(space), up(space), 0.4});
    scene.walls.push_back({"left", {-0.04, 0, 0}, {1, 0, 0}, 0.4});
    scene.walls.push_back({"right", {0.04, 0, 0}, {-1, 0, 0}, 0.4});
    if (space) scene.walls.push_back({"back", {0, 0.02, 0}, {0, -1, 0}, 0.1});
    if (space) scene.walls.erase(scene.walls.begin());
    // At rest, where the cap is the same before and after.
    scene.steps = 20000;
    scene.events.emplace_back(3000, [](Engine& e) { e.set_background_damping(200); });
    const Snapshot end = bits::end_of(scene, 1);
    const testing::TestFolder folder;
    write_snapshot(folder / "s.h5", "/s", end);
    Snapshot read = read_snapshot(folder / "s.h5", "/s");
    const auto springs = [](const Snapshot& s, double& size) {
      std::vector<double> out;
      for (const Contact& c : s.contacts) {
        for (const double v : c.rolling_spring) out.push_back(v);
        out.push_back(c.twisting_spring);
        size = std::max(size, c.rolling_spring.norm());
      }
      return out;
    };
    double size = 0;
    const std::vector<double> told = springs(end, size);
    EXPECT_EQ(springs(read, size), told);
    // Without dashpots only what is beyond its cap changes.
    for (Grain& g : read.grains) {
      g.velocity.setZero();
      g.angular_velocity.setZero();
      g.spin = 0;
    }
    EngineSettings s = scene.settings;
    s.time_step = 1e-12;  // nothing moves: what is remembered is seen
    const auto engine = make_engine(s, read);
    engine->step(1);
    const std::vector<double> now = springs(engine->snapshot(), size);
    ASSERT_EQ(now.size(), told.size());
    int held = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const Contact& c = end.contacts[k / 4];
      if (!(c.rolling_spring.norm() < 0.09 * c.normal_force)) continue;
      if (!(std::fabs(c.twisting_spring) < 9e-4 * c.normal_force)) continue;
      EXPECT_NEAR(now[k], told[k], 1e-6 * size) << k;
      held += told[k] != 0;
    }
    EXPECT_GT(held, 40);
  }
}

TEST(Rolling, WhatDoesNotFitIsRefused) {
  const auto refusal = [](auto change) {
    EngineSettings s = settings_of(false, {1e5, 10, 0.1});
    change(s);
    try {
      make_engine(s)->set_sleep(true);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal([](EngineSettings& s) { s.sleep.on = true; }), "accepted");
  EXPECT_EQ(refusal([](EngineSettings& s) { s.rolling.friction = 0; }), "accepted");
  EXPECT_EQ(refusal([](EngineSettings& s) { s.rolling.friction = -1; }),
            "material.rolling_friction: found -1, allowed: 0 or more");
  EXPECT_EQ(refusal([](EngineSettings& s) { s.rolling.twisting_damping = NAN; }),
            "material.twisting_damping: found nan, allowed: 0 or more");
  EXPECT_EQ(refusal([](EngineSettings& s) {
              s.rolling = {0, 0, 0.5};
            }),
            "material.rolling_friction: found 0.5 without rolling_stiffness and rolling_damping, "
            "allowed: above 0 with one of them above 0");
  EXPECT_EQ(refusal([](EngineSettings& s) { s.rolling = {0, 0, 0, 1, 1, 0.5}; }),
            "material.twisting_friction: found 0.5, allowed in the plane: 0");
  EXPECT_EQ(refusal([](EngineSettings& s) {
              s.law = OverlapAreaLaw{};
              s.shape = ShapeKind::polygon;
            }),
            "material.rolling_friction: found above 0, allowed for polygons: 0 (their corners "
            "resist rolling)");
}

// A twelfth of the springs' own limits is what the bound leaves; twice the stiffness halves dt^2.
TEST(Rolling, BoundsTheTimeStep) {
  EngineSettings s = settings_of(true, {});
  const double free = stable_time_step(s, 1e-3, kRadius);
  s.rolling = {1e6, 0, 0.1};
  const double stiff = stable_time_step(s, 1e-3, kRadius);
  EXPECT_LT(stiff, free);
  EXPECT_NEAR(stiff, 0.1 * std::numbers::pi * std::sqrt(1e-3 / 1e6), 1e-9 * stiff);
  s.rolling = {1, 1e3, 0.1};
  EXPECT_LT(stable_time_step(s, 1e-3, kRadius), 1e-3 / (20 * 1e3) * 1.0001);
  s.rolling = {1, 0, 0, 1e6 * kRadius * kRadius, 0, 0.1};
  EXPECT_NEAR(stable_time_step(s, 1e-3, kRadius), stiff, 1e-9 * stiff);
}

}  // namespace
}  // namespace grainfield::dem
