// Sleepers by themselves: who is quiet, what a sleeper carries, and what stays with whom.
#include "dem/sleep/sleepers.h"

#include <gmock/gmock.h>

#include <limits>

#include "dem/laws/contact.h"

namespace grainfield::dem {
namespace {

using Memory = SpringMemory<2>;
using Plane2 = Sleepers<2, Memory>;

TEST(Sleepers, ComeBehindTheAwakeAndKeepWhatTheyCarry) {
  Plane2 s;
  std::vector<int> bodies;
  for (int k = 0; k < 6; ++k) {
    s.add(Eigen::Vector2d(k, 0), 0, 0, k % 2 == 0);
    bodies.push_back(k);
    s.rest(k).press = k;
  }
  EXPECT_TRUE(s.have_changed());
  s.settled();
  const int awake = s.part(3, [&](int i, int j) { std::swap(bodies[i], bodies[j]); });
  EXPECT_EQ(awake, 3);
  EXPECT_TRUE(s.have_changed());
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(s.is_asleep(k), k >= awake);
    EXPECT_EQ(bodies[k] % 2 == 0, k >= awake);
    EXPECT_EQ(s.rest(k).press, bodies[k]);
  }
  s.settled();
  s.part(awake, [](int, int) { FAIL(); });
  EXPECT_FALSE(s.have_changed());
}

TEST(Sleepers, QuietIsWhoStaysInPlace) {
  SleepSettings settings;
  settings.quiet_move = 0.01;  // of the diameter 2: 0.02
  Plane2 s;
  s.add({0, 0}, 0, 100, false);
  EXPECT_EQ(s.quiet_steps(0, {0.01, 0.01}, 0.01, 1, 150, settings), 50);
  EXPECT_EQ(s.quiet_steps(0, {0.03, 0}, 0, 1, 160, settings), -1);
  EXPECT_EQ(s.quiet_steps(0, {0.03, 0}, 0, 1, 170, settings), 10);  // from where it is now
  EXPECT_EQ(s.quiet_steps(0, {0.03, 0}, 0.03, 1, 180, settings), -1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(s.quiet_steps(0, {nan, 0}, 0.03, 1, 190, settings), -1);
}

TEST(Sleepers, WakeWhenWhatTheyCarryIsOutOfBalance) {
  SleepSettings settings;
  settings.wake_force = 0.15;
  Plane2 s;
  s.add({0, 0}, 0, 0, false);
  s.put_to_sleep(0, {0, -10});
  ContactForce<2> from_below;
  from_below.force = {0, 10};
  s.rest(0).force += from_below.force;
  s.rest(0).press += 10;
  EXPECT_FALSE(s.is_unbalanced(0, 1, 50, settings));
  // A neighbour presses with 3 N from above, summed over 50 steps: felt is on the neighbour.
  ForceSum<2> felt;
  felt.force = {0, 150};
  felt.press = 150;
  s.touch(0, felt);
  EXPECT_TRUE(s.is_unbalanced(0, 1, 50, settings));
  EXPECT_FALSE(s.is_unbalanced(0, 1, 500, settings));
  s.forget_touches(0);
  EXPECT_FALSE(s.is_unbalanced(0, 1, 50, settings));
  felt = {};
  felt.torque = 100;  // 2 N m a step over a radius of 1 m against 10 N
  felt.press = 1;
  s.touch(0, felt);
  EXPECT_TRUE(s.is_unbalanced(0, 1, 50, settings));
  s.forget_touches(0);
  s.release(0, from_below);  // the support is gone
  EXPECT_TRUE(s.is_unbalanced(0, 1, 50, settings));
}

TEST(Sleepers, FrozenContactsAreInNobodysOrder) {
  FrozenContacts<2, Memory> frozen;
  for (const int other : {9, 4, 7}) {
    FrozenContact<2, Memory> c;
    c.key = pair_key(other, 2);
    c.memory.spring = other;
    frozen.keep(c);
  }
  std::vector<double> springs;
  for (const auto& c : frozen.sorted()) springs.push_back(c.memory.spring);
  EXPECT_THAT(springs, testing::ElementsAre(4, 7, 9));
  FrozenContact<2, Memory> out;
  EXPECT_FALSE(frozen.take(pair_key(2, 5), out));
  EXPECT_TRUE(frozen.take(pair_key(7, 2), out));
  EXPECT_EQ(out.memory.spring, 7);
  EXPECT_EQ(frozen.sorted().size(), 2U);
}

TEST(Sleepers, AForceSeenFromTheOtherBody) {
  ContactForce<2> f;
  f.force = {1, 2};
  f.torque_i = 3;
  f.torque_j = 4;
  const ContactForce<2> g = seen_from(f, true);
  EXPECT_EQ(g.force, Eigen::Vector2d(-1, -2));
  EXPECT_EQ(g.torque_i, 4);
  EXPECT_EQ(g.torque_j, 3);
  EXPECT_EQ(seen_from(f, false).force, f.force);
}

}  // namespace
}  // namespace grainfield::dem
