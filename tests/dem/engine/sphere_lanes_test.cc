// Rows of pairs of spheres side by side (sphere_lanes.h): the bits of pair by pair, at every width.
#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "tests/dem/at_lane_width.h"
#include "tests/dem/bits_scene.h"

namespace grainfield::dem {
namespace {

enum class Place { box, cell, heap };

struct Scene {
  Place place = Place::box;
  AnyLaw law;
  bool rolls = false;   ///< resistance against rolling and twisting
  bool damped = false;  ///< by local damping and a drag
  int threads = 1;
  bool alone = false;  ///< with an energy balance, which asks for pair by pair
};

/// 343 spheres of unlike size that fall, slide and roll: in a box, in a cell that shears, and on
/// fixed ones, where they fall asleep.
std::unique_ptr<Engine> engine_of(const Scene& scene) {
  EngineSettings s;
  s.law = scene.law;
  s.shape = ShapeKind::sphere;
  s.time_step = 1e-3;
  s.friction = 0.3;
  s.gravity_y = 0;
  s.gravity_z = scene.place == Place::cell ? 0 : -5;
  s.threads = scene.threads;
  s.energy_balance = scene.alone;
  if (scene.damped) s.local_damping = 0.2;
  if (scene.rolls) s.rolling = {100, 0.2, 0.2, 20, 0.05, 0.1};
  constexpr double spacing = 1.9, width = 7 * spacing;
  if (scene.place == Place::cell) {
    s.cell.periodic = {true, true, true};
    s.cell.edges = width * Eigen::Matrix3d::Identity();
    s.cell.velocity_gradient(0, 2) = 0.1;
  }
  if (scene.place == Place::heap) s.sleep.on = true;
  auto engine = make_engine(s);
  for (int axis = 0; axis < 3 && scene.place != Place::cell; ++axis) {
    const Eigen::Vector3d n = Eigen::Vector3d::Unit(axis);
    const std::string name(1, "xyz"[axis]);
    engine->add_wall({"low " + name, {0, 0, 0}, n, 0.3});
    engine->add_wall({"high " + name, width * n, -n, 0.3});
  }
  Random random(11);
  const auto any = [&] { return random.uniform(-1, 1); };
  for (int k = 0; k < 343; ++k) {
    NewGrain g;
    g.radius = 0.8 + 0.4 * random.uniform();
    g.x = spacing * (k % 7 + 0.5) + 0.1 * any();
    g.y = spacing * (k / 7 % 7 + 0.5) + 0.1 * any();
    g.z = spacing * (k / 49 + 0.5) + 0.1 * any();
    g.density = 1;
    g.fixed = scene.place == Place::heap && k < 49;
    if (!g.fixed && scene.place != Place::heap) {
      g.vx = any();
      g.vy = any();
      g.vz = any();
      g.spin_x = any();
      g.spin_y = any();
      g.spin = any();
    }
    engine->add(g);
  }
  if (scene.place == Place::heap || scene.damped) engine->set_background_damping(3);
  return engine;
}

HertzLaw hertz(bool displacement, bool viscoelastic) {
  HertzLaw law{2e3, 0.3, 0.2};
  law.displacement = displacement;
  law.viscoelastic = viscoelastic;
  law.normal_damping = 2;
  law.tangential_damping = 1;
  return law;
}

class SphereLanes : public AtLaneWidth {};

TEST_P(SphereLanes, EveryLawIsThatOfOnePair) {
  const AnyLaw laws[] = {hertz(false, false), hertz(true, true), LinearLaw{300, 100, 2, 1},
                         PenaltyLaw{300, 200, 0.2}};
  for (const AnyLaw& law : laws) {
    const bool odd = (&law - laws) % 2 == 1;
    for (const Place place : {Place::box, Place::cell, Place::heap}) {
      const bool rolls = place != Place::box || law.index() == laws[0].index();
      const auto run = [&](bool alone, int threads) {
        const auto engine =
            engine_of({place, law, rolls, odd && place == Place::box, threads, alone});
        engine->step(300);
        EXPECT_GT(engine->measure().contacts, 150);
        return bits::hash_of(engine->snapshot());
      };
      const std::uint64_t alone = run(true, 1);
      for (const int threads : {1, 2, 3}) {
        EXPECT_EQ(run(false, threads), alone)
            << law.index() << " place " << static_cast<int>(place) << " threads " << threads;
      }
    }
  }
}

// A step alone goes pair by pair and begins grain by grain.
TEST_P(SphereLanes, ManyStepsAreAsManyTimesOne) {
  for (const Place place : {Place::box, Place::cell}) {
    const auto run = [&](int at_once) {
      const auto engine = engine_of({place, hertz(false, false), false, false, 2, false});
      for (int k = 0; k < 120; k += at_once) engine->step(at_once);
      return bits::hash_of(engine->snapshot());
    };
    EXPECT_EQ(run(120), run(1));
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, SphereLanes, testing::Values(2, 4, 8));

}  // namespace
}  // namespace grainfield::dem
