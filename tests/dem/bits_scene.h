// Scenes whose end states are known to the bit. Nothing in them depends on the C library's sine and
// cosine: outlines are given as numbers or turned by rotation.h.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"
#include "dem/space/rotation.h"

namespace grainfield::dem::bits {

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(std::uint64_t bits) {
    for (int k = 0; k < 8; ++k) {
      value_ = (value_ ^ (bits >> (8 * k) & 0xFF)) * 0x100000001b3ULL;
    }
  }
  void add(const Vec3& v) {
    for (int k = 0; k < 3; ++k) add(v[k] + 0.0);  // -0 of a component that is not used
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Of all that moves or pushes: what a snapshot says of grains (by id) and contacts (by ids).
inline std::uint64_t hash_of(const Snapshot& s) {
  Hash h;
  h.add(s.time);
  h.add(s.applied_force);
  for (const Grain& g : s.grains) {
    h.add(g.position);
    h.add(g.velocity);
    h.add(g.angle);
    h.add(g.spin);
    if (s.dim == 2) continue;
    for (const double q : g.orientation) h.add(q);
    h.add(g.angular_velocity);
  }
  for (const Contact& c : s.contacts) {
    h.add(static_cast<std::uint64_t>(c.i));
    h.add(static_cast<std::uint64_t>(c.j));
    h.add(c.point);
    h.add(c.normal);
    h.add(c.force);
    h.add(c.spring);
    h.add(static_cast<std::uint64_t>(c.sliding));
    if (s.dim == 3) h.add(c.spring_vector);
  }
  return h.value();
}

struct Scene {
  std::string name;
  std::uint64_t hash = 0;  ///< of the end state
  EngineSettings settings;
  long steps = 0;
  std::vector<Wall> walls;
  std::vector<NewGrain> grains;
  /// What happens at a step, in order.
  std::vector<std::pair<long, std::function<void(Engine&)>>> events;
};

inline std::unique_ptr<Engine> box_of(const Scene& scene, int threads) {
  EngineSettings settings = scene.settings;
  settings.threads = threads;
  auto engine = make_engine(settings);
  for (const Wall& wall : scene.walls) engine->add_wall(wall);
  return engine;
}

/// The end state. `step_to` makes steps up to the one given; it may put another engine in its
/// place.
inline Snapshot end_of(const Scene& scene, std::unique_ptr<Engine>& engine,
                       const std::function<void(long)>& step_to) {
  for (const NewGrain& g : scene.grains) engine->add(g);
  for (const auto& [step, event] : scene.events) {
    step_to(step);
    event(*engine);
  }
  step_to(scene.steps);
  return engine->snapshot();
}

/// The end state. `cut`: step at which the engine is written as a checkpoint and another one, on
/// `threads_after` threads, goes on from it; -1: never.
inline Snapshot end_of(const Scene& scene, int threads, long cut = -1, int threads_after = 1) {
  auto engine = box_of(scene, threads);
  return end_of(scene, engine, [&](long step) {
    if (cut > engine->steps() && cut <= step) {
      engine->step(cut - engine->steps());
      const std::string checkpoint = engine->checkpoint();
      engine = box_of(scene, threads_after);
      engine->restore(checkpoint);
    }
    engine->step(step - engine->steps());
  });
}

/// The end state on one thread; `look` sees the engine every 500 steps.
inline Snapshot end_of(const Scene& scene, const std::function<void(const Engine&)>& look) {
  auto engine = box_of(scene, 1);
  return end_of(scene, engine, [&](long step) {
    while (engine->steps() < step) {
      engine->step(std::min(500L, step - engine->steps()));
      look(*engine);
    }
  });
}

inline std::vector<Wall> walls_of_box(double width) {
  return {{"floor", {0, 0, 0}, {0, 1, 0}, 0.5},
          {"left", {0, 0, 0}, {1, 0, 0}, 0.2},
          {"right", {width, 0, 0}, {-0.96, 0.28, 0}, 0.1}};
}

inline EngineSettings settings_of(bool linear, IntegratorKind integrator) {
  EngineSettings s;
  s.law = OverlapAreaLaw{1e6, 0.75};
  if (linear) s.law = LinearLaw{1e6, 3e5, 1000, 500};
  s.integrator = integrator;
  s.time_step = integrator == IntegratorKind::gear ? 1e-5 : 3e-5;
  return s;
}

/// A convex heptagon about a circle, its corners scattered.
inline Outline heptagon(Random& random, double radius) {
  constexpr double kStep = 0.8975979010256552;  // 2 pi / 7
  Outline outline;
  for (int k = 0; k < 7; ++k) {
    const auto [c, s] = rotation_of(kStep * (k + random.uniform(-0.2, 0.2)));
    outline.push_back({radius * c, radius * s});
  }
  return centred_outline(outline);
}

inline Outline rectangle(double half_length, double half_width) {
  return {{-half_length, -half_width},
          {half_length, -half_width},
          {half_length, half_width},
          {-half_length, half_width}};
}

enum class Kind { disks, polygons, slender };

/// Rows of grains that overlap their neighbours here and there, on their way down.
inline std::vector<NewGrain> block(Kind kind, int columns, int rows, double cell, int seed) {
  Random random(seed);
  std::vector<NewGrain> grains;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      NewGrain g;
      g.x = (column + 0.6 + random.uniform(-0.05, 0.05)) * cell;
      g.y = (row + 0.45 + random.uniform(-0.05, 0.05)) * cell;
      g.vx = random.uniform(-0.3, 0.3);
      g.vy = random.uniform(-0.6, 0);
      g.angle = random.uniform(0, 6.28);
      g.spin = random.uniform(-8, 8);
      g.density = 5000;
      g.radius = random.uniform(0.38, 0.5) * cell;
      if (kind == Kind::polygons && (row * columns + column) % 5 != 4) {
        g.outline = heptagon(random, g.radius);
      }
      if (kind == Kind::slender && (row + column) % 4 != 3) {
        g.outline = rectangle(0.47 * cell, random.uniform(0.05, 0.12) * cell);
      }
      grains.push_back(g);
    }
  }
  return grains;
}

}  // namespace grainfield::dem::bits
