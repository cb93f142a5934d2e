// Grains that fall asleep and wake: the books of energy close, and contacts keep what they remember
// of rolling.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/dem/mesh_scene.h"
#include "tests/dem/rolling_scene.h"

namespace grainfield::dem {
namespace {

EngineSettings pouring(bool space) {
  const double k = space ? 0.01 : 1;
  RollingLaw rolling{2e5 * k, 20 * k, 0.1};
  if (space) rolling = {2e3, 0.2, 0.1, 1e-2, 1e-6, 1e-3};
  EngineSettings s = settings_of(space, rolling);
  s.friction = 0.5;
  (space ? s.gravity_z : s.gravity_y) = -kGravity;
  s.sleep.on = true;
  s.energy_balance = true;
  return s;
}

/// Sleepers that may stop while they move.
EngineSettings loose(EngineSettings s) {
  s.sleep.quiet_time = 1e-3;
  s.sleep.quiet_move = 0.2;
  s.sleep.quiet_creep = 100;
  s.sleep.quiet_force = 1;
  s.sleep.wake_force = 1.2;
  return s;
}

struct Poured {
  Diagnostics end;
  int fell_asleep = 0, woke = 0;  // at least
  std::vector<double> state;
};

/// Grains fall one after another between walls; with `restart` the pour goes on from a checkpoint.
Poured pour(const EngineSettings& s, int grains, double interval, int restart = -1) {
  const bool space = s.shape == ShapeKind::sphere;
  const auto walled = [&] {
    auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, up(space), 0.5});
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.5});
    engine->add_wall({"right", {0.08, 0, 0}, {-1, 0, 0}, 0.5});
    if (space) {
      engine->add_wall({"front", {0, 0, 0}, {0, 1, 0}, 0.5});
      engine->add_wall({"back", {0, 0.04, 0}, {0, -1, 0}, 0.5});
    }
    return engine;
  };
  auto engine = walled();
  Random random(7);
  Poured out;
  for (int k = 0; k < grains; ++k) {
    NewGrain g;
    g.radius = random.uniform(0.007, 0.01);
    g.density = 2500;
    g.x = random.uniform(0.015, 0.065);
    g.y = space ? random.uniform(0.015, 0.025) : 0.16;
    if (space) g.z = 0.16;
    engine->add(g);
    int before = engine->measure().awake;
    for (int part = 0; part < 20; ++part) {
      engine->step(std::lround(interval / 20 / s.time_step));
      const int now = engine->measure().awake;
      out.fell_asleep += std::max(0, before - now);
      out.woke += std::max(0, now - before);
      before = now;
    }
    if (k == restart) {
      const std::string checkpoint = engine->checkpoint();
      engine = walled();
      engine->restore(checkpoint);
    }
  }
  out.end = engine->measure();
  const Snapshot last = engine->snapshot();
  for (const Grain& g : last.grains) {
    out.state.insert(out.state.end(), {g.position.x(), g.position.y(), g.position.z(), g.spin});
  }
  for (const Contact& c : last.contacts) {
    out.state.insert(out.state.end(), {c.force.norm(), c.rolling_spring.norm(), c.spring});
  }
  out.state.insert(out.state.end(), {out.end.energy_balance(), out.end.stopped_energy});
  return out;
}

TEST(SleepEnergy, TheBooksOfAPourClose) {
  for (const bool space : {false, true}) {
    const Poured poured = pour(pouring(space), space ? 24 : 16, 0.1);
    const Diagnostics& d = poured.end;
    EXPECT_GE(poured.fell_asleep, 3) << space;
    EXPECT_GE(poured.woke, 3) << space;
    EXPECT_LT(std::fabs(d.energy_balance()), 1e-3 * d.size_of_work()) << space;
    EXPECT_GT(d.stopped_energy, 0) << space;
    EXPECT_LT(d.stopped_energy, 1e-3 * d.size_of_work()) << space;
    EXPECT_GT(d.contact_losses.rolling, 0) << space;
    RecordProperty(space ? "space" : "plane",
                   std::to_string(d.energy_balance() / d.size_of_work()));
  }
}

// Sleepers that may stop while they move: what they lose counts.
TEST(SleepEnergy, WhatStopsIsBooked) {
  const EngineSettings s = loose(pouring(false));
  const Diagnostics d = pour(s, 16, 0.1).end;
  EXPECT_GT(d.stopped_energy, 2e-3 * d.size_of_work());
  EXPECT_LT(std::fabs(d.energy_balance()), 0.2 * d.stopped_energy);
}

// A disk on a slope within its resistance against rolling sleeps on its spring, and goes on from
// it.
TEST(SleepEnergy, FrozenContactsRememberRolling) {
  EngineSettings s = settings_of(false, {1e5, 50, 0.3});
  s.sleep.on = true;
  s.gravity_x = kGravity * std::sin(0.1);
  s.gravity_y = -kGravity * std::cos(0.1);
  const auto engine = on_floor(s, mass_of(false) * kGravity);
  engine->set_background_damping(50);
  engine->step(100000);
  ASSERT_EQ(engine->measure().awake, 0);
  const Snapshot asleep = engine->snapshot();
  ASSERT_EQ(asleep.contacts.size(), 1U);
  // The moment of gravity about the contact: m g R sin over R.
  const double held = mass_of(false) * kGravity * std::sin(0.1);
  EXPECT_NEAR(asleep.contacts[0].rolling_spring.norm(), held, 0.02 * held);
  const std::string checkpoint = engine->checkpoint();
  auto again = make_engine(s);
  again->add_wall({"floor", {0, 0, 0}, up(false), 1});
  again->restore(checkpoint);
  EXPECT_EQ(again->checkpoint(), checkpoint);
  for (Engine* e : {engine.get(), again.get()}) {
    e->set_sleep(false);
    e->step(1);
    const Snapshot awake = e->snapshot();
    ASSERT_EQ(awake.contacts.size(), 1U);
    EXPECT_NEAR(awake.contacts[0].rolling_spring.norm(), held, 0.02 * held);
    e->step(20000);
    const Snapshot later = e->snapshot();
    EXPECT_LT((later.grains[0].position - asleep.grains[0].position).norm(), 1e-3 * kRadius);
  }
}

// A stays awake on B, which stops while both move: what B has brought into their contact in that
// step counts, and so does what the forces would have done to B until its end. Without either, the
// step leaves half of dt F v and more.
TEST(SleepEnergy, TheStepInWhichAGrainStopsIsBooked) {
  for (const bool space : {false, true}) {
    EngineSettings s = loose(settings_of(space, {}));
    s.sleep.on = s.energy_balance = true;
    (space ? s.gravity_z : s.gravity_y) = -kGravity;
    const double weight = mass_of(space) * kGravity;
    const auto engine = on_floor(s, 2 * weight);
    NewGrain g;
    g.radius = kRadius;
    g.density = 2500;
    const double depth = weight / std::get<LinearLaw>(s.law).normal_stiffness;
    (space ? g.z : g.y) = 3 * kRadius - 3 * depth;
    (space ? g.vz : g.vy) = -0.05;
    engine->apply({engine->add(g)});  // no force, but who is loaded does not sleep
    double before = 0, most = 0, at_stop = -1;
    Snapshot moving;
    for (int step = 0; step < 1000 && at_stop < 0; ++step) {
      moving = engine->snapshot();
      before = engine->measure().energy_balance();
      engine->step(1);
      const Diagnostics now = engine->measure();
      const double jump = std::fabs(now.energy_balance() - before);
      if (now.awake == 1)
        at_stop = jump;
      else
        most = std::max(most, jump);
    }
    ASSERT_GE(at_stop, 0) << space;
    double pressed = 0;
    for (const Contact& c : moving.contacts) {
      if (c.j >= 0) pressed = c.force.norm();
    }
    const double speed = moving.grains[0].velocity.norm();
    ASSERT_GT(pressed, weight) << space;
    ASSERT_GT(speed, 1e-3) << space;
    EXPECT_LT(at_stop, 0.05 * s.time_step * pressed * speed) << space;
    RecordProperty(space ? "space" : "plane",
                   std::to_string(at_stop / (s.time_step * pressed * speed)));
  }
}

// A sphere lies in the edge of a mesh until its weight turns and takes it off the floor, the
// contact listed first: the other one keeps its place in the list. Asleep and awake again it holds
// what it remembers of rolling, by which it hangs, and its account.
TEST(SleepEnergy, AContactWithAMeshStaysTheSameAsleep) {
  EngineSettings s = settings_of(true, {300, 0.1, 0.5});
  s.gravity_y = -3;
  s.gravity_z = -kGravity;
  s.sleep.on = s.energy_balance = true;
  s.sleep.quiet_time = 5e-3;  // it is awake while it lies on the floor
  const auto engine = make_engine(s);
  Wall box{"box", {0, 0, 0}, {0, 0, 1}, 1, "mesh"};
  box.triangles = box_mesh({0, 0, 0}, {1, 1, 1}, true);
  engine->add_wall(box);
  const double depth = mass_of(true) / 1e4;  // by 1 m/s2
  NewGrain g;
  g.radius = kRadius;
  g.density = 2500;
  g.x = 0.4;
  g.y = kRadius - 3 * depth;
  g.z = kRadius - kGravity * depth;
  engine->add(g);
  engine->step(200);
  ASSERT_EQ(engine->snapshot().contacts.size(), 2U);
  EXPECT_EQ(engine->snapshot().contacts[0].normal, Vec3(0, 0, -1));  // towards the wall
  engine->set_gravity(0, -kGravity, 0.5);
  engine->set_background_damping(50);
  Diagnostics awake = engine->measure();
  for (int step = 0; step < 200000 && engine->measure().awake > 0; step += 10) {
    awake = engine->measure();
    engine->step(10);
  }
  const Snapshot asleep = engine->snapshot();
  ASSERT_EQ(engine->measure().awake, 0);
  ASSERT_EQ(asleep.contacts.size(), 1U);
  EXPECT_EQ(asleep.contacts[0].normal, Vec3(0, -1, 0));
  // The moment of the weight about the contact, over R, but for what sleeping may hide of the load.
  const double held = mass_of(true) * 0.5, hidden = s.sleep.quiet_force * mass_of(true) * kGravity;
  EXPECT_NEAR(asleep.contacts[0].rolling_spring.norm(), held, hidden);
  const double stored = engine->measure().elastic_energy;
  EXPECT_NEAR(stored, awake.elastic_energy, 1e-3 * stored);
  EXPECT_NEAR(engine->measure().energy_balance(), awake.energy_balance(), 1e-3 * stored);
  engine->set_sleep(false);
  engine->step(1);
  EXPECT_LT(
      (engine->snapshot().contacts.at(0).rolling_spring - asleep.contacts[0].rolling_spring).norm(),
      1e-3 * held);
  EXPECT_NEAR(engine->measure().energy_balance(), awake.energy_balance(), 1e-3 * stored);
  engine->step(20000);
  EXPECT_LT((engine->snapshot().grains[0].position - asleep.grains[0].position).norm(),
            1e-3 * kRadius);
}

TEST(SleepEnergy, GoesOnBitForBit) {
  for (const bool space : {false, true}) {
    const EngineSettings s = loose(pouring(space));
    const Poured whole = pour(s, 8, 0.1), parted = pour(s, 8, 0.1, 5);
    EXPECT_GT(whole.fell_asleep, 3) << space;
    EXPECT_TRUE(whole.state == parted.state) << space;
  }
}

}  // namespace
}  // namespace grainfield::dem
