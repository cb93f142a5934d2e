// A gas of superellipsoids in a box, and how far its energy drifts.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "dem/engine/engine.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem::gas {

using Eigen::Vector3d;

inline EngineSettings settings_of(const AnyLaw& law, double step) {
  EngineSettings s;
  s.law = law;
  s.shape = ShapeKind::superellipsoid;
  s.time_step = step;
  s.gravity_y = 0;
  s.friction = 0;
  return s;
}

inline NewGrain grain_of(const Superellipsoid& body, const Vector3d& at,
                         const RotationOf<3>& turn) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.density = 1;
  g.axes = {body.axes.x(), body.axes.y(), body.axes.z()};
  g.exponents = body.exponents;
  g.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
  return g;
}

/// Grains in a box of this half width, on a lattice, moving about.
inline void add_gas(Engine& engine, int edge, double spacing, double least, double most,
                    double speed, std::uint64_t seed = 7) {
  Random random(seed);
  for (int k = 0; k < edge * edge * edge; ++k) {
    const Vector3d place(k % edge, k / edge % edge, k / edge / edge);
    const Vector3d at = spacing * (place + Vector3d::Constant(0.5));
    const Superellipsoid body = random_superellipsoid(random, least, most);
    NewGrain g = grain_of(body, at, random_rotation(random));
    const Vector3d v = speed * random_direction(random), w = speed * random_direction(random);
    g.vx = v.x();
    g.vy = v.y();
    g.vz = v.z();
    g.spin_x = w.x();
    g.spin_y = w.y();
    g.spin = w.z();
    engine.add(g);
  }
}
inline void add_box(Engine& engine, double edge, double friction = 0) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d n = Vector3d::Unit(axis);
    const std::string name(1, "xyz"[axis]);
    engine.add_wall({"low " + name, {0, 0, 0}, n, friction});
    engine.add_wall({"high " + name, edge * n, -n, friction});
  }
}
inline double energy_of(const Engine& engine) {
  const Diagnostics d = engine.measure();
  return d.kinetic_energy + d.elastic_energy;
}

struct Drift {
  double worst = 0;  ///< largest |E/E(0) - 1| at any look
  int contacts = 0;  ///< of all looks together
};
/// Over so many looks, each after so many steps.
inline Drift drift_of(Engine& engine, int looks, long steps) {
  engine.step(1);
  const double before = energy_of(engine);
  Drift out;
  for (int k = 0; k < looks; ++k) {
    engine.step(steps);
    out.worst = std::max(out.worst, std::fabs(energy_of(engine) / before - 1));
    out.contacts += engine.measure().contacts;
  }
  return out;
}

}  // namespace grainfield::dem::gas
