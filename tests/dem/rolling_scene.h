// Grains that resist rolling and twisting: one on a floor, and a crowd in a drum.
#pragma once
#include <cmath>
#include <memory>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "tests/dem/bits_scene.h"

namespace grainfield::dem {

inline constexpr double kGravity = 9.81, kRadius = 0.01;

inline EngineSettings settings_of(bool space, const RollingLaw& rolling) {
  EngineSettings s;
  s.shape = space ? ShapeKind::sphere : ShapeKind::disk;
  s.law = LinearLaw{1e6, 4e5, 1000, 500};
  if (space) s.law = LinearLaw{1e4, 4e3, 1000, 500};
  s.friction = 1;
  s.rolling = rolling;
  s.time_step = 1e-5;
  s.gravity_y = 0;
  return s;
}
inline Vec3 up(bool space) { return space ? Vec3::UnitZ() : Vec3::UnitY(); }

/// A grain on the floor, pressed as deep as `weight` N (1e6, 1e4 N/m) presses it.
inline std::unique_ptr<Engine> on_floor(const EngineSettings& s, double weight,
                                        double spin_up = 0) {
  const bool space = s.shape == ShapeKind::sphere;
  auto engine = make_engine(s);
  engine->add_wall({"floor", {0, 0, 0}, up(space), 1});
  NewGrain g;
  g.radius = kRadius;
  g.density = 2500;
  (space ? g.z : g.y) = kRadius - weight / std::get<LinearLaw>(s.law).normal_stiffness;
  g.spin = spin_up;
  engine->add(g);
  return engine;
}
inline double mass_of(bool space) {
  constexpr double kPi = std::numbers::pi;
  return 2500 * (space ? 4.0 / 3 * kPi * std::pow(kRadius, 3) : kPi * kRadius * kRadius);
}

inline Wall drum_of(bool space) {
  Wall drum{"drum", {0, 0, 0}, space ? Vec3::UnitY() : Vec3::UnitZ(), 0.5, "cylinder"};
  drum.radius = 0.05;
  drum.angular_velocity = 4 * drum.normal;
  return drum;
}

/// A crowd of two materials in a drum that turns.
inline bits::Scene crowd(bool space, bool rolls = true) {
  bits::Scene scene;
  EngineSettings& s = scene.settings;
  s = settings_of(space, {});
  const AnyLaw law = space ? AnyLaw(HertzLaw{1e7, 0.3, 0.2}) : s.law;
  const double scale = space ? 1 : 100;
  RollingLaw glass{300 * scale, 0.1 * scale, 0.3};
  if (space) glass = {300, 0.1, 0.3, 1e-2, 1e-6, 1e-3};
  RollingLaw mixed = glass;
  mixed.friction = 0.1;
  s.materials = {"glass", "steel"};
  s.material_pairs = {{"glass", "glass", law, 0.4, rolls ? glass : RollingLaw{}},
                      {"glass", "steel", law, 0.3, rolls ? mixed : RollingLaw{}},
                      {"steel", "steel", law, 0.5}};
  (space ? s.gravity_z : s.gravity_y) = -100;  // they soon lie together
  scene.steps = 6000;
  scene.walls = {drum_of(space)};
  if (space) {
    scene.walls.push_back({"front", {0, -0.02, 0}, {0, 1, 0}, 0.1});
    scene.walls.push_back({"back", {0, 0.02, 0}, {0, -1, 0}, 0.1});
  }
  Random random(4);
  for (int k = 0; k < (space ? 98 : 49); ++k) {
    NewGrain g;
    g.radius = random.uniform(0.003, 0.0045);
    g.density = 2500;
    g.x = 0.0091 * (k % 7 - 3);
    (space ? g.z : g.y) = 0.0091 * (k / 7 % 7 - 3);
    if (space) g.y = k < 49 ? -0.008 : 0.008;
    g.vx = random.uniform(-0.3, 0.3);
    g.spin = random.uniform(-20, 20);
    if (space) g.spin_x = random.uniform(-20, 20);
    g.material = k % 3 == 0 ? "steel" : "glass";
    scene.grains.push_back(g);
  }
  return scene;
}

}  // namespace grainfield::dem
