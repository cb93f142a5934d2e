// A box of spheres at rest under its weight, poured and settled by the engine.
#pragma once
#include "dem/engine/engine.h"
#include "dem/random/random.h"

namespace grainfield::test {

inline constexpr double kBoxSide = 0.06;  ///< along x and y, m

/// 330 spheres of 4.5 to 5.5 mm radius between a floor and four walls with friction, some nine
/// layers with a free surface; unbalanced forces 1e-7 of the contact forces.
inline const dem::Snapshot& settled_spheres() {
  static const dem::Snapshot snapshot = [] {
    dem::EngineSettings settings;
    settings.shape = dem::ShapeKind::sphere;
    settings.law = dem::LinearLaw{2e4, 6e3, 2000, 1000};
    settings.integrator = dem::IntegratorKind::verlet;
    settings.friction = 0.5;
    settings.time_step = 2e-5;
    settings.gravity_x = settings.gravity_y = 0;
    settings.gravity_z = -9.81;
    settings.threads = 1;
    const auto engine = dem::make_engine(settings);
    engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, 0.5});
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.5});
    engine->add_wall({"right", {kBoxSide, 0, 0}, {-1, 0, 0}, 0.5});
    engine->add_wall({"front", {0, 0, 0}, {0, 1, 0}, 0.5});
    engine->add_wall({"back", {0, kBoxSide, 0}, {0, -1, 0}, 0.5});
    dem::Random random(3);
    constexpr int columns = 5;
    const double cell = kBoxSide / columns;
    for (int k = 0; k < 330; ++k) {
      dem::NewGrain g;
      g.radius = 0.0045 + 0.001 * random.uniform();
      const auto at = [&](int n) { return (n + 0.5) * cell + (random.uniform() - 0.5) * 1e-3; };
      g.x = at(k % columns);
      g.y = at(k / columns % columns);
      g.z = at(k / (columns * columns));
      g.density = 2500;
      engine->add(g);
    }
    engine->set_background_damping(5);
    engine->step(20000);
    engine->set_background_damping(30);
    for (int k = 0; k < 100 && (k == 0 || engine->measure().unbalanced_force_ratio > 1e-7); ++k)
      engine->step(1000);
    return engine->snapshot();
  }();
  return snapshot;
}

}  // namespace grainfield::test
