// Sleeping grains: they stay where they are, wake when they must, and change nothing that counts.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/dem/polygon_engine_scene.h"

namespace grainfield::dem {
namespace {

double ground_force(const Snapshot& s) {
  double sum = 0;
  for (const Contact& c : s.contacts) {
    if (c.j < 0) sum += c.force.y();
  }
  return sum;
}

double weight(const Snapshot& s) {
  double sum = 0;
  for (const Grain& g : s.grains) sum += g.mass * 9.81;
  return sum;
}

/// Sleepers that hide much: scenes in which many sleep while others still swing.
SleepSettings loose(SleepSettings s) {
  s.quiet_creep = 2;
  s.quiet_force = 0.2;
  s.wake_force = 0.3;
  s.wake_levels = 1e3;
  return s;
}

TEST(Sleep, SettledBoxFallsAsleepAndKeepsItsForces) {
  const auto engine = polygon_box(polygon_settings(1, true), 8, 6);
  engine->step(60000);
  const Diagnostics asleep = engine->measure();
  EXPECT_LE(asleep.awake, 4);
  const Snapshot before = engine->snapshot();
  // Each grain fell asleep in balance to quiet_force = 0.015 of its load, in any direction.
  EXPECT_NEAR(ground_force(before), weight(before), 0.01 * weight(before));
  engine->step(1000);
  const Snapshot after = engine->snapshot();
  ASSERT_EQ(before.contacts.size(), after.contacts.size());
  // Awake again, every spring is there: the packing goes on from the same forces.
  engine->set_sleep(false);
  engine->set_background_damping(20);
  engine->step(1);
  EXPECT_EQ(engine->measure().awake, 48);
  const Snapshot awake = engine->snapshot();
  double largest = 0;
  for (const Contact& c : after.contacts) largest = std::max(largest, std::fabs(c.spring));
  EXPECT_GT(largest, 0.1);  // N
  ASSERT_EQ(awake.contacts.size(), after.contacts.size());
  for (std::size_t k = 0; k < after.contacts.size(); ++k) {
    ASSERT_EQ(awake.contacts[k].i, after.contacts[k].i);
    ASSERT_EQ(awake.contacts[k].j, after.contacts[k].j);
    EXPECT_NEAR(awake.contacts[k].spring, after.contacts[k].spring, 0.01 * largest) << k;
  }
  EXPECT_NEAR(ground_force(engine->snapshot()), ground_force(after), 0.05 * weight(after));
  engine->step(30000);
  EXPECT_LT(engine->measure().unbalanced_force_ratio, 1e-6);
  const Snapshot rest = engine->snapshot();
  EXPECT_NEAR(ground_force(rest), weight(rest), 1e-5 * weight(rest));
  for (std::size_t k = 0; k < rest.grains.size(); ++k) {
    EXPECT_LT((rest.grains[k].position - after.grains[k].position).norm(),
              0.05 * rest.grains[k].radius);
  }
}

TEST(Sleep, ImpactAndLostSupportWake) {
  const Outline block{{-0.02, -0.01}, {0.02, -0.01}, {0.02, 0.01}, {-0.02, 0.01}};
  const auto tower = [&](bool second) {
    EngineSettings s = polygon_settings(1, true);
    auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
    NewGrain g;
    g.density = 5000;
    g.outline = block;
    g.y = 0.01;
    engine->add(g);
    g.y = 0.03;
    if (second) engine->add(g);
    engine->step(5000);
    EXPECT_EQ(engine->measure().awake, 0);
    return engine;
  };
  // A block dropped on the sleeping tower wakes it, and all come to sleep again with their weight.
  auto hit = tower(true);
  NewGrain falling;
  falling.density = 5000;
  falling.outline = block;
  falling.x = 0.005;
  falling.y = 0.08;
  hit->add(falling);
  bool woke = false;
  for (int k = 0; k < 200; ++k) {
    hit->step(50);
    woke |= hit->measure().awake == 3;
  }
  EXPECT_TRUE(woke);
  hit->step(20000);
  EXPECT_EQ(hit->measure().awake, 0);
  const Snapshot s = hit->snapshot();
  EXPECT_NEAR(ground_force(s), weight(s), 0.01 * weight(s));

  // A block pushed against the lower one at speed: the upper one loses its balance and follows.
  auto pushed = tower(true);
  const double before = pushed->snapshot().grains[1].position.x();
  NewGrain ram = falling;
  ram.x = -0.06;
  ram.y = 0.0101;
  ram.vx = 3;
  pushed->add(ram);
  pushed->step(3000);
  EXPECT_GT(pushed->snapshot().grains[1].position.x(), before + 0.001);
}

/// Mean way (m) of the grains of a settled box after a grain has fallen on it at 2 m/s and all have
/// come to rest; mean over several places of the fall.
double way_after_impact(const Snapshot& box, const SleepSettings& sleep) {
  double sum = 0;
  constexpr int kFalls = 3;
  for (int fall = 0; fall < kFalls; ++fall) {
    EngineSettings settings = polygon_settings(1, sleep.on);
    settings.sleep = sleep;
    const auto engine = make_engine(settings, box);
    engine->step(1000);
    Random random(fall);
    NewGrain g = polygon_grain(random, 0.06 + 0.03 * fall, 0.16);
    g.vy = -2;
    engine->add(g);
    engine->step(5000);
    engine->set_sleep(false);
    engine->set_background_damping(50);
    engine->step(10000);
    const Snapshot after = engine->snapshot();
    for (std::size_t k = 0; k < box.grains.size(); ++k) {
      sum += (after.grains[k].position - box.grains[k].position).norm();
    }
  }
  return sum / (kFalls * static_cast<double>(box.grains.size()));
}

TEST(Sleep, AnImpactMovesSleepersAsItMovesTheAwake) {
  const auto engine = polygon_box(polygon_settings(), 8, 5);
  engine->set_background_damping(20);
  engine->step(30000);
  const Snapshot box = engine->snapshot();
  SleepSettings sleep;
  const double awake = way_after_impact(box, sleep);
  sleep.on = true;
  const double asleep = way_after_impact(box, sleep);
  sleep = loose(sleep);
  sleep.wake_force = 1e3;
  sleep.wake_reach = 0;
  sleep.quiet_time = 2e-3;
  sleep.quiet_move = 2.4e-3;
  const double rigid = way_after_impact(box, sleep);
  EXPECT_NEAR(asleep, awake, 0.4 * awake);
  // What a pile of sleepers that gives way only where it is touched would make of it.
  EXPECT_LT(rigid, 0.4 * awake);
  RecordProperty("awake", fmt::format("{:.3g}", awake));
  RecordProperty("asleep", fmt::format("{:.3g}", asleep));
  RecordProperty("rigid", fmt::format("{:.3g}", rigid));
}

// With every grain awake a packing rings on long after an impact: its slow common swings, in which
// neighbours hardly move against each other, pass the dashpots by. Sleepers that hide little ring
// with it; those that hide much do not.
TEST(Sleep, AwakePackingsRingOnAfterAnImpact) {
  const auto packing = polygon_box(polygon_settings(), 24, 12);
  packing->set_background_damping(50);
  packing->step(40000);
  const Snapshot box = packing->snapshot();
  // Median speed (m/s) of the box in the k-th hundredth of a second after the grain is dropped.
  const auto ringing = [&](bool sleep, bool much = false) {
    EngineSettings settings = polygon_settings(1, sleep);
    if (much) settings.sleep = loose(settings.sleep);
    const auto engine = make_engine(settings, box);
    engine->step(1000);
    Random random(5);
    NewGrain g = polygon_grain(random, 0.25, 0.32);
    g.vy = -2;
    engine->add(g);
    std::vector<double> medians;
    for (int k = 0; k < 36; ++k) {
      std::vector<double> speeds(box.grains.size(), 0.0);
      for (int sample = 0; sample < 10; ++sample) {
        engine->step(25);
        const Snapshot now = engine->snapshot();
        for (std::size_t i = 0; i < speeds.size(); ++i) {
          speeds[i] += now.grains[i].velocity.norm() / 10;
        }
      }
      std::nth_element(speeds.begin(), speeds.begin() + speeds.size() / 2, speeds.end());
      medians.push_back(speeds[speeds.size() / 2]);
    }
    return medians;
  };
  const std::vector<double> awake = ringing(false), asleep = ringing(true),
                            hiding = ringing(true, true);
  const auto peak = std::max_element(awake.begin(), awake.end());
  const auto at = static_cast<std::size_t>(peak - awake.begin());
  ASSERT_GT(at, 5u);  // at first the grain falls, and the box is still
  ASSERT_LT(at + 20, awake.size());
  EXPECT_LT(awake[0], 0.05 * *peak);
  EXPECT_GT(awake[at + 20], 0.25 * *peak);  // 0.2 s later
  EXPECT_GT(asleep[at + 20], 0.5 * awake[at + 20]);
  EXPECT_LT(hiding[at + 20], 0.1 * awake[at + 20]);
  RecordProperty("peak", fmt::format("{:.3g}", *peak));
  RecordProperty("later", fmt::format("{:.3g}", awake[at + 20]));
}

// Fixed grains lie among the sleepers: one that comes later must be found as well.
TEST(Sleep, AFixedGrainThatComesLateHolds) {
  const auto engine = polygon_box(polygon_settings(1, true), 4, 2);
  engine->step(60000);
  NewGrain falls;
  falls.x = 0.05;
  falls.y = 0.14;
  falls.density = 5000;
  falls.outline = {{-0.005, -0.005}, {0.005, -0.005}, {0.005, 0.005}, {-0.005, 0.005}};
  engine->add(falls);
  engine->step(10);
  NewGrain shelf = falls;
  shelf.y = 0.12;
  shelf.fixed = true;
  shelf.outline = {{-0.05, -0.005}, {0.05, -0.005}, {0.05, 0.005}, {-0.05, 0.005}};
  engine->add(shelf);
  engine->step(10000);
  const Snapshot s = engine->snapshot();
  EXPECT_NEAR(s.grains[8].position.y(), 0.13, 1e-3);
}

const Outline kBlock{{-0.02, -0.01}, {0.02, -0.01}, {0.02, 0.01}, {-0.02, 0.01}};
const double kBlockDiameter = 2 * std::hypot(0.02, 0.01);

/// `blocks` on each other on a floor with friction 0.5, tilted so far that the share `beyond` of
/// the weight drives the lowest down the slope against the friction.
std::unique_ptr<Engine> blocks_on_slope(const EngineSettings& like, int blocks, double beyond) {
  EngineSettings s = like;
  const double angle = std::atan(0.5) + std::asin(beyond / std::sqrt(1.25));
  s.gravity_x = 9.81 * std::sin(angle);
  s.gravity_y = -9.81 * std::cos(angle);
  auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  for (int k = 0; k < blocks; ++k) {
    NewGrain g;
    g.density = 5000;
    g.outline = kBlock;
    g.y = 0.01 + 0.02 * k;
    engine->add(g);
  }
  return engine;
}

// Just beyond the friction angle it must go, however little it lacks: less than quiet_force.
TEST(Sleep, ASlopeOnTheEdgeGoes) {
  EngineSettings s = polygon_settings(1, true);
  const auto way = [&](double beyond, int& awake) {
    const auto engine = blocks_on_slope(s, 1, beyond);
    engine->step(25000);  // 1 s: it has come down on the slope
    const double before = engine->snapshot().grains[0].position.x();
    engine->step(75000);
    awake = engine->measure().awake;
    return (engine->snapshot().grains[0].position.x() - before) / kBlockDiameter;
  };
  int awake = 0;
  EXPECT_LT(std::fabs(way(-0.004, awake)), 1e-3);
  EXPECT_EQ(awake, 0);
  EXPECT_GT(way(0.004, awake), 1);
  EXPECT_EQ(awake, 1);
}

// At 0.04 diameters a second, against a drag; in quiet_time that is a thirtieth of quiet_move.
TEST(Sleep, WhatCreepsIsNotFrozen) {
  EngineSettings s = polygon_settings(1, true);
  const double drag = 50, beyond = 0.04 * kBlockDiameter * drag / 9.81;
  EXPECT_LT(beyond, s.sleep.quiet_force);
  EXPECT_GT(s.sleep.quiet_move / s.sleep.quiet_time, 0.04);
  const auto engine = blocks_on_slope(s, 1, beyond);
  engine->set_background_damping(drag);
  engine->step(25000);
  const double before = engine->snapshot().grains[0].position.x();
  engine->step(25000);  // 1 s
  const double after = engine->snapshot().grains[0].position.x();
  EXPECT_NEAR((after - before) / kBlockDiameter, 0.04, 0.004);
}

// What hits the top of a column wakes all of it within three reviews, not a block a review.
TEST(Sleep, AForceWakesAlongTheNetwork) {
  EngineSettings s = polygon_settings(1, true);
  s.sleep.wake_reach = 0;
  s.sleep.wake_speed = 1e6;
  const auto engine = blocks_on_slope(s, 6, -0.5);
  engine->step(30000);
  ASSERT_EQ(engine->measure().awake, 0);
  NewGrain falling;
  falling.density = 5000;
  falling.outline = kBlock;
  falling.y = 0.14;
  falling.vy = -2;
  engine->add(falling);
  int awake = 1;
  for (int k = 0; k < 100 && awake == 1; ++k) {
    engine->step(50);
    awake = engine->measure().awake;
  }
  // A block a review would take six; the mean grows for two before it is passed on to all.
  for (int k = 0; k < 3 && awake < 7; ++k) {
    engine->step(50);
    awake = engine->measure().awake;
  }
  EXPECT_EQ(awake, 7);
}

// A block laid on a column that sleeps is carried down to the floor, also where it adds little to
// what the lowest carry.
TEST(Sleep, ALastingLoadReachesTheFloor) {
  const auto engine = blocks_on_slope(polygon_settings(1, true), 12, -0.5);
  engine->step(60000);
  ASSERT_LE(engine->measure().awake, 2);
  NewGrain laid;
  laid.density = 5000;
  laid.outline = kBlock;
  laid.y = 0.01 + 12 * 0.02 + 1e-5;
  engine->add(laid);
  engine->step(100000);  // 4 s
  EXPECT_LE(engine->measure().awake, 2);
  const Snapshot s = engine->snapshot();
  const double angle = std::atan(0.5) + std::asin(-0.5 / std::sqrt(1.25));
  const double weight = 13 * 5000 * 0.04 * 0.02 * 9.81 * std::cos(angle);
  double carried = 0;
  for (const Contact& c : s.contacts) carried += c.j < 0 ? c.normal_force : 0;
  EXPECT_NEAR(carried, weight, 0.02 * weight);
}

struct TallColumn {
  double hidden = 0;  // share of its weight that the floor does not carry
  int awake = 0;
};
/// A column of 60 blocks, of which the upper 20 were laid on it one by one while the others slept.
TallColumn tall_column(double wake_levels) {
  EngineSettings s = polygon_settings(1, true);
  s.sleep.wake_levels = wake_levels;
  const auto engine = blocks_on_slope(s, 40, -0.5);
  engine->step(100000);
  TallColumn out;
  for (int k = 40; k < 60; ++k) {
    NewGrain laid;
    laid.density = 5000;
    laid.outline = kBlock;
    laid.y = 0.01 + k * 0.02 - 1e-4;
    engine->add(laid);
    engine->step(10000);
  }
  engine->step(50000);
  const Snapshot state = engine->snapshot();
  double carried = 0, weight = 0;
  for (const Contact& c : state.contacts) carried += c.j < 0 ? c.normal_force : 0;
  for (const Grain& g : state.grains) weight -= g.mass * state.gravity.y();
  out.hidden = 1 - carried / weight;
  out.awake = engine->measure().awake;
  return out;
}

// Residuals that each block may hide add up from block to block. So the levels are asked as well,
// and all wake when one misses too much of the weight above it. In the end they sleep.
TEST(Sleep, LoadHiddenByManyReachesTheFloorOfATallColumn) {
  const TallColumn unasked = tall_column(1e3), asked = tall_column(0.0075);
  EXPECT_GT(unasked.hidden, 0.03);
  EXPECT_LT(std::fabs(asked.hidden), 0.01);
  EXPECT_LT(asked.awake, 5);
  RecordProperty("unasked", fmt::format("{:.3g}", unasked.hidden));
  RecordProperty("asked", fmt::format("{:.3g}", asked.hidden));
}

using Checkpoints = std::vector<std::pair<long, std::string>>;  // with their steps

/// The checkpoints are of a box of eight columns, which has gone on to `uninterrupted`.
void expect_the_same_when_resumed(const Checkpoints& checkpoints, const EngineSettings& settings,
                                  const Engine& uninterrupted) {
  const std::string end = uninterrupted.checkpoint();
  for (const auto& [step, checkpoint] : checkpoints) {
    auto resumed = make_engine(settings);
    resumed->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
    resumed->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.2});
    resumed->add_wall({"right", {8 * 0.023, 0, 0}, {-1, 0, 0}, 0.2});
    resumed->restore(checkpoint);
    resumed->step(uninterrupted.steps() - resumed->steps());
    EXPECT_TRUE(resumed->checkpoint() == end) << "resumed at step " << step;
  }
}

// Also a step before, at and after a look that wakes all, and while they are kept awake.
TEST(Sleep, ALevelThatWakesAllGoesOnBitForBitFromAnyStep) {
  EngineSettings settings = polygon_settings(1, true);
  settings.sleep.wake_levels = 1e-4;
  auto engine = polygon_box(settings, 8, 5);
  engine->step(29950);
  Checkpoints checkpoints;
  int most_asleep = 0, most_awake = 0;
  for (int k = 0; k < 160; ++k) {
    engine->step(k % 2 == 0 ? 49 : 1);
    checkpoints.emplace_back(engine->steps(), engine->checkpoint());
    const int awake = engine->measure().awake;
    most_asleep = std::max(most_asleep, 40 - awake);
    if (most_asleep > 20) most_awake = std::max(most_awake, awake);
  }
  EXPECT_GT(most_asleep, 20);
  EXPECT_GT(most_awake, 35) << "a level wakes all that slept";
  engine->step(1500);
  expect_the_same_when_resumed(checkpoints, settings, *engine);
}

TEST(Sleep, GravityWakesAll) {
  const auto engine = polygon_box(polygon_settings(1, true), 4, 3);
  engine->step(60000);
  ASSERT_LE(engine->measure().awake, 2);
  engine->set_gravity(0, -5);
  engine->step(1);
  EXPECT_EQ(engine->measure().awake, 12);
}

// No grain is added after the restart, so that a review may come before the next search.
TEST(Sleep, AnImpactOnSleepersGoesOnBitForBitFromAnyStep) {
  auto settings = polygon_settings(1, true);
  settings.sleep = loose(settings.sleep);
  auto engine = polygon_box(settings, 8, 5);
  engine->step(60000);
  ASSERT_EQ(engine->measure().awake, 0);
  Random random(0);
  NewGrain falls = polygon_grain(random, 0.09, 0.16);
  falls.vy = -2;
  engine->add(falls);
  Checkpoints checkpoints;
  int most_awake = 0;
  for (int k = 0; k < 250; ++k) {
    engine->step(7);
    checkpoints.emplace_back(engine->steps(), engine->checkpoint());
    most_awake = std::max(most_awake, engine->measure().awake);
  }
  EXPECT_GT(most_awake, 5) << "the impact wakes sleepers";
  engine->step(300);
  expect_the_same_when_resumed(checkpoints, settings, *engine);
}

TEST(Sleep, PouringGivesTheSameBitsOnAnyThreadsAndAfterRestarts) {
  const auto pour = [](int threads, int restart_at) {
    EngineSettings settings = polygon_settings(threads, true);
    settings.sleep = loose(settings.sleep);
    settings.sleep.wake_levels = 0.05;
    auto engine = polygon_box(settings, 6, 2);
    Random random(9);
    for (int k = 0; k < 24; ++k) {
      NewGrain g = polygon_grain(random, random.uniform(0.03, 0.11), 0.2);
      g.vy = -0.3;
      engine->add(g);
      engine->step(700);
      if (k == restart_at) {
        const std::string checkpoint = engine->checkpoint();
        auto fresh = make_engine(settings);
        fresh->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
        fresh->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.2});
        fresh->add_wall({"right", {6 * 0.023, 0, 0}, {-1, 0, 0}, 0.2});
        fresh->restore(checkpoint);
        engine = std::move(fresh);
      }
    }
    engine->step(4000);
    const Snapshot s = engine->snapshot();
    std::vector<double> state;
    for (const Grain& g : s.grains) {
      state.insert(state.end(), {g.position.x(), g.position.y(), g.angle, g.velocity.x(), g.spin});
    }
    for (const Contact& c : s.contacts) state.insert(state.end(), {c.force.x(), c.spring});
    state.push_back(engine->measure().awake);
    return state;
  };
  const auto one = pour(1, -1);
  EXPECT_LT(one.back(), 36) << "some sleep while others fall";
  EXPECT_TRUE(pour(2, -1) == one);
  EXPECT_TRUE(pour(3, -1) == one);
  EXPECT_TRUE(pour(1, 7) == one);
  EXPECT_TRUE(pour(2, 20) == one);
}

}  // namespace
}  // namespace grainfield::dem
