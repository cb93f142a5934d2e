// Gases of hard grains: pressure, energy and momentum, overlaps, cooling, and what becomes of a
// heap.
#include <gtest/gtest.h>

#include "dem/collisions/hard_engine.h"
#include "dem/shared/computation_failed.h"
#include "tests/dem/hard_scene.h"

namespace grainfield::dem {
namespace {

using namespace testing;

template <int D>
VectorOf<D> momentum_of(const std::vector<Body<D>>& grains) {
  VectorOf<D> sum = VectorOf<D>::Zero();
  for (const Body<D>& g : grains) sum += g.velocity / g.inverse_mass;
  return sum;
}

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

}  // namespace
}  // namespace grainfield::dem
