// Where kernels of numbers side by side (space/lane_width.h) find what the engine keeps.
#pragma once
#include <cstddef>
#include <vector>

#include "dem/contacts/margins.h"
#include "dem/engine/rolling_contacts.h"
#include "dem/laws/disk_lanes.h"
#include "dem/laws/sphere_lanes.h"
#include "dem/motion/round_lanes.h"
#include "dem/shapes/crossing_lanes.h"

namespace grainfield::dem {

/// For forces of rows of pairs. `rolls`: there is resistance against rolling.
template <class World, class Sum>
SphereRows sphere_rows_of(World& world, std::vector<Sum>& sums, bool rolls) {
  using Body = typename World::Body;
  using Pair = typename World::Pair;
  constexpr SphereLawKind kind = World::Law::sphere_kind;
  static_assert(sizeof(Body) == kSphereBody * sizeof(double));
  static_assert(sizeof(Sum) == kSphereSum * sizeof(double) && kAhead >= kPairsAhead);
  static_assert(sizeof(RollingMemory<World::dim>) == 4 * sizeof(double));
  static_assert(sizeof(Pair) == pair_size(kind) && offsetof(Pair, j) == second_in_pair(kind));
  return {world.grains.bodies.data()->position.data(),
          reinterpret_cast<unsigned char*>(&world.contacts.pairs[0]), sums.data()->force.data(),
          rolls ? world.rolling.pairs.data()->roll.data() : nullptr};
}

/// For forces of rows of pairs of disks.
template <class World, class Sum>
DiskRows disk_rows_of(World& world, std::vector<Sum>& sums) {
  using Pair = typename World::Pair;
  static_assert(sizeof(typename World::Body) == kDiskBody * sizeof(double));
  static_assert(sizeof(Sum) == kDiskSum * sizeof(double) && kAhead >= kPairsAhead);
  static_assert(sizeof(Pair) == kDiskPair && offsetof(Pair, j) == kSecondDisk);
  return {world.grains.bodies.data()->position.data(),
          reinterpret_cast<unsigned char*>(&world.contacts.pairs[0]), sums.data()->force.data()};
}

/// For overlaps of polygons.
template <class World>
CrossingRows crossing_rows_of(World& world) {
  using Pair = typename World::Pair;
  static_assert(sizeof(typename World::Body) == kPlaneBody * sizeof(double));
  static_assert(sizeof(Pair) == kPlanePair && offsetof(Pair, j) == kSecondInPair);
  static_assert(offsetof(Pair, feature) == kFeatureInPair);
  CrossingRows rows = world.grains.shapes.crossing_rows();
  rows.bodies = world.grains.bodies.data()->position.data();
  rows.pairs = reinterpret_cast<const unsigned char*>(&world.contacts.pairs[0]);
  return rows;
}

/// For the motion of spheres.
template <class World, class Sum>
RoundRows round_rows_of(World& world, std::vector<Sum>& sums) {
  using Body = typename World::Body;
  using Grip = typename World::Integrator::Memory;
  constexpr int dim = World::dim;
  auto& grains = world.grains;
  RoundRows rows;
  rows.bodies = grains.bodies.data()->position.data();
  rows.memories = grains.memory.data()->rotation.coeffs().data();
  rows.sums = sums.data()->force.data();
  rows.inertias = &grains.inertias.data()->mass;
  rows.margins = world.margins.data()->position.data();
  rows.body_size = sizeof(Body) / sizeof(double);
  rows.memory_size = sizeof(Grip) / sizeof(double);
  rows.sum_size = sizeof(Sum) / sizeof(double);
  rows.inertia_size = sizeof(Inertia<dim>) / sizeof(double);
  rows.margin_size = sizeof(Margin<dim>) / sizeof(double);
  rows.way = offsetof(Margin<dim>, way) / sizeof(double);
  return rows;
}

}  // namespace grainfield::dem
