// What hard disks and spheres move in, whatever moves them.
#pragma once
#include <vector>

#include "dem/collisions/cells.h"
#include "dem/collisions/impulse.h"

namespace grainfield::dem {

/// A plane of infinite mass; grains are on the side its normal points to.
template <int D>
struct HardWall {
  VectorOf<D> point = zero<VectorOf<D>>();     ///< on it at time 0, m
  VectorOf<D> normal = zero<VectorOf<D>>();    ///< unit, into the grains
  VectorOf<D> velocity = zero<VectorOf<D>>();  ///< constant, m/s
  ImpactLaw law;

  VectorOf<D> place(double time) const { return point + time * velocity; }
  /// As a body where a grain touches it.
  Body<D> body() const {
    Body<D> out;
    out.velocity = velocity;
    return out;
  }
};

template <int D>
struct HardScene {
  HardBox<D> box;
  VectorOf<D> gravity = zero<VectorOf<D>>();  ///< m/s2
  ImpactLaw grains;                           ///< of a pair of them
  std::vector<HardWall<D>> walls;
  /// Inelastic collapse, s (0: nothing is done about it; hard_engine.h).
  double contact_time = 0;
};

/// Walls along the sides of the box whose axes do not repeat, all of that law.
template <int D>
std::vector<HardWall<D>> walls_of(const HardBox<D>& box, const ImpactLaw& law) {
  std::vector<HardWall<D>> out;
  for (int a = 0; a < D; ++a) {
    if (box.periodic[a]) continue;
    for (const double way : {1.0, -1.0}) {
      HardWall<D> wall;
      wall.point = box.low;
      if (way < 0) wall.point[a] += box.size[a];
      wall.normal[a] = way;
      wall.law = law;
      out.push_back(wall);
    }
  }
  return out;
}

/// Throws std::invalid_argument: a restitution outside of [0, 1], friction below 0, a box without
/// size or, along axes that repeat, narrower than three times the largest grain, grains without
/// radius, grains that overlap at the start or lie behind a wall by more than round-off.
template <int D>
void check_scene(const HardScene<D>& scene, const std::vector<Body<D>>& grains);

/// The way from a place to the nearest image of another, m.
template <int D>
VectorOf<D> nearest_way(const HardBox<D>& box, const VectorOf<D>& from, const VectorOf<D>& to) {
  VectorOf<D> r = to - from;
  for (int a = 0; a < D; ++a) {
    if (box.periodic[a]) r[a] -= box.size[a] * std::round(r[a] / box.size[a]);
  }
  return r;
}

/// The place inside of the box along the axes that repeat.
template <int D>
VectorOf<D> inside(const HardBox<D>& box, VectorOf<D> place) {
  for (int a = 0; a < D; ++a) {
    if (box.periodic[a])
      place[a] -= box.size[a] * std::floor((place[a] - box.low[a]) / box.size[a]);
  }
  return place;
}

/// Largest diameter, m.
template <int D>
double widest(const std::vector<Body<D>>& grains) {
  double out = 0;
  for (const Body<D>& g : grains) out = std::max(out, 2 * g.radius);
  return out;
}

extern template void check_scene(const HardScene<2>&, const std::vector<Body<2>>&);
extern template void check_scene(const HardScene<3>&, const std::vector<Body<3>>&);

}  // namespace grainfield::dem
