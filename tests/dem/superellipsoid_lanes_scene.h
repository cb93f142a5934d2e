// Superellipsoids packed in a cell that shears or in a box, whose end state is known to the bit:
// nothing depends on the C library's sine and cosine.
#pragma once
#include <memory>
#include <string>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/superellipsoid.h"
#include "tests/dem/superellipsoid_scene.h"

namespace grainfield::dem {

struct LanesScene {
  bool cell = false;
  AnyLaw law = HertzEllipticLaw{1e5, 0.3, 0.3};
  int threads = 1;
  bool energy_balance = false;  ///< the law goes contact by contact
};

/// 64 grains with friction; some are ellipsoids, some have sharp edges.
inline std::unique_ptr<Engine> lanes_scene(const LanesScene& scene) {
  EngineSettings s;
  s.law = scene.law;
  s.shape = ShapeKind::superellipsoid;
  s.time_step = 2e-4;
  s.friction = 0.4;
  s.gravity_y = 0;
  s.gravity_z = scene.cell ? 0 : -5;
  s.threads = scene.threads;
  s.energy_balance = scene.energy_balance;
  if (scene.cell) {
    s.cell.periodic = {true, true, true};
    s.cell.edges = 7.8 * Eigen::Matrix3d::Identity();
    s.cell.velocity_gradient(0, 2) = 0.3;
  }
  auto engine = make_engine(s);
  constexpr double spacing = 1.95;
  for (int axis = 0; axis < 3 && !scene.cell; ++axis) {
    const Eigen::Vector3d n = Eigen::Vector3d::Unit(axis);
    const std::string name(1, "xyz"[axis]);
    engine->add_wall({"low " + name, {0, 0, 0}, n, 0.3});
    engine->add_wall({"high " + name, 4 * spacing * n, -n, 0.3});
  }
  Random random(7);
  const auto any = [&] { return random.uniform(-1, 1); };
  for (int k = 0; k < 64; ++k) {
    const Eigen::Vector3d place(k % 4, k / 4 % 4, k / 16);
    const Eigen::Vector3d at = spacing * (place + Eigen::Vector3d::Constant(0.5));
    const bool sharp = k % 3 == 0;
    const Superellipsoid body = random_superellipsoid(random, sharp ? 0.3 : 0.6, sharp ? 1.7 : 1.4);
    NewGrain g;
    g.x = at.x();
    g.y = at.y();
    g.z = at.z();
    g.density = 1;
    g.axes = {body.axes.x(), body.axes.y(), body.axes.z()};
    if (k % 5 != 0) g.exponents = body.exponents;
    Eigen::Vector4d q(any(), any(), any(), any());
    q /= std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    g.orientation = {q[0], q[1], q[2], q[3]};
    g.vx = any();
    g.vy = any();
    g.vz = any();
    g.spin_x = any();
    g.spin_y = any();
    g.spin = any();
    engine->add(g);
  }
  return engine;
}

}  // namespace grainfield::dem
