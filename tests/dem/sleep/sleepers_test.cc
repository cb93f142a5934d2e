// Sleepers by themselves: who is quiet, what a sleeper carries, and what stays with whom.
#include "dem/sleep/sleepers.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "dem/laws/contact.h"
#include "dem/sleep/hidden_load.h"
#include "dem/space/space3.h"

namespace grainfield::dem {
namespace {

using Memory = SpringMemory<2>;
using Plane2 = Sleepers<2, Memory>;
using Space3 = Sleepers<3, SpringMemory<3>>;

TEST(Sleepers, ComeBehindTheAwakeAndKeepWhatTheyCarry) {
  Plane2 s;
  std::vector<int> bodies;
  for (int k = 0; k < 6; ++k) {
    s.add(Eigen::Vector2d(k, 0), 0, 0, k % 2 == 0);
    bodies.push_back(k);
    ContactForce<2> f;
    f.force = {0, k};
    s.carry(k, f);
  }
  EXPECT_TRUE(s.have_changed());
  s.settled();
  const int awake = s.part(3, [&](int i, int j) { std::swap(bodies[i], bodies[j]); });
  EXPECT_EQ(awake, 3);
  EXPECT_TRUE(s.have_changed());
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(s.is_asleep(k), k >= awake);
    EXPECT_EQ(bodies[k] % 2 == 0, k >= awake);
    EXPECT_EQ(s.rest(k).force_sum, bodies[k]);
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
  const auto still = s.stillness(0, {0.006, 0.008}, 0.009, 1, 150, settings);
  EXPECT_EQ(still.steps, 50);
  EXPECT_DOUBLE_EQ(still.way, 0.0095);
  // Neither the way nor the rim's is too long, but both together are.
  EXPECT_EQ(s.stillness(0, {0.006, 0.008}, 0.011, 1, 160, settings).steps, -1);
  EXPECT_EQ(s.stillness(0, {0.006, 0.008}, 0.011, 1, 170, settings).steps, 10);  // where it is now
  EXPECT_EQ(s.stillness(0, {0.006, 0.008}, 0.04, 1, 180, settings).steps, -1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(s.stillness(0, {nan, 0}, 0.04, 1, 190, settings).steps, -1);
}

// What goes along with what carries it, turning too, is still; what slides or rolls there is not.
TEST(Sleepers, QuietIsMeasuredAgainstWhatCarries) {
  SleepSettings settings;
  settings.quiet_move = 0.01;  // of the diameter 2: 0.02
  const auto still = [&](double share, double turned) {
    Plane2 s;
    s.add({0, 0}, 0, 100, false);
    Eigen::Vector2d place(0, 0);
    double angle = 0;
    Plane2::Stillness last;
    for (int k = 1; k <= 20; ++k) {
      place += Eigen::Vector2d(0.004, -0.003);
      angle += 0.01;
      const auto own = s.since_review(0, place, angle);
      EXPECT_NEAR(own.way.norm(), 0.005, 1e-15);
      EXPECT_NEAR(own.turn, 0.01, 1e-15);
      s.carry_place(0, {share * own.way, turned * own.turn}, place, angle);
      last = s.stillness(0, place, angle, 1, 100 + 50 * k, settings);
    }
    return last;
  };
  EXPECT_EQ(still(1, 1).steps, 1000);
  EXPECT_LT(still(1, 1).way, 1e-15);
  EXPECT_LT(still(0, 1).steps, 1000);
  EXPECT_LT(still(1, 0).steps, 1000);
  EXPECT_EQ(still(0.9, 1).steps, 1000);  // 20 times a tenth of 0.005 is within 0.02
  EXPECT_NEAR(still(0.9, 1).way, 0.005, 1e-12);
}

// In space turns compose: a place carried by small turns keeps up with the grain that makes them.
TEST(Sleepers, PlacesTurnInSpace) {
  Space3 s;
  RotationOf<3> angle = RotationOf<3>::Identity();
  s.add(Eigen::Vector3d::Zero(), angle, 0, false);
  const Eigen::Vector3d turn(1e-4, -2e-4, 3e-4);
  for (int k = 0; k < 100; ++k) {
    angle = turned_by<3>(angle, turn);
    const auto own = s.since_review(0, Eigen::Vector3d::Zero(), angle);
    EXPECT_LT((own.turn - turn).norm(), 1e-10);
    s.carry_place(0, own, Eigen::Vector3d::Zero(), angle);
  }
  EXPECT_LT(s.stillness(0, Eigen::Vector3d::Zero(), angle, 1, 10, SleepSettings{}).way, 1e-8);
  EXPECT_NEAR(angle.angularDistance(RotationOf<3>::Identity()), 100 * turn.norm(), 1e-6);
}

TEST(Sleepers, KnowWhatLeavesThemOutOfBalance) {
  Plane2 s;
  s.add({0, 0}, 0, 0, false);
  s.put_to_sleep(0, {0, -10});
  ContactForce<2> from_below;
  from_below.force = {0, 10};
  s.carry(0, from_below);
  EXPECT_EQ(s.residual(0, 50).unbalanced(1), 0);
  EXPECT_EQ(s.residual(0, 50).load, 10);  // its weight, and nothing on it
  // A neighbour presses with 3 N from above, summed over 50 steps: felt is on the neighbour.
  ForceSum<2> felt;
  felt.force = {0, 150};
  felt.force_sum = 150;
  s.touch(0, felt);
  EXPECT_DOUBLE_EQ(s.residual(0, 50).unbalanced(1), 3);
  EXPECT_DOUBLE_EQ(s.residual(0, 50).load, 11.5);
  EXPECT_DOUBLE_EQ(s.residual(0, 500).unbalanced(1), 0.3);
  s.set_judged(0, true);
  EXPECT_FALSE(s.is_stirred(0));
  felt = {};
  felt.torque = 100;
  s.touch(0, felt);
  EXPECT_TRUE(s.is_stirred(0));
  EXPECT_DOUBLE_EQ(s.residual(0, 50).unbalanced(0.5), 4);  // 2 N m a step
  s.set_judged(0, true);
  s.release(0, from_below);  // the support is gone
  EXPECT_TRUE(s.is_stirred(0));
  EXPECT_EQ(s.residual(0, 50).unbalanced(1), 10);
}

// A push that comes and goes leaves nothing in the mean, one that stays is in it.
TEST(Sleepers, RememberWhatStaysOutOfBalance) {
  Plane2 s;
  s.add({0, 0}, 0, 0, false);
  s.put_to_sleep(0, {0, -10});
  const auto pushed = [](double force, double torque) {
    Plane2::Residual r;
    r.force = {force, 0};
    r.torque = torque;
    r.load = 10;
    return r;
  };
  EXPECT_EQ(s.add_to_mean(0, pushed(0, 0), 0.1).unbalanced(1), 0);
  EXPECT_DOUBLE_EQ(s.add_to_mean(0, pushed(4, 2), 0.1).unbalanced(1), 0.6);
  EXPECT_NEAR(s.add_to_mean(0, pushed(-4, -2), 0.1).unbalanced(1), 0.06, 1e-12);
  double before = 0;
  for (int n = 0; n < 50; ++n) {
    const auto mean = s.add_to_mean(0, pushed(4, 0), 0.1);
    EXPECT_GT(mean.force.x(), before);
    EXPECT_EQ(mean.load, 10);
    before = mean.force.x();
  }
  EXPECT_NEAR(before, 4, 0.05);  // 4.06 e^-5 is missing
  s.put_to_sleep(0, {0, -10});   // anew: nothing of before
  EXPECT_DOUBLE_EQ(s.add_to_mean(0, pushed(1, 0), 0.1).unbalanced(1), 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(s.add_to_mean(0, pushed(nan, 0), 0.1).unbalanced(1) < 1e300);
  // It is judged again until the mean is what is out of balance now.
  s.set_judged(0, false);
  EXPECT_TRUE(s.is_stirred(0));
  s.set_judged(0, true);
  EXPECT_FALSE(s.is_stirred(0));
}

// What is out of balance, and of what load, is the same whichever way the axes lie.
TEST(Sleepers, JudgeAlikeInTurnedAxes) {
  const auto judged = [](double angle) {
    const Eigen::Rotation2Dd turn(angle);
    Plane2 s;
    s.add({0, 0}, 0, 0, false);
    s.put_to_sleep(0, turn * Eigen::Vector2d(0, -10));
    for (const Eigen::Vector2d& force : {Eigen::Vector2d(3, 6), Eigen::Vector2d(-2, 4)}) {
      ContactForce<2> f;
      f.force = turn * force;
      f.torque_i = 0.5;
      s.carry(0, f);
    }
    const auto r = s.residual(0, 1);
    SleepSettings settings;
    const double way = s.stillness(0, turn * Eigen::Vector2d(1e-4, 2e-4), 1e-4, 1, 1, settings).way;
    return std::vector<double>{r.unbalanced(2), r.load, s.creep(0, r, 2, 9.81, 0.1), way};
  };
  const std::vector<double> upright = judged(0);
  EXPECT_DOUBLE_EQ(upright[0], 1.5);
  for (const double angle : {0.3, 0.785, 2.0}) {
    const std::vector<double> turned = judged(angle);
    for (std::size_t k = 0; k < upright.size(); ++k) {
      EXPECT_NEAR(turned[k], upright[k], 1e-13 * upright[k]) << angle;
    }
  }
}

// As a free grain would go, accelerated by g times the share of its load: s g t^2/2. Forces that
// come and go hardly count.
TEST(Sleepers, AddUpWhatLeavesThemOutOfBalance) {
  Plane2 s;
  s.add({0, 0}, 0, 0, false);
  s.put_to_sleep(0, {0, -10});
  Plane2::Residual r;
  r.load = 20;
  double way = 0;
  for (int k = 0; k < 1000; ++k) {
    r.force = {k % 2 == 0 ? 1 : -1, 0};
    way = s.creep(0, r, 1, 9.81, 1e-3);
  }
  EXPECT_LT(way, 1e-3);
  s.put_to_sleep(0, {0, -10});
  r.force = {0.2, 0};
  for (int k = 0; k < 1000; ++k) way = s.creep(0, r, 1, 9.81, 1e-3);
  EXPECT_NEAR(way, 0.01 * 9.81 / 2, 2e-3 * way);
}

TEST(Sleepers, SleepAgainAfterALookOnlyWithHalfOfIt) {
  SleepSettings settings;
  settings.quiet_force = 0.01;
  Plane2 s;
  s.add({0, 0}, 0, 0, false);
  EXPECT_EQ(s.sleeping_share(0, settings), 0.01);
  s.put_to_sleep(0, {0, -10});
  Plane2::Residual r;
  r.load = 10;
  r.force = {0, 0.08};
  EXPECT_TRUE(s.wake_for_look(0, r, 1, 500));
  EXPECT_FALSE(s.wake_for_look(0, r, 1, 500));
  EXPECT_DOUBLE_EQ(s.sleeping_share(0, settings), 0.004);
  EXPECT_EQ(s.stillness(0, {0, 0}, 0, 1, 510, settings).steps, 10);
  EXPECT_EQ(s.stillness(0, {1, 0}, 0, 1, 520, settings).steps, -1);  // it has gone elsewhere
  EXPECT_EQ(s.sleeping_share(0, settings), 0.01);
}

TEST(Sleepers, HideAShareOfTheWeightAboveALevel) {
  const auto share = [](std::vector<LevelShare> grains) { return largest_hidden_share(grains); };
  EXPECT_EQ(share({}), 0);
  EXPECT_EQ(share({{0, 0, 0}, {1, 0, 0}}), 0);
  // A tenth of each weight: the same share of every level, whatever the order.
  std::vector<LevelShare> alike;
  for (const int k : {7, 2, 9, 0, 4}) alike.push_back({0.1 * k, 2, 0.2});
  EXPECT_NEAR(share(alike), 0.1, 1e-15);
  // The residuals of two grains cancel below both of them, not between them.
  EXPECT_NEAR(share({{0, 1, -0.3}, {1, 1, 0.3}, {2, 1, 0}}), 0.15, 1e-15);
  // Too much is passed on as well.
  EXPECT_NEAR(share({{0, 1, 0}, {1, 1, -0.3}}), 0.3, 1e-15);
  // A level that carries less than a twentieth of the whole is not asked.
  EXPECT_NEAR(share({{1, 0.04, 0.04}, {0, 0.96, 0}}), 0.04, 1e-15);
  EXPECT_NEAR(share({{1, 0.06, 0.04}, {0, 0.94, 0}}), 0.04 / 0.06, 1e-12);
  // Grains at one height are one level, in any order.
  EXPECT_NEAR(share({{1, 1, 0.3}, {1, 1, -0.3}, {0, 1, 0}}), 0, 1e-15);
}

// Woken for a while: it is not quiet before that is over, or has moved elsewhere.
TEST(Sleepers, MayBeWokenForAWhile) {
  const SleepSettings settings;
  Plane2 s;
  s.add({0, 0}, 0, 0, true);
  EXPECT_TRUE(s.set_asleep(0, false, {0, 0}, 0, 300));
  EXPECT_EQ(s.stillness(0, {0, 0}, 0, 1, 200, settings).steps, -100);
  EXPECT_EQ(s.stillness(0, {0, 0}, 0, 1, 350, settings).steps, 50);
  EXPECT_EQ(s.stillness(0, {1, 0}, 0, 1, 400, settings).steps, -1);
  EXPECT_EQ(s.stillness(0, {1, 0}, 0, 1, 450, settings).steps, 50);
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
