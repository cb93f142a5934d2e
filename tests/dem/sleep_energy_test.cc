// Grains that fall asleep and wake: the books of energy close, and contacts keep what they remember
// of rolling.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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

/// Grains fall one after another between walls; with `restart` the pour goes on from an image.
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
      const std::string image = engine->image();
      engine = walled();
      engine->restore(image);
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
  const std::string image = engine->image();
  auto again = make_engine(s);
  again->add_wall({"floor", {0, 0, 0}, up(false), 1});
  again->restore(image);
  EXPECT_EQ(again->image(), image);
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
