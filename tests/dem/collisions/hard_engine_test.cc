// Hard grains from collision to collision: every collision against an engine that looks at all
// pairs, the same bits however a run is cut, steps of time, what is refused.
#include "dem/collisions/hard_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dem/collisions/hard_steps.h"
#include "tests/dem/hard_scene.h"
#include "tests/refusal.h"

namespace grainfield::dem {
namespace {

using namespace testing;
using ::testing::HasSubstr;

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

// Grains of infinite mass: others bounce from them as from a wall.
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

template <int D>
std::string checkpoint_of(HardEngine<D>& engine) {
  CheckpointWriter writer;
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

// However it is cut, and when it goes on from its checkpoint. Long enough for the clock to start
// anew.
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
  const std::string checkpoint = checkpoint_of(cut);
  CheckpointReader reader(checkpoint);
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
  CheckpointReader second(checkpoint);
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
  return refusal_of([&] { HardEngine<2>(scene, grains); });
}

TEST(HardEngine, RefusesWhatIsNoStart) {
  HardScene<2> scene;
  scene.box.size = {10, 10};
  scene.box.periodic = {true, false};
  scene.walls = walls_of(scene.box, {0.5, 0});
  std::vector<Body<2>> grains{round_grain<2>(0.5), round_grain<2>(0.5)};
  grains[0].position = {0.2, 5};
  grains[1].position = {8, 5};
  EXPECT_EQ(refusal(scene, grains), "accepted");
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
