// Spheres settled in a box, for the suites of their quasi-static relaxation.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"

namespace grainfield::dem {

inline constexpr double kG = 9.81, kRadius = 0.005, kDensity = 2500;

inline EngineSettings settings_of(const AnyLaw& law, double friction) {
  EngineSettings e;
  e.shape = ShapeKind::sphere;
  e.law = law;
  e.friction = friction;
  e.integrator = IntegratorKind::verlet;
  e.time_step = 2e-5;
  e.gravity_y = 0;
  e.gravity_z = -kG;
  return e;
}

inline NewGrain sphere(const Vec3& at, double radius = kRadius) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.radius = radius;
  g.density = kDensity;
  return g;
}

inline double mass_of(double radius) {
  return kDensity * 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

inline double weight_of(const Snapshot& s) {
  double weight = 0;
  for (const Grain& g : s.grains) weight += g.fixed ? 0 : g.mass * s.gravity.norm();
  return weight;
}

/// Steps until the mean resultant is this share of the mean contact force.
inline void come_to_rest(Engine& engine, double ratio) {
  engine.set_background_damping(40);
  for (int k = 0; k < 4000; ++k) {
    engine.step(500);
    const Diagnostics d = engine.measure();
    if (d.unbalanced_force_ratio < ratio && d.unbalanced_moment_ratio < ratio) return;
  }
  FAIL() << "no rest: " << engine.measure().unbalanced_force_ratio;
}

/// Poly-disperse spheres dropped into a box without friction at the sides, or into one that repeats
/// sideways, at rest.
inline std::unique_ptr<Engine> settled(EngineSettings e, bool periodic, int columns, int layers) {
  const double cell = 2.3 * kRadius, width = columns * cell;
  if (periodic) {
    e.cell.periodic = {true, true, false};
    e.cell.edges = Vec3(width, width, 1).asDiagonal();
  }
  auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 0, 1}, e.friction});
  if (!periodic) {
    engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0});
    engine->add_wall({"right", {width, 0, 0}, {-1, 0, 0}, 0});
    engine->add_wall({"front", {0, 0, 0}, {0, 1, 0}, 0});
    engine->add_wall({"back", {0, width, 0}, {0, -1, 0}, 0});
  }
  Random random(2);
  for (int k = 0; k < columns * columns * layers; ++k) {
    const auto at = [&](int n) { return cell * (n + 0.5 + 0.05 * random.uniform(-1, 1)); };
    engine->add(sphere({at(k % columns), at(k / columns % columns), at(k / (columns * columns))},
                       kRadius * random.uniform(0.85, 1.1)));
  }
  come_to_rest(*engine, 1e-8);
  return engine;
}

/// Poly-disperse disks dropped between two walls without friction, at rest.
inline std::unique_ptr<Engine> settled_disks(const EngineSettings& e, int columns, int rows,
                                             std::uint64_t seed) {
  const double cell = 2.3 * kRadius;
  auto engine = make_engine(e);
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, e.friction});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0});
  engine->add_wall({"right", {columns * cell, 0, 0}, {-1, 0, 0}, 0});
  Random random(seed);
  for (int k = 0; k < columns * rows; ++k) {
    const auto at = [&](int n) { return cell * (n + 0.5 + 0.05 * random.uniform(-1, 1)); };
    NewGrain g = sphere({at(k % columns), at(k / columns), 0});
    g.radius = kRadius * random.uniform(0.85, 1.1);
    engine->add(g);
  }
  come_to_rest(*engine, 1e-7);
  return engine;
}

}  // namespace grainfield::dem
