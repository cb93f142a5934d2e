// Small packings for the suites of quasi-static relaxation.
#pragma once
#include <vector>

#include "dem/grains/packing.h"
#include "dem/laws/material_setup.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"

namespace grainfield::dem {

inline constexpr double kG = 9.81;

inline EngineSettings area_law(double friction) {
  EngineSettings e;
  e.law = OverlapAreaLaw{1e7, 0.75};
  e.friction = friction;
  return e;
}

inline NewGrain disk(double x, double y, double r = 0.01) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.radius = r;
  g.density = 1000;
  return g;
}

inline NewGrain polygon(double x, double y, const Outline& outline) {
  NewGrain g;
  g.x = x;
  g.y = y;
  g.outline = centred_outline(outline);
  g.radius = circumradius_of(g.outline);
  g.density = 1000;
  return g;
}

inline Wall wall(const char* name, double x, double y, double nx, double ny, double mu) {
  return {name, {x, y, 0}, {nx, ny, 0}, mu};
}

/// The grains where they are put, without contacts.
inline Snapshot put(const std::vector<NewGrain>& grains, const std::vector<Wall>& walls) {
  EngineSettings e;
  e.shape = ShapeKind::polygon;
  e.time_step = 1e-7;
  const auto engine = make_engine(e);
  for (const NewGrain& g : grains) engine->add(g);
  for (const Wall& w : walls) engine->add_wall(w);
  Snapshot s = engine->snapshot();
  s.gravity = Vec3(0, -kG, 0);
  return s;
}

/// A block of touching disks on a triangular lattice, with radii jittered (each one smaller, so
/// that some contacts open), between walls.
inline Snapshot block(int columns, int rows, double friction) {
  PackingSetup p;
  p.kind = "triangular";
  p.sizes = "mono";
  p.columns = columns;
  p.rows = rows;
  Random random(1);
  std::vector<Wall> walls = layer_walls(p, MaterialSetup{});
  for (Wall& w : walls) w.friction = friction;
  return put(lattice_grains(p, 1000, random), walls);
}

inline double weight(const Snapshot& s) {
  double w = 0;
  for (const Grain& g : s.grains) w += g.fixed ? 0 : g.mass * s.gravity.norm();
  return w;
}

}  // namespace grainfield::dem
