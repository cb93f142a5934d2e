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

/// For forces of rows of pairs. `rolls`: there is resistance against rolling. `to_list`: they are
/// for the list, not for the sums.
template <class World, class Sum>
SphereRows sphere_rows_of(World& world, std::vector<Sum>& sums, bool rolls, bool to_list) {
  using Body = typename World::Body;
  using Pair = typename World::Pair;
  static_assert(sizeof(Body) == kSphereBody * sizeof(double));
  static_assert(sizeof(Sum) == kSphereSum * sizeof(double) && kAhead >= kPairsAhead);
  static_assert(sizeof(ContactForce<3>) == kSphereForce * sizeof(double));
  static_assert(sizeof(RollingMemory<World::dim>) == 4 * sizeof(double));
  static_assert(sizeof(Pair) == kSpherePair<typename World::Law>);
  return {world.grains.bodies.data()->position.data(),
          reinterpret_cast<unsigned char*>(&world.contacts.pairs[0]), sums.data()->force.data(),
          rolls ? world.rolling.pairs.data()->roll.data() : nullptr,
          to_list ? world.contacts.pair_forces.data()->force.data() : nullptr};
}

/// For forces of rows of pairs of disks.
template <class World, class Sum>
DiskRows disk_rows_of(World& world, std::vector<Sum>& sums, bool to_list) {
  using Pair = typename World::Pair;
  static_assert(sizeof(typename World::Body) == kDiskBody * sizeof(double));
  static_assert(sizeof(Sum) == kDiskSum * sizeof(double) && kAhead >= kPairsAhead);
  static_assert(sizeof(ContactForce<2>) == kDiskForce * sizeof(double));
  static_assert(sizeof(Pair) == kDiskPair);
  return {world.grains.bodies.data()->position.data(),
          reinterpret_cast<unsigned char*>(&world.contacts.pairs[0]), sums.data()->force.data(),
          to_list ? world.contacts.pair_forces.data()->force.data() : nullptr};
}

/// For overlaps of polygons.
template <class World>
CrossingRows crossing_rows_of(World& world) {
  using Pair = typename World::Pair;
  static_assert(sizeof(typename World::Body) == kPlaneBody * sizeof(double));
  static_assert(sizeof(Pair) == kPlanePair);
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
  static_assert(sizeof(Body) == kRoundBody * sizeof(double));
  static_assert(sizeof(typename World::Integrator::Memory) == kRoundMemory * sizeof(double));
  static_assert(sizeof(Sum) == kRoundSum * sizeof(double));
  static_assert(sizeof(Inertia<World::dim>) == kRoundInertia * sizeof(double));
  auto& grains = world.grains;
  RoundRows rows;
  rows.bodies = grains.bodies.data()->position.data();
  rows.memories = grains.memory.data()->rotation.coeffs().data();
  rows.sums = sums.data()->force.data();
  rows.inertias = &grains.inertias.data()->mass;
  rows.margins = world.round_margins.data();
  return rows;
}

}  // namespace grainfield::dem
