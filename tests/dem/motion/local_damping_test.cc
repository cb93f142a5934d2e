// Cundall's local damping: it ends motion and moves no equilibrium.
#include "dem/motion/local_damping.h"

#include <gmock/gmock.h>

#include <cmath>

#include "dem/engine/engine.h"

namespace grainfield::dem {
namespace {

EngineSettings settings_of(bool space, double alpha) {
  EngineSettings s;
  s.shape = space ? ShapeKind::sphere : ShapeKind::disk;
  s.law = LinearLaw{space ? 1e4 : 1e6, space ? 3e3 : 3e5, 0, 0};
  s.time_step = 1e-5;
  s.gravity_y = space ? 0 : -9.81;
  s.gravity_z = space ? -9.81 : 0;
  s.local_damping = alpha;
  return s;
}

// Up against g (1 + alpha), down with g (1 - alpha).
TEST(LocalDamping, TakesItsShareOfTheForceAlongTheMotion) {
  for (const bool space : {false, true}) {
    const auto engine = make_engine(settings_of(space, 0.4));
    NewGrain g;
    g.radius = 0.01;
    g.density = 2500;
    (space ? g.vz : g.vy) = 1;
    g.vx = 0.5;
    g.spin = 3;
    engine->add(g);
    const auto speed = [&] { return engine->snapshot().grains[0].velocity; };
    engine->step(1000);
    EXPECT_NEAR(speed()[space ? 2 : 1], 1 - 9.81 * 1.4 * 0.01, 1e-4);
    engine->step(30000);
    const double down = speed()[space ? 2 : 1];
    engine->step(1000);
    EXPECT_NEAR(speed()[space ? 2 : 1] - down, -9.81 * 0.6 * 0.01, 1e-10);
    EXPECT_EQ(speed().x(), 0.5);  // no force along x, no moment
    EXPECT_EQ(engine->snapshot().grains[0].spin, 3);
  }
}

// A column of three without a dashpot bounces and comes to rest; then all is as without damping.
TEST(LocalDamping, AColumnComesToRestInItsEquilibrium) {
  for (const bool space : {false, true}) {
    EngineSettings s = settings_of(space, 0.3);
    s.energy_balance = true;
    const auto engine = make_engine(s);
    engine->add_wall({"floor", {0, 0, 0}, space ? Vec3(0, 0, 1) : Vec3(0, 1, 0), 0.5});
    double mass = 0;
    for (int k = 0; k < 3; ++k) {
      NewGrain g;
      g.radius = 0.01;
      g.density = 2500;
      (space ? g.z : g.y) = 0.012 + 0.021 * k;
      engine->add(g);
    }
    engine->step(1);
    const Diagnostics before = engine->measure();
    engine->step(150000);
    const Diagnostics d = engine->measure();
    EXPECT_LT(d.unbalanced_force_ratio, 1e-9) << space;
    EXPECT_LT(d.kinetic_energy, 1e-15 * d.damped_energy) << space;
    EXPECT_GT(d.damped_energy, 0.5 * (before.potential_energy - d.potential_energy)) << space;
    EXPECT_NEAR(d.energy_balance(), before.energy_balance(), 2e-3 * d.damped_energy) << space;
    const Snapshot end = engine->snapshot();
    for (const Grain& g : end.grains) mass += g.mass;
    const double floor = end.walls[0].force[space ? 2 : 1];
    EXPECT_NEAR(-floor, mass * 9.81, 1e-9 * mass * 9.81) << space;
    // The top grain's overlap carries its weight alone.
    const int up = space ? 2 : 1;
    const double gap = end.grains[2].position[up] - end.grains[1].position[up];
    const double k = space ? 1e4 : 1e6;
    EXPECT_NEAR(k * (0.02 - gap), mass / 3 * 9.81, 1e-6 * mass * 9.81) << space;
  }
}

TEST(LocalDamping, IsRefusedOutOfRangeAndWithGear) {
  const auto refusal = [](double alpha, IntegratorKind integrator) {
    EngineSettings s = settings_of(false, alpha);
    s.integrator = integrator;
    try {
      make_engine(s);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(0.9, IntegratorKind::verlet), "accepted");
  EXPECT_EQ(refusal(0, IntegratorKind::gear), "accepted");
  EXPECT_EQ(refusal(1, IntegratorKind::verlet),
            "motion.local_damping: found 1, allowed: 0 or more, below 1");
  EXPECT_EQ(refusal(-0.1, IntegratorKind::verlet),
            "motion.local_damping: found -0.1, allowed: 0 or more, below 1");
  EXPECT_EQ(refusal(0.5, IntegratorKind::gear),
            "motion.local_damping: found 0.5 with motion.integrator \"gear\", allowed: verlet | "
            "runge_kutta (a "
            "force that leaps with the velocity's sign has no derivatives to predict)");
}

}  // namespace
}  // namespace grainfield::dem
