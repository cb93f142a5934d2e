// Hard grains and walls: a ball on a floor against the series of its flights, sliding, moving
// walls, the pressure on walls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dem/collisions/hard_engine.h"
#include "dem/shared/computation_failed.h"
#include "dem/space/lever.h"
#include "tests/dem/hard_scene.h"

namespace grainfield::dem {
namespace {

using namespace testing;
using ::testing::HasSubstr;

template <int D>
struct Ball {
  HardScene<D> scene;
  std::vector<Body<D>> grains{round_grain<D>(0.5, 2)};

  explicit Ball(double restitution, double friction = 0) {
    scene.box.low.setConstant(-5);
    scene.box.size.setConstant(10);
    scene.gravity[D - 1] = -9.81;
    HardWall<D> floor;
    floor.normal[D - 1] = 1;
    floor.law = {restitution, friction};
    scene.walls = {floor};
    scene.contact_time = 1e-6;
  }
};

template <int D>
void expect_bounces() {
  constexpr double e = 0.7, height = 2;
  Ball<D> ball(e);
  ball.grains[0].position[D - 1] = 0.5 + height;
  HardEngine<D> engine(ball.scene, ball.grains);
  int bounces = 0;
  double reached = height;
  while (engine.advance(1) == 1) {
    if (engine.tally().walls == bounces) continue;
    bounces = static_cast<int>(engine.tally().walls);
    reached *= e * e;
    const double up = engine.body(0).velocity[D - 1];
    if (engine.settled(0) == kNever) {
      EXPECT_NEAR(up * up / (2 * 9.81), reached, 1e-12 * reached + 1e-16) << bounces;
    }
  }
  // 2 w e^n/g < 1e-6 ends the series after 41 terms; its sum is that of all. The last flights begin
  // at 5e-6 m/s from a floor that is known to 1e-16 m.
  EXPECT_NEAR(bounces, std::log(1e-6 / 1.277) / std::log(e), 1);
  const double fall = std::sqrt(2 * height / 9.81), end = fall * (1 + e) / (1 - e);
  EXPECT_NEAR(engine.settled(0), end, 1e-10);
  EXPECT_EQ(engine.time(), engine.settled(0));
  EXPECT_EQ(engine.kinetic_energy(), 0);
  EXPECT_NEAR(engine.body(0).position[D - 1], 0.5, 1e-14);
  EXPECT_NEAR(engine.lost(), 2 * 9.81 * height, 1e-12 * 2 * 9.81 * height);
  EXPECT_EQ(engine.advance(100), 0);
}

TEST(HardBall, BouncesByTheSquareOfRestitutionAndRestsAtTheSummedTime) {
  expect_bounces<2>();
  expect_bounces<3>();
}

TEST(HardBall, OfRestitutionOneNeverRestsAndOfZeroAtOnce) {
  Ball<2> elastic(1);
  elastic.grains[0].position.y() = 1.5;
  HardEngine<2> engine(elastic.scene, elastic.grains);
  engine.advance(1L << 40, 1000);
  EXPECT_EQ(engine.tally().walls, 1107);  // at (2 k - 1) sqrt(2/g)
  EXPECT_EQ(engine.lost(), 0);
  const Body<2> b = engine.body(0);
  EXPECT_NEAR(0.5 * b.velocity.squaredNorm() + 9.81 * (b.position.y() - 0.5), 9.81, 1e-11);
  Ball<2> dead(0);
  dead.grains[0].position.y() = 1.5;
  HardEngine<2> falls(dead.scene, dead.grains);
  falls.advance(1L << 40);
  EXPECT_EQ(falls.tally().walls, 1);
  EXPECT_NEAR(falls.settled(0), std::sqrt(2 / 9.81), 1e-15);
}

// Laid on the floor with a speed it slides, slowed by mu g, until it rolls at that speed over
// 1 + I/(m r^2).
template <int D>
void expect_rolling() {
  constexpr double mu = 0.25, speed = 1.5;
  Ball<D> ball(0.5, mu);
  ball.scene.box.periodic[0] = true;
  ball.grains[0].position[D - 1] = 0.5;
  ball.grains[0].velocity[0] = speed;
  HardEngine<D> engine(ball.scene, ball.grains);
  const double shape = D == 2 ? 0.5 : 0.4, rolls = speed / (1 + shape);
  const double end = (speed - rolls) / (mu * 9.81), way = 0.5 * (speed + rolls) * end;
  engine.advance(1000, 0.5 * end);
  EXPECT_NEAR(engine.body(0).velocity[0], 0.5 * (speed + rolls), 1e-13);
  engine.advance(1000, 2 * end);
  const Body<D> b = engine.body(0);
  EXPECT_NEAR(b.velocity[0], rolls, 1e-13);
  EXPECT_NEAR(b.position[0], way + rolls * end, 1e-13);
  EXPECT_NEAR(size_of(b.spin), rolls / 0.5, 1e-13);
  VectorOf<D> arm = VectorOf<D>::Zero();
  arm[D - 1] = -0.5;
  EXPECT_LT((b.velocity + velocity_at(b.spin, arm)).norm(), 1e-13);
  EXPECT_NEAR(engine.lost(), 0.5 * 2 * speed * speed - engine.kinetic_energy(), 1e-13);
}

TEST(HardBall, SlidesUntilItRolls) {
  expect_rolling<2>();
  expect_rolling<3>();
}

// A ball that lies there is hit by one that falls: their accelerations differ.
TEST(HardBall, OnTheFloorIsHitWhereTheOtherFallsOnIt) {
  Ball<2> ball(0.5);
  ball.grains[0].position = {0, 0.5};
  Body<2> other = round_grain<2>(0.5, 2);
  other.position = {-2, 3};
  other.velocity = {1, 0};
  ball.grains.push_back(other);
  HardEngine<2> engine(ball.scene, ball.grains);
  while (engine.tally().pairs == 0) ASSERT_EQ(engine.advance(1), 1);
  // It may have bounced from the floor before; in any case they touch now, and the other flies.
  EXPECT_NEAR((engine.body(0).position - engine.body(1).position).norm(), 1, 1e-13);
  EXPECT_LT(engine.tally().deepest, 1e-13);
  engine.advance(100000, 60);
  EXPECT_NEAR(engine.body(0).position.y(), 0.5, 1e-12);
  EXPECT_NEAR(engine.body(1).position.y(), 0.5, 1e-12);
}

TEST(HardBall, WithoutContactTimeCollapsesAndSaysSo) {
  Ball<2> ball(0.5);
  ball.scene.contact_time = 0;
  ball.grains[0].position.y() = 1;
  HardEngine<2> engine(ball.scene, ball.grains);
  try {
    engine.advance(1L << 30);
    FAIL();
  } catch (const ComputationFailed& e) {
    EXPECT_THAT(e.what(), HasSubstr("grain 0 collided 1000 times at t = "));
    EXPECT_THAT(e.what(), HasSubstr("raise the contact time"));
  }
}

TEST(HardWalls, ThatMoveGiveTwiceTheirSpeed) {
  HardScene<2> scene;
  scene.box.size = {10, 4};
  scene.box.periodic = {false, true};
  scene.walls = walls_of(scene.box, {1, 0});
  scene.walls[0].velocity.x() = 0.25;
  std::vector<Body<2>> grains{round_grain<2>(0.5)};
  grains[0].position = {5, 1};
  grains[0].velocity = {-1, 0};
  HardEngine<2> engine(scene, grains);
  while (engine.tally().walls == 0) engine.advance(1);
  EXPECT_NEAR(engine.time(), 4.5 / 1.25, 1e-14);
  EXPECT_NEAR(engine.body(0).velocity.x(), 1.5, 1e-14);
  EXPECT_NEAR(engine.wall_impulse(0).x(), -2.5, 1e-14);
}

// The virial theorem: 2 K t and the virials of pairs and walls add up to the change of sum m x v,
// which stays below L sum m |v|. Walls act at the places of the centres: L - 2 r apart.
TEST(HardWalls, FeelThePressureOfTheGas) {
  Random random(14);
  HardScene<2> scene;
  const auto grains = gas_of<2>(20, 0.4, random, scene.box);
  scene.walls = walls_of(scene.box, {1, 0});
  HardEngine<2> engine(scene, grains);
  const double energy = engine.kinetic_energy();
  const auto moments = [&] {
    double sum = 0;
    for (const Body<2>& g : bodies_of(engine)) sum += g.position.dot(g.velocity) / g.inverse_mass;
    return sum;
  };
  const double begin = moments();
  collide_pairs(engine, 20000);
  const double low = 0.5 * (engine.wall_impulse(0).x() + engine.wall_impulse(2).y());
  const double high =
      (scene.box.size.x() - 0.5) * (engine.wall_impulse(1).x() + engine.wall_impulse(3).y());
  EXPECT_GT(engine.tally().walls, 1000);
  EXPECT_LT(engine.wall_impulse(0).x(), 0);  // of the grains on the wall
  EXPECT_NEAR(2 * energy * engine.time() + engine.tally().virial - low - high, moments() - begin,
              1e-10 * engine.tally().virial);
}

}  // namespace
}  // namespace grainfield::dem
