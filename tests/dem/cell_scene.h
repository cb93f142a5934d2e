// Blocks of grains in periodic cells.
#pragma once
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "dem/engine/engine.h"
#include "dem/random/random.h"
#include "dem/shapes/polygon.h"
#include "dem/snapshot/cell_stress.h"
#include "dem/space/rotation.h"

namespace grainfield::dem::cells {

using Eigen::Matrix3d;

/// Periodic along all axes of `dim` dimensions.
inline Cell<3> cell_of(int dim, const Vec3& low, const Matrix3d& edges,
                       const Matrix3d& gradient = Matrix3d::Zero()) {
  Cell<3> cell;
  for (int a = 0; a < dim; ++a) {
    cell.periodic[a] = true;
    cell.edges.col(a) = edges.col(a);
  }
  cell.low = low;
  cell.velocity_gradient = gradient;
  return cell;
}

inline Matrix3d square(double length) { return length * Matrix3d::Identity(); }

inline Matrix3d simple_shear(double rate) {
  Matrix3d l = Matrix3d::Zero();
  l(0, 1) = rate;
  return l;
}

inline EngineSettings settings_of(const ShapeKind& shape, const Cell<3>& cell) {
  EngineSettings s;
  s.shape = shape;
  s.cell = cell;
  s.gravity_y = 0;
  s.time_step = 2e-4;
  s.law = LinearLaw{1e4, 3e3, 100, 50};
  s.friction = 0.5;
  return s;
}

/// n^dim grains about the points of a lattice of the cell, overlapping a little: spacing
/// |edge|/n along an edge, radii about half of it, random places and velocities.
inline std::vector<NewGrain> block(const ShapeKind& shape, const Cell<3>& cell, int n,
                                   std::uint64_t seed, double speed = 0.5) {
  const bool flat = shape.visit([](auto kind) { return kind.dim; }) == 2;
  Random random(seed);
  const double a = cell.edges.col(0).norm() / n;
  std::vector<NewGrain> grains;
  for (int k = 0; k < (flat ? n * n : n * n * n); ++k) {
    Vec3 share((k % n + 0.5) / n, (k / n % n + 0.5) / n, flat ? 0 : (k / n / n + 0.5) / n);
    for (int c = 0; c < (flat ? 2 : 3); ++c) share[c] += random.uniform(-0.12, 0.12) / n;
    const Vec3 x = cell.low + cell.edges * share;
    NewGrain g;
    g.x = x[0], g.y = x[1], g.z = flat ? 0 : x[2];
    g.radius = a * random.uniform(0.48, 0.6);
    g.density = 1000;
    g.vx = random.uniform(-speed, speed);
    g.vy = random.uniform(-speed, speed);
    g.spin = random.uniform(-20, 20);
    if (!flat) {
      g.vz = random.uniform(-speed, speed);
      g.spin_x = random.uniform(-20, 20);
    }
    if (shape == ShapeKind::polygon && k % 5 != 0) {
      Outline outline;
      const int corners = 5 + k % 3;
      for (int c = 0; c < corners; ++c) {
        const auto [cosine, sine] = rotation_of(6.283185307179586 * c / corners);
        outline.push_back({1.25 * g.radius * cosine, (k % 4 == 0 ? 0.65 : 1.2) * g.radius * sine});
      }
      g.outline = centred_outline(outline);
      g.angle = random.uniform(0, 6);
    }
    grains.push_back(g);
  }
  return grains;
}

inline std::unique_ptr<Engine> engine_with(const EngineSettings& settings,
                                           const std::vector<NewGrain>& grains) {
  auto engine = make_engine(settings);
  for (const NewGrain& g : grains) engine->add(g);
  return engine;
}

inline Vec3 shift_of(const Cell<3>& cell, const std::array<int, 3>& image) {
  return cell.edges * Vec3(image[0], image[1], image[2]);
}

/// Where a grain would be without having been carried back.
inline Vec3 continuous(const Snapshot& s, const Grain& g) {
  return g.position + shift_of(s.cell, g.image);
}

/// Resultant of the contacts, by grain.
inline std::vector<Vec3> resultants(const Snapshot& s) {
  std::vector<Vec3> sum(s.grains.size(), Vec3::Zero());
  for (const Contact& c : s.contacts) {
    sum[c.i] += c.force;
    if (c.j >= 0) sum[c.j] -= c.force;
  }
  return sum;
}

}  // namespace grainfield::dem::cells
