// Rows of pairs of disks side by side (laws/disk_lanes.h): the bits of pair by pair, at every
// width.
#include <gtest/gtest.h>

#include <memory>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "tests/dem/at_lane_width.h"
#include "tests/dem/bits_scene.h"

namespace grainfield::dem {
namespace {

enum class Place { box, cell, heap };

struct Scene {
  Place place = Place::box;
  bool rolls = false;  ///< resistance against rolling
  int threads = 1;
  bool alone = false;  ///< with an energy balance, which asks for pair by pair
};

/// 256 disks of unlike size that fall, slide and roll: in a box, some of them inside another; in a
/// cell that shears; and on fixed ones, where they fall asleep.
std::unique_ptr<Engine> engine_of(const Scene& scene) {
  EngineSettings s;
  s.law = LinearLaw{300, 100, 2, 1};
  s.shape = ShapeKind::disk;
  s.time_step = 1e-3;
  s.friction = 0.3;
  s.gravity_y = scene.place == Place::cell ? 0 : -5;
  s.threads = scene.threads;
  s.energy_balance = scene.alone;
  if (scene.rolls) s.rolling = {100, 0.2, 0.2};
  constexpr double spacing = 1.9, width = 16 * spacing;
  if (scene.place == Place::cell) {
    s.cell.periodic = {true, true, false};
    s.cell.edges = width * Eigen::Matrix3d::Identity();
    s.cell.velocity_gradient(0, 1) = 0.1;
  }
  if (scene.place == Place::heap) s.sleep.on = true;
  auto engine = make_engine(s);
  if (scene.place != Place::cell) {
    engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.3});
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.3});
    engine->add_wall({"right", {width, 0, 0}, {-1, 0, 0}, 0.3});
  }
  Random random(11);
  const auto any = [&] { return random.uniform(-1, 1); };
  for (int k = 0; k < 256; ++k) {
    NewGrain g;
    g.radius = 0.8 + 0.4 * random.uniform();
    g.x = spacing * (k % 16 + 0.5) + 0.1 * any();
    g.y = spacing * (k / 16 + 0.5) + 0.1 * any();
    g.density = 1;
    g.fixed = scene.place == Place::heap && k < 16;
    if (!g.fixed && scene.place != Place::heap) {
      g.vx = any();
      g.vy = any();
      g.spin = any();
    }
    engine->add(g);
    if (scene.place == Place::box && k % 40 == 7) {
      g.radius *= 0.4;
      g.x += k == 7 ? 0 : 0.1;  // once about the same centre
      engine->add(g);
    }
  }
  if (scene.place == Place::heap) engine->set_background_damping(3);
  return engine;
}

class DiskLanes : public AtLaneWidth {};

TEST_P(DiskLanes, StepsAreThoseOfPairByPair) {
  for (const Place place : {Place::box, Place::cell, Place::heap}) {
    for (const bool rolls : {false, true}) {
      const auto run = [&](bool alone, int threads) {
        const auto engine = engine_of({place, rolls, threads, alone});
        engine->step(400);
        EXPECT_GT(engine->measure().contacts, 100);
        return bits::hash_of(engine->snapshot());
      };
      const std::uint64_t alone = run(true, 1);
      for (const int threads : {1, 2, 3}) {
        EXPECT_EQ(run(false, threads), alone)
            << "place " << static_cast<int>(place) << " threads " << threads << " rolls " << rolls;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, DiskLanes, testing::Values(2, 4, 8));

}  // namespace
}  // namespace grainfield::dem
