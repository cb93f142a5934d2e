// Grains of one size among walls that move.
#pragma once
#include "dem/engine/engine.h"

namespace grainfield::dem {

inline constexpr double kRadius = 0.01;

inline EngineSettings disks(const AnyLaw& law, double step) {
  EngineSettings s;
  s.law = law;
  s.time_step = step;
  s.gravity_y = 0;
  return s;
}
inline EngineSettings spheres(const AnyLaw& law, double step) {
  EngineSettings s = disks(law, step);
  s.shape = ShapeKind::sphere;
  return s;
}
inline NewGrain grain(const Vec3& at, const Vec3& v, double radius = kRadius) {
  NewGrain g;
  g.x = at.x();
  g.y = at.y();
  g.z = at.z();
  g.vx = v.x();
  g.vy = v.y();
  g.vz = v.z();
  g.radius = radius;
  g.density = 2500;
  return g;
}
inline WallMotion moving(const Vec3& v, const Vec3& turning = {0, 0, 0}) { return {v, turning}; }

}  // namespace grainfield::dem
