// Settled heptagons, round or slender: a box of columns x rows on a floor between walls, shaken
// down from a grid with damping, then awake and undamped; copies side by side (every second one
// mirrored) for more grains.
#pragma once
#include <cmath>
#include <memory>
#include <numbers>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::benchmarks {

inline dem::EngineSettings heptagon_settings(int threads, double aspect = 1) {
  dem::EngineSettings s;
  s.law = dem::OverlapAreaLaw{1e7, 0.75};
  s.friction = 0.54;
  s.shape = dem::ShapeKind::polygon;
  s.threads = threads;
  s.time_step = 7e-6 / aspect;
  return s;
}

/// At rest to an unbalanced force ratio of about 1e-3, in a box `width` wide. `aspect`: of the
/// ellipses, all of one area, that the corners lie on; slender grains begin flat.
inline dem::Snapshot settled_heptagons(int columns, int rows, double& width, double aspect = 1) {
  constexpr double kCell = 0.0064;
  const double longer = std::sqrt(aspect), cell_x = kCell * longer, cell_y = kCell / longer;
  width = columns * cell_x;
  auto engine = dem::make_engine(heptagon_settings(2, aspect));
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.54});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.54});
  engine->add_wall({"right", {width, 0, 0}, {-1, 0, 0}, 0.54});
  dem::Random random(1);
  for (int k = 0; k < columns * rows; ++k) {
    dem::NewGrain g;
    const double radius = 0.00275 * random.uniform(0.9, 1.1);
    for (int c = 0; c < 7; ++c) {
      const double angle = 2 * std::numbers::pi / 7 * (c + random.uniform(-0.2, 0.2));
      g.outline.push_back({radius * longer * std::cos(angle), radius / longer * std::sin(angle)});
    }
    g.outline = dem::centred_outline(g.outline);
    g.x = (k % columns + 0.5) * cell_x;
    g.y = (k / columns + 0.5) * cell_y;
    g.angle = aspect > 1 ? 0 : random.uniform(0, 2 * std::numbers::pi);
    g.density = 5000;
    engine->add(g);
  }
  engine->set_background_damping(20);
  engine->step(static_cast<long>(30000 * aspect));
  return engine->snapshot();
}

inline std::unique_ptr<dem::Engine> heptagon_scene(const dem::Snapshot& box, double width,
                                                   int tiles, int threads, double aspect = 1) {
  auto engine = dem::make_engine(heptagon_settings(threads, aspect));
  engine->add_wall({"floor", {0, 0, 0}, {0, 1, 0}, 0.54});
  engine->add_wall({"left", {0, 0, 0}, {1, 0, 0}, 0.54});
  engine->add_wall({"right", {width * tiles, 0, 0}, {-1, 0, 0}, 0.54});
  for (int tile = 0; tile < tiles; ++tile) {
    const bool mirrored = tile % 2 == 1;
    for (const dem::Grain& grain : box.grains) {
      dem::NewGrain g;
      g.x = width * tile + (mirrored ? width - grain.position.x() : grain.position.x());
      g.y = grain.position.y();
      g.angle = mirrored ? -grain.angle : grain.angle;
      g.outline = grain.outline;
      if (mirrored) {
        for (auto& corner : g.outline) corner[0] = -corner[0];
        g.outline = dem::centred_outline({g.outline.rbegin(), g.outline.rend()});
      }
      g.density = 5000;
      engine->add(g);
    }
  }
  return engine;
}

}  // namespace grainfield::benchmarks
