// Hard grains from collision to collision: the gas against its equation of state, every collision
// against an engine that looks at all pairs, a ball on a floor against its series.
#include "dem/collisions/hard_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dem/collisions/hard_steps.h"
#include "dem/computation_failed.h"
#include "dem/space/lever.h"
#include "hard_scene.h"

namespace grainfield::dem {
namespace {

using namespace testing;
using ::testing::HasSubstr;

template <int D>
VectorOf<D> momentum_of(const std::vector<Body<D>>& grains) {
  VectorOf<D> sum = VectorOf<D>::Zero();
  for (const Body<D>& g : grains) sum += g.velocity / g.inverse_mass;
  return sum;
}

// Least distance of two grains over that at which they touch.
template <int D>
double nearest(const HardBox<D>& box, const std::vector<Body<D>>& grains) {
  double out = kNever;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double way = nearest_way(box, grains[i].position, grains[j].position).norm();
      out = std::min(out, way / (grains[i].radius + grains[j].radius));
    }
  }
  return out;
}

// -- gas

// Measured over this many collisions a grain, after half as many.
template <int D>
double compressibility(int side, double fraction, int collisions) {
  Random random(11);
  HardScene<D> scene;
  scene.box.periodic.fill(true);
  const auto grains = gas_of<D>(side, fraction, random, scene.box);
  HardEngine<D> engine(scene, grains);
  const long n = static_cast<long>(grains.size()), pairs = n * collisions / 2;
  const double energy = engine.kinetic_energy();
  collide_pairs(engine, pairs / 2);
  const HardTally before = engine.tally();
  const double begin = engine.time();
  collide_pairs(engine, pairs / 2 + pairs);
  const HardTally& after = engine.tally();
  EXPECT_NEAR(engine.kinetic_energy() / energy, 1, 1e-12);
  EXPECT_LT(after.deepest, 1e-12);
  return 1 + (after.virial - before.virial) / ((engine.time() - begin) * 2 * energy);
}

// What the sampling leaves of Z - 1 with about 1e5 collisions: 1/2 %.
TEST(HardGas, HasHendersonsPressure) {
  for (const double fraction : {0.2, 0.35, 0.5}) {
    EXPECT_NEAR(compressibility<2>(50, fraction, 100) / henderson(fraction), 1, 0.01) << fraction;
  }
}

TEST(HardGas, OfSpheresHasCarnahanAndStarlings) {
  for (const double fraction : {0.1, 0.3}) {
    EXPECT_NEAR(compressibility<3>(13, fraction, 80) / carnahan_starling(fraction), 1, 0.01)
        << fraction;
  }
}

TEST(HardGas, OfTenThousandDisksKeepsEnergyAndMomentum) {
  Random random(1);
  HardScene<2> scene;
  scene.box.periodic.fill(true);
  const auto grains = gas_of<2>(100, 0.35, random, scene.box);
  HardEngine<2> engine(scene, grains);
  const double energy = engine.kinetic_energy();
  const VectorOf<2> momentum = momentum_of(grains);
  collide_pairs(engine, 50000);
  const double collisions = static_cast<double>(engine.tally().pairs);
  EXPECT_LT(std::fabs(engine.kinetic_energy() / energy - 1), 1e-12);
  EXPECT_LT(std::fabs(engine.kinetic_energy() / energy - 1) / collisions, 1e-16);
  EXPECT_LT((momentum_of(bodies_of(engine)) - momentum).norm(), 1e-12 * collisions);
}

// Unlike sizes, dense, rough, with gravity, in a box: no two grains overlap at any time.
template <int D>
void expect_no_overlap(bool periodic, double restitution) {
  Random random(4);
  HardScene<D> scene;
  scene.grains = {restitution, 0.3};
  scene.contact_time = 1e-4;
  const auto grains = gas_of<D>(D == 2 ? 12 : 5, 0.45, random, scene.box, 0.35);
  scene.box.periodic.fill(periodic);
  scene.walls = walls_of(scene.box, {restitution, 0.2});
  if (!periodic) scene.gravity[D - 1] = -1;
  HardEngine<D> engine(scene, grains);
  double potential = 0, energy = engine.kinetic_energy();
  const auto potential_of = [&] {
    double sum = 0;
    for (const Body<D>& g : bodies_of(engine))
      sum -= scene.gravity.dot(g.position) / g.inverse_mass;
    return sum;
  };
  potential = potential_of();
  for (int k = 1; k <= 60; ++k) {
    engine.advance(1L << 40, 0.05 * k);
    ASSERT_DOUBLE_EQ(engine.time(), 0.05 * k);
    const auto now = bodies_of(engine);
    EXPECT_GT(nearest(scene.box, now), 1 - 1e-11);
    for (const HardWall<D>& wall : scene.walls) {
      for (const Body<D>& g : now) {
        EXPECT_GT((g.position - wall.point).dot(wall.normal), g.radius * (1 - 1e-11));
      }
    }
    EXPECT_NEAR(engine.kinetic_energy() + potential_of() + engine.lost(), energy + potential,
                1e-10 * (energy + std::fabs(potential)));
  }
  EXPECT_GT(engine.tally().pairs, 150);
  EXPECT_LT(engine.tally().deepest, 1e-11);
}

TEST(HardGas, NeverOverlapsAndAccountsForItsEnergy) {
  for (const bool periodic : {false, true}) {
    for (const double restitution : {1.0, 0.8}) {
      expect_no_overlap<2>(periodic, restitution);
      expect_no_overlap<3>(periodic, restitution);
    }
  }
}

// -- every collision

// All grains at one time, all pairs looked at, no cells: what happens next.
template <int D>
struct AllPairs {
  HardScene<D> scene;
  std::vector<Body<D>> grains;
  double time = 0;

  std::array<int, 2> step() {
    double first = kNever;
    std::array<int, 2> who{-1, -1};
    const int n = static_cast<int>(grains.size()), walls = static_cast<int>(scene.walls.size());
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        // Far images come nearest later than near ones: those within one box suffice for a while.
        for (int k = 0; k < (D == 2 ? 9 : 27); ++k) {
          VectorOf<D> r = grains[j].position - grains[i].position;
          for (int a = 0, rest = k; a < D; ++a, rest /= 3) {
            r[a] += scene.box.periodic[a] ? (rest % 3 - 1) * scene.box.size[a] : 0;
          }
          add(meet_time(r, grains[i].velocity, grains[j].velocity,
                        grains[i].radius + grains[j].radius),
              {i, j}, first, who);
        }
      }
      for (int w = 0; w < walls; ++w) {
        const HardWall<D>& wall = scene.walls[w];
        add(fall_time((grains[i].position - wall.place(time)).dot(wall.normal) - grains[i].radius,
                      (grains[i].velocity - wall.velocity).dot(wall.normal),
                      scene.gravity.dot(wall.normal)),
            {i, -1 - w}, first, who);
      }
    }
    for (Body<D>& g : grains) {
      g.position += first * g.velocity + 0.5 * first * first * scene.gravity;
      g.position = inside(scene.box, g.position);
      g.velocity += first * scene.gravity;
    }
    time += first;
    if (who[1] < 0) {
      Body<D> wall = scene.walls[-1 - who[1]].body();
      collide<D>(grains[who[0]], wall, VectorOf<D>(-scene.walls[-1 - who[1]].normal),
                 scene.walls[-1 - who[1]].law);
    } else {
      Body<D>&a = grains[who[0]], &b = grains[who[1]];
      collide<D>(a, b, nearest_way(scene.box, a.position, b.position).normalized(), scene.grains);
    }
    return who;
  }
  static void add(double at, std::array<int, 2> pair, double& first, std::array<int, 2>& who) {
    if (at < first) {
      first = at;
      who = pair;
    }
  }
};

template <int D>
void expect_every_collision(bool periodic, double gravity) {
  Random random(17);
  HardScene<D> scene;
  scene.grains = {0.95, 0.2};
  const auto grains = gas_of<D>(D == 2 ? 5 : 4, 0.2, random, scene.box, 0.2);
  scene.box.periodic.fill(periodic);
  scene.gravity[D - 1] = gravity;
  scene.walls = walls_of(scene.box, {0.9, 0.1});
  if (!periodic) scene.walls[0].velocity[0] = 0.05;  // a piston
  HardEngine<D> engine(scene, grains);
  AllPairs<D> all{scene, grains};
  // Every collision multiplies round-off: after 120 of them it is 1e-8.
  for (int k = 0; k < 120; ++k) {
    all.step();
    engine.advance(1L << 40, all.time + 1e-6);
    ASSERT_EQ(engine.tally().pairs + engine.tally().walls, k + 1) << all.time;
    if (k % 10 != 0) continue;
    const double more = engine.time() - all.time;
    for (std::size_t g = 0; g < grains.size(); ++g) {
      const VectorOf<D> place = all.grains[g].position + more * all.grains[g].velocity;
      EXPECT_LT(nearest_way(scene.box, place, engine.body(g).position).norm(), 1e-5) << k;
      EXPECT_LT((all.grains[g].velocity - engine.body(g).velocity).norm(), 1e-5) << k;
    }
  }
}

TEST(HardEngine, MissesNoCollision) {
  expect_every_collision<2>(true, 0);
  expect_every_collision<2>(false, 0);
  expect_every_collision<2>(false, -2);
  expect_every_collision<3>(true, 0);
  expect_every_collision<3>(false, -2);
}

// -- a ball on a floor

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

// Of infinite mass: others bounce from it as from a wall.
TEST(HardEngine, GrainsOfInfiniteMassGoTheirWay) {
  HardScene<2> scene;
  scene.box.size = {10, 4};
  scene.box.periodic = {true, true};
  std::vector<Body<2>> grains{round_grain<2>(0.5), round_grain<2>(0.5)};
  grains[0].position = {2, 1};
  grains[0].velocity = {1, 0};
  grains[1].position = {6, 1};
  grains[1].velocity = {-0.5, 0};
  grains[1].inverse_mass = grains[1].inverse_inertia = 0;
  HardEngine<2> engine(scene, grains);
  while (engine.tally().pairs == 0) engine.advance(1);
  EXPECT_NEAR(engine.time(), 2, 1e-14);
  EXPECT_NEAR(engine.body(0).velocity.x(), -2, 1e-14);
  EXPECT_EQ(engine.body(1).velocity.x(), -0.5);
}

// -- cooling, heaps, bits

// Without a contact time this collapses; with one it goes on, and loses energy in every collision
// that is not elastic.
TEST(HardGas, ThatCoolsDoesNotCollapse) {
  Random random(2);
  HardScene<2> scene;
  scene.grains = {0.1, 0};
  scene.box.periodic.fill(true);
  const auto grains = gas_of<2>(16, 0.4, random, scene.box);
  const double energy = HardEngine<2>(scene, grains).kinetic_energy();
  {
    HardEngine<2> engine(scene, grains);
    EXPECT_THROW(collide_pairs(engine, 256 * 200), ComputationFailed);
  }
  scene.contact_time = 1e-5;
  HardEngine<2> engine(scene, grains);
  collide_pairs(engine, 256 * 200);
  EXPECT_LT(engine.kinetic_energy(), 0.02 * energy);
  EXPECT_NEAR(engine.kinetic_energy() + engine.lost(), energy, 1e-12 * energy);
  EXPECT_GT(engine.tally().elastic, 0);
}

// Grains fall into a box and lie on each other: hard grains do not rest so, but go on, at speeds of
// g t_c, with a dozen of collisions of each in a contact time, and the books stay closed.
template <int D>
void expect_heap() {
  Random random(12);
  HardScene<D> scene;
  scene.grains = {0.6, 0.3};
  scene.contact_time = 5e-3;
  const auto grains = gas_of<D>(D == 2 ? 6 : 3, 0.3, random, scene.box);
  scene.gravity[D - 1] = -9.81;
  scene.walls = walls_of(scene.box, {0.6, 0.3});
  HardEngine<D> engine(scene, grains);
  const auto energy = [&] {
    double sum = engine.kinetic_energy() + engine.lost();
    for (const Body<D>& g : bodies_of(engine))
      sum -= scene.gravity.dot(g.position) / g.inverse_mass;
    return sum;
  };
  const double before = energy(), n = static_cast<double>(grains.size());
  engine.advance(1L << 40, 4);
  EXPECT_NEAR(energy(), before, 1e-9 * before);
  const long collisions = engine.tally().pairs + engine.tally().walls;
  engine.advance(1L << 40, 4.5);
  EXPECT_NEAR(energy(), before, 1e-9 * before);
  EXPECT_GT(nearest(scene.box, bodies_of(engine)), 1 - 1e-10);
  EXPECT_LT(engine.kinetic_energy() / n, 12 * std::pow(9.81 * scene.contact_time, 2));
  EXPECT_LT(static_cast<double>(engine.tally().pairs + engine.tally().walls - collisions),
            20 * n * 0.5 / scene.contact_time);
}

TEST(HardHeap, GoesOnAtTheSpeedOfTheContactTime) {
  expect_heap<2>();
  expect_heap<3>();
}

template <int D>
std::string image_of(HardEngine<D>& engine) {
  ImageWriter writer;
  const auto put = [&](const auto& value) { writer.put(value); };
  engine.visit(put);
  return writer.bytes();
}

template <int D>
void expect_same_bits(const std::vector<Body<D>>& a, const std::vector<Body<D>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].position, b[k].position) << k;
    EXPECT_EQ(a[k].velocity, b[k].velocity) << k;
    EXPECT_EQ(a[k].spin, b[k].spin) << k;
  }
}

// However it is cut, and when it goes on from its image. Long enough for the clock to start anew.
template <int D>
void expect_bits() {
  Random random(6);
  HardScene<D> scene;
  scene.grains = {0.9, 0.3};
  scene.contact_time = 1e-6;
  const auto grains = gas_of<D>(D == 2 ? 8 : 4, 0.3, random, scene.box);
  scene.gravity[D - 1] = -0.3;
  scene.box.periodic[0] = true;
  scene.walls = walls_of(scene.box, {0.8, 0.2});
  constexpr long kEvents = 20000;
  HardEngine<D> once(scene, grains);
  once.advance(kEvents);
  ASSERT_GT(once.tally().events, 64 * 64);
  HardEngine<D> cut(scene, grains);
  for (int k = 1; cut.tally().events < 7777; ++k) {
    cut.advance(std::min(7777 - cut.tally().events, 13L), 0.01 * k);
    cut.kinetic_energy();
  }
  const std::string image = image_of(cut);
  ImageReader reader(image);
  HardEngine<D> again(scene, grains);
  const auto get = [&](auto& value) { reader.get(value); };
  again.visit(get);
  reader.finish();
  ASSERT_TRUE(again.settle());
  cut.advance(kEvents - 7777);
  again.advance(kEvents - 7777);
  expect_same_bits(bodies_of(once), bodies_of(cut));
  expect_same_bits(bodies_of(once), bodies_of(again));
  EXPECT_EQ(once.time(), again.time());
  EXPECT_EQ(once.tally().virial, again.tally().virial);
  EXPECT_EQ(once.tally().repeated, again.tally().repeated);

  // What is no state is said to be none.
  HardEngine<D> other(scene, std::vector<Body<D>>(grains.begin(), grains.end() - 1));
  ImageReader second(image);
  const auto put = [&](auto& value) { second.get(value); };
  other.visit(put);
  EXPECT_FALSE(other.settle());
}

TEST(HardEngine, HasTheSameBitsHoweverItIsCut) {
  expect_bits<2>();
  expect_bits<3>();
}

// -- steps of time

// The mean over many phases of the step: collisions come half a step late, which is of first order.
TEST(HardSteps, ApproachTheEventsInFirstOrder) {
  HardScene<2> scene;
  scene.box.size = {20, 4};
  scene.box.periodic = {false, true};
  scene.grains = {0.8, 0};
  scene.walls = walls_of(scene.box, {0.9, 0});
  const auto place = [&](double start, double step) {
    std::vector<Body<2>> grains{round_grain<2>(0.5), round_grain<2>(0.5, 3)};
    grains[0].position = {start, 1};
    grains[0].velocity = {2, 0};
    grains[1].position = {8, 1};
    constexpr double kEnd = 4;
    if (step == 0) {
      HardEngine<2> engine(scene, grains);
      engine.advance(1000, kEnd);
      return engine.body(0).position.x();
    }
    HardSteps<2> steps(scene, grains, step);
    steps.step(std::lround(kEnd / step));
    return steps.bodies()[0].position.x();
  };
  const auto error = [&](double step) {
    double sum = 0;
    constexpr int kPhases = 200;
    for (int k = 0; k < kPhases; ++k) {
      const double start = 3 + 2 * step * (k + 0.5) / kPhases;
      sum += place(start, step) - place(start, 0);
    }
    return sum / kPhases;
  };
  const double errors[] = {error(0.04), error(0.02), error(0.01)};
  EXPECT_GT(std::fabs(errors[0]), 1e-3);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(std::log2(errors[k] / errors[k + 1]), 1, 0.1) << k;
}

TEST(HardSteps, OfElasticGrainsKeepEnergy) {
  Random random(9);
  HardScene<3> scene;
  const auto grains = gas_of<3>(5, 0.2, random, scene.box);
  scene.gravity.z() = -1;
  scene.walls = walls_of(scene.box, {1, 0});
  HardSteps<3> steps(scene, grains, 0.01);
  const auto energy = [&] {
    double sum = 0;
    for (const Body<3>& b : steps.bodies()) {
      sum += (0.5 * b.velocity.squaredNorm() + b.position.z()) / b.inverse_mass;
    }
    return sum;
  };
  const double before = energy();
  steps.step(500);
  EXPECT_GT(steps.collisions(), 500);
  EXPECT_NEAR(energy(), before, 1e-11 * before);
}

// -- what is refused

std::string refusal(const HardScene<2>& scene, const std::vector<Body<2>>& grains) {
  try {
    HardEngine<2>(scene, grains);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(HardEngine, RefusesWhatIsNoStart) {
  HardScene<2> scene;
  scene.box.size = {10, 10};
  scene.box.periodic = {true, false};
  scene.walls = walls_of(scene.box, {0.5, 0});
  std::vector<Body<2>> grains{round_grain<2>(0.5), round_grain<2>(0.5)};
  grains[0].position = {0.2, 5};
  grains[1].position = {8, 5};
  EXPECT_EQ(refusal(scene, grains), "");
  auto other = grains;
  other[1].position.x() = 9.5;  // across the side
  EXPECT_THAT(refusal(scene, other),
              HasSubstr("grains 0 and 1: found an overlap of 0.3 m at the start, allowed: none"));
  other[1].position = {5, 0.25};
  EXPECT_THAT(refusal(scene, other), HasSubstr("grain 1: found 0.25 m behind a wall"));
  HardScene<2> wrong = scene;
  wrong.grains.restitution = 1.5;
  EXPECT_EQ(refusal(wrong, grains), "restitution: found 1.5, allowed: 0 to 1");
  wrong = scene;
  wrong.walls[0].law.friction = -1;
  EXPECT_EQ(refusal(wrong, grains), "friction: found -1, allowed: 0 or more");
  wrong = scene;
  wrong.box.size.x() = 2.9;
  grains[1].position.x() = 1.5;
  EXPECT_THAT(refusal(wrong, grains), HasSubstr("box: found 2.9 m along a periodic axis"));
  EXPECT_THROW(HardSteps<2>(scene, grains, 0), std::invalid_argument);
}

}  // namespace
}  // namespace grainfield::dem
