// What has become of energy, by what took it: each mechanism alone, against what it must take.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/walls/box.h"
#include "tests/dem/bits_scene.h"

namespace grainfield::dem {
namespace {

EngineSettings settings_of(const AnyLaw& law, double step, bool space = false) {
  EngineSettings s;
  s.law = law;
  s.time_step = step;
  s.gravity_y = 0;
  s.energy_balance = true;
  if (space) s.shape = ShapeKind::sphere;
  return s;
}
NewGrain grain(double x, double height, double radius, bool space = false) {
  NewGrain g;
  g.x = x;
  (space ? g.z : g.y) = height;
  g.radius = radius;
  g.density = 2500;
  return g;
}
Wall floor_of(bool space, double friction) {
  return {"floor", {0, 0, 0}, space ? Vec3::UnitZ() : Vec3::UnitY(), friction};
}

TEST(EnergyMechanisms, ABlockThatSlidesLosesAllToFriction) {
  for (const bool space : {false, true}) {
    const double k = 1e5, mu = 0.4, v = 0.3, g = 9.81;
    EngineSettings s = settings_of(LinearLaw{k, 3e4, 0, 0}, 1e-5, space);
    (space ? s.gravity_z : s.gravity_y) = -g;
    const auto engine = make_engine(s);
    engine->add_wall(floor_of(space, mu));
    NewGrain block = grain(0, 0.01, 0.01, space);
    block.mass = 0.02;
    (space ? block.z : block.y) -= block.mass * g / k;  // at rest on its spring
    block.rotates = false;
    block.vx = v;
    engine->add(block);
    const double kinetic = 0.5 * block.mass * v * v, stored = 0.5 * std::pow(0.02 * g, 2) / k;
    const double stopped = v / (mu * g);
    engine->step(std::lround(0.5 * stopped / s.time_step));
    const Diagnostics half = engine->measure();
    // Half of the way in time is three quarters of it in length. The spring holds (mu N)^2 / 2 kt.
    EXPECT_NEAR(half.contact_losses.friction, 0.75 * kinetic, 2e-3 * kinetic);
    engine->step(std::lround(stopped / s.time_step));
    const Diagnostics d = engine->measure();
    EXPECT_NEAR(d.contact_losses.friction + d.kinetic_energy + d.elastic_energy - stored, kinetic,
                1e-5 * kinetic);
    EXPECT_GT(d.contact_losses.friction, 0.98 * kinetic);
    EXPECT_NEAR(d.contact_losses.dashpot, 0, 1e-12 * kinetic);
    EXPECT_NEAR(d.contact_losses.law, 0, 1e-5 * kinetic);
    EXPECT_EQ(d.contact_losses.rolling, 0);
    EXPECT_NEAR(d.brought_energy, kinetic + stored, 1e-6 * kinetic);
  }
}

TEST(EnergyMechanisms, ACollisionLosesAllInTheDashpot) {
  for (const bool space : {false, true}) {
    EngineSettings s = settings_of(LinearLaw{1e6, 3e5, 600, 300}, 1e-6, space);
    const auto engine = make_engine(s);
    engine->add_wall(floor_of(space, 0.5));
    NewGrain ball = grain(0, 0.010001, 0.01, space);
    (space ? ball.vz : ball.vy) = -0.5;
    engine->add(ball);
    const double kinetic = engine->measure().kinetic_energy;
    engine->step(6000);
    const Diagnostics d = engine->measure();
    EXPECT_GT(kinetic - d.kinetic_energy, 0.1 * kinetic);
    // Touch and parting fall between two steps: an error of first order.
    EXPECT_NEAR(d.contact_losses.dashpot, kinetic - d.kinetic_energy, 1e-4 * kinetic);
    EXPECT_NEAR(d.contact_losses.friction, 0, 1e-12 * kinetic);
    EXPECT_NEAR(d.contact_losses.law, 0, 1e-4 * kinetic);
  }
}

TEST(EnergyMechanisms, WhatRollsLosesAllToRolling) {
  for (const bool space : {false, true}) {
    const double k = 1e5, g = 9.81, v = 0.2, mass = 0.02, r = 0.01;
    EngineSettings s = settings_of(LinearLaw{k, 3e4, 0, 0}, 1e-5, space);
    s.rolling.friction = 0.05;
    s.rolling.stiffness = 1e4;
    (space ? s.gravity_z : s.gravity_y) = -g;
    const auto engine = make_engine(s);
    engine->add_wall(floor_of(space, 0.8));
    NewGrain wheel = grain(0, r - mass * g / k, r, space);
    wheel.mass = mass;
    wheel.moments.fill((space ? 0.4 : 0.5) * mass * r * r);
    wheel.vx = v;
    (space ? wheel.spin_y : wheel.spin) = (space ? 1 : -1) * v / wheel.radius;
    engine->add(wheel);
    const double kinetic = engine->measure().kinetic_energy;
    EXPECT_NEAR(kinetic, (space ? 0.7 : 0.75) * mass * v * v, 1e-9);
    engine->step(std::lround(0.2 / s.time_step));
    const Diagnostics d = engine->measure();
    EXPECT_GT(d.contact_losses.rolling, 0.3 * kinetic);
    EXPECT_NEAR(d.contact_losses.rolling + d.kinetic_energy, kinetic, 0.01 * kinetic);
    EXPECT_LT(std::fabs(d.contact_losses.friction), 0.01 * kinetic);
    EXPECT_NEAR(d.energy_balance(), 0, 1e-5 * kinetic);
  }
}

// Undamped, frictionless polygons that meet on edges and corners: all that changes is the law's.
double work_of_law(const AnyLaw& law, double step) {
  EngineSettings s = settings_of(law, step);
  s.shape = ShapeKind::polygon;
  s.friction = 0;
  const auto engine = make_engine(s);
  for (const Wall& w : box_walls({0, 0, 0}, {0.05, 0.05, 0}, 0, 2)) engine->add_wall(w);
  Random random(3);
  for (int k = 0; k < 4; ++k) {
    NewGrain g = grain(0.0125 + 0.025 * (k % 2), 0.0125 + 0.025 * (k / 2), 0.01);
    g.outline = k % 2 == 0 ? bits::rectangle(0.011, 0.005) : bits::heptagon(random, 0.01);
    g.angle = random.uniform(0, 6);
    g.vx = random.uniform(-0.3, 0.3);
    g.vy = random.uniform(-0.3, 0.3);
    engine->add(g);
  }
  const double kinetic = engine->measure().kinetic_energy;
  engine->step(std::lround(0.2 / step));
  const Diagnostics d = engine->measure();
  EXPECT_NEAR(d.contact_losses.lost(), 0, 1e-9 * kinetic);
  EXPECT_NEAR(d.kinetic_energy + d.elastic_energy - kinetic, d.contact_losses.law, 2e-3 * kinetic);
  return d.contact_losses.law / kinetic;
}

TEST(EnergyMechanisms, ALawThatIsAGradientDoesNoWork) {
  EnergyLaw energy;
  energy.young = 1e5;
  energy.damping = 0;
  energy.tangential_ratio = 0;
  OverlapAreaLaw area{1e5, 0, 0};
  const double coarse = work_of_law(energy, 8e-6), fine = work_of_law(energy, 2e-6);
  EXPECT_LT(std::fabs(fine), 2e-3);
  EXPECT_LT(std::fabs(fine), 0.5 * std::fabs(coarse) + 1e-5);
  EXPECT_GT(std::fabs(work_of_law(area, 2e-6)), 0.02);
}

// A sphere of great mass under a lid: pressed, sheared without sliding, pressed deeper.
TEST(EnergyMechanisms, ASpringThatStiffensTakesOrMakesEnergy) {
  for (const bool displacement : {false, true}) {
    HertzLaw law;
    law.young = 1e8;
    law.displacement = displacement;
    const auto engine = make_engine(settings_of(law, 1e-5, true));
    Wall lid{"lid", {0, 0, 0.01}, {0, 0, -1}, 10};
    engine->add_wall(lid);
    NewGrain ball = grain(0, 0, 0.01, true);
    ball.mass = 1e9;
    ball.rotates = false;
    engine->add(ball);
    const auto move = [&](double x, double z, double time) {
      engine->set_wall_motion("lid", {{x / time, 0, z / time}, {0, 0, 0}, {}, 0});
      engine->step(std::lround(time / 1e-5));
    };
    const double first = 1e-4, second = 2.25e-4, slip = 2e-5;
    move(0, -first, 0.1);
    move(slip, 0, 0.1);
    const Diagnostics sheared = engine->measure();
    const double kt = 8 * law.effective_shear() * std::sqrt(0.01 * first);
    EXPECT_NEAR(sheared.contact_losses.law, 0, 1e-4 * kt * slip * slip);
    move(0, first - second, 0.1);
    const Diagnostics d = engine->measure();
    // The radius has grown to 3/2 of it. `force`: its energy falls by as much; `displacement`:
    // rises.
    const double held = 0.5 * kt * slip * slip, ratio = std::sqrt(second / first);
    const double made = held * (displacement ? ratio - 1 : 1 / ratio - 1);
    EXPECT_NEAR(d.contact_losses.law, made, 1e-3 * held) << displacement;
    EXPECT_NEAR(d.contact_losses.lost(), 0, 1e-3 * held);
  }
}

TEST(EnergyMechanisms, GrainsBringEnergyAndGravityChanges) {
  EngineSettings s = settings_of(LinearLaw{1e5, 3e4, 200, 100}, 1e-5);
  s.gravity_y = -9.81;
  const auto engine = make_engine(s);
  engine->add_wall(floor_of(false, 0.5));
  NewGrain g = grain(0, 0.0099, 0.01);
  engine->add(g);
  engine->step(1000);
  const double first = engine->measure().brought_energy;
  EXPECT_NEAR(first, 0.5 * 1e5 * 1e-8, 1e-12);  // its overlap with the floor
  g.x = 0.003;
  g.y = 0.05;
  g.vy = -1;
  g.spin = 20;
  const double mass = 2500 * 3.14159265358979 * 1e-4;
  const double kinetic = 0.5 * mass + 0.25 * mass * 1e-4 * 400;
  engine->add(g);
  EXPECT_NEAR(engine->measure().brought_energy, first + kinetic, 1e-9);
  engine->step(4000);
  const Diagnostics before = engine->measure();
  engine->set_gravity(2, -5);
  const Diagnostics after = engine->measure();
  EXPECT_NE(after.potential_energy, before.potential_energy);
  EXPECT_NEAR(after.gravity_work, before.gravity_work, 1e-12);
  engine->step(20000);
  const Diagnostics end = engine->measure();
  EXPECT_NE(end.gravity_work, before.gravity_work);
  EXPECT_NEAR(end.energy_balance(), 0, 1e-4 * end.size_of_work());
}

}  // namespace
}  // namespace grainfield::dem
