// Polygons poured onto a floor, for tests of the engine.
#pragma once
#include <cmath>
#include <memory>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {

/// A convex polygon with `corners` on a circle, their angles scattered by 40 % of their spacing.
inline Outline scattered_polygon(Random& random, double radius, int corners) {
  Outline outline;
  const double spacing = 2 * std::numbers::pi / corners;
  for (int k = 0; k < corners; ++k) {
    const double angle = spacing * (k + random.uniform(-0.2, 0.2));
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return centred_outline(outline);
}

inline EngineSettings polygon_settings(int threads = 1, bool sleep = false) {
  EngineSettings s;
  s.law = OverlapAreaLaw{1e6, 0.75};
  s.friction = 0.5;
  s.shape = ShapeKind::polygon;
  s.threads = threads;
  s.sleep.on = sleep;
  s.sleep.quiet_time = 5e-3;  // these grains are softer than Roul's, their contacts swing slower
  s.sleep.quiet_move = 6e-3;
  s.time_step = 4e-5;
  return s;
}

inline NewGrain polygon_grain(Random& random, double x, double y, double radius = 0.01,
                              int corners = 7) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.angle = random.uniform(0, 6.28);
  g.density = 5000;
  g.outline = scattered_polygon(random, radius, corners);
  return g;
}

/// A box of columns x rows polygons of mixed size (every fifth a disk), a little apart, on a floor
/// between walls.
inline std::unique_ptr<Engine> polygon_box(const EngineSettings& settings, int columns, int rows,
                                           int seed = 1) {
  auto engine = make_engine(settings);
  Random random(seed);
  const double cell = 0.023;
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.5});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.2});
  engine->add_wall({"right", {columns * cell, 0, 0}, {-1, 0, 0}, 0.2});
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double radius = random.uniform(0.007, 0.011);
      NewGrain g = polygon_grain(random, (column + 0.5) * cell, (row + 0.5) * cell, radius,
                                 5 + static_cast<int>(4 * random.uniform()));
      if ((row * columns + column) % 5 == 4) {
        g.outline.clear();
        g.radius = radius;
      }
      engine->add(g);
    }
  }
  return engine;
}

}  // namespace grainfield::dem
