// Forces of rows of pairs evaluated several side by side and added to the sums in the order of the
// pairs: what a sweep does with them kBatch at a time. Bit by bit as pair by pair.
#pragma once
#include <cstddef>
#include <vector>

#include "dem/engine/contact_forces.h"
#include "dem/engine/flatten.h"
#include "dem/engine/rows_of.h"
#include "dem/laws/area_lanes.h"
#include "dem/laws/sphere_lanes.h"
#include "dem/shapes/crossing_lanes.h"

namespace grainfield::dem {

/// Spheres, and a law that the kernel has (laws/sphere_lanes.cc).
template <class Shape, class Law>
concept SphereRowsInLanes = Shape::dim == 3 && Shape::rows_in_lanes&& Law::in_lanes;
/// Disks likewise (laws/disk_lanes.cc).
template <class Shape, class Law>
concept DiskRowsInLanes = Shape::dim == 2 && Shape::rows_in_lanes&& Law::in_lanes;
/// Polygons likewise (shapes/crossing_lanes.h, laws/area_lanes.h).
template <class Shape, class Law>
concept OutlineRowsInLanes = Law::measures ==
                             Measures::area&& requires(const Shape& shapes, const Law& law,
                                                       const typename Shape::Feature& feature) {
  shapes.crossing_rows();
  law.area_numbers(0.0, 0.0);
};

/// Pairs [from, to) of an order.
inline RowBatch batch_of(const PairsInOrder& order, int from, int to) {
  return {order.first.data() + from, order.second.data() + from, order.pair.data() + from,
          to - from};
}

/// Where the forces of rows go: to the sums of both grains, or to the list, where the threads that
/// sweep those grains find them.
enum class RowForcesGo { to_sums, to_list };

/// For a sweep in a step of dt, s, of the pairs that are for lanes.
template <class World>
class RowForces;

template <class World>
requires SphereRowsInLanes<typename World::Shape, typename World::Law>
class RowForces<World> {
 public:
  using Sum = ForceSum<World::dim>;

  RowForces(World& world, ContactForces<World>&, std::vector<Sum>& sums, double dt, RowForcesGo go)
      : rule_(world.acting.rule(0, 0)),
        dt_(dt),
        rows_(sphere_rows_of(world, sums, world.rolling.on, go == RowForcesGo::to_list)) {}

  void evaluate(const PairsInOrder& order, int from, int to) {
    if (from == to) return;
    const RowBatch batch = batch_of(order, from, to);
    sphere_forces(rule_.law, rule_.friction, dt_, rule_.rolling, rows_, batch);
  }

 private:
  const typename World::Acting::Rule& rule_;
  const double dt_;
  const SphereRows rows_;
};

template <class World>
requires DiskRowsInLanes<typename World::Shape, typename World::Law>
class RowForces<World> {
 public:
  using Sum = ForceSum<World::dim>;

  RowForces(World& world, ContactForces<World>&, std::vector<Sum>& sums, double dt, RowForcesGo go)
      : rule_(world.acting.rule(0, 0)),
        dt_(dt),
        rows_(disk_rows_of(world, sums, go == RowForcesGo::to_list)) {}

  void evaluate(const PairsInOrder& order, int from, int to) {
    if (from == to) return;
    disk_forces(rule_.law, rule_.friction, dt_, rows_, batch_of(order, from, to));
  }

 private:
  const typename World::Acting::Rule& rule_;
  const double dt_;
  const DiskRows rows_;
};

template <class World>
requires OutlineRowsInLanes<typename World::Shape, typename World::Law>
class RowForces<World> {
 public:
  using Sum = ForceSum<World::dim>;
  using Force = ContactForce<World::dim>;

  RowForces(World& world, ContactForces<World>& alone, std::vector<Sum>& sums, double dt,
            RowForcesGo go)
      : world_(world),
        alone_(alone),
        sums_(sums),
        dt_(dt),
        to_list_(go == RowForcesGo::to_list),
        numbers_(world.acting.rule(0, 0).law.area_numbers(world.acting.rule(0, 0).friction, dt)),
        rows_(crossing_rows_of(world)) {}

  void evaluate(const PairsInOrder& order, int from, int to) {
    if (from == to) return;
    const RowBatch batch = batch_of(order, from, to);
    for (int n = 0; n < batch.count; ++n) ask_for(batch.second[n + kPairsAhead]);
    crossing_overlaps(rows_, batch, overlaps_);
    auto& pairs = world_.contacts.pairs;
    for (int n = 0; n < overlaps_.count; ++n) {
      const int slot = overlaps_.slot[n];
      const auto& pair = pairs[batch.pair[slot]];
      forces_.body_i[n] = rows_.bodies + std::ptrdiff_t{batch.first[slot]} * kPlaneBody;
      forces_.body_j[n] = rows_.bodies + std::ptrdiff_t{pair.j} * kPlaneBody;
      forces_.spring[n] = pair.memory.spring;
    }
    area_forces(numbers_, overlaps_, forces_);
    int count = 0, felt[kBatch];
    for (int slot = 0; slot < batch.count; ++slot) {
      const bool apart = overlaps_.state[slot] == PairFate::apart;
      auto& spring = pairs[batch.pair[slot]].memory.spring;
      spring = apart ? 0 : spring;
      felt[count] = slot;
      count += apart ? 0 : 1;
    }
    for (int n = 0; n < count; ++n) add_up(batch, felt[n]);
  }

 private:
  /// What a later pair needs of its second grain: a third for packings beyond the second-level
  /// cache. In line: a call that does nothing else has no effect to the compiler, which drops it.
  [[gnu::always_inline]] void ask_for(int later) const {
    const double* corners =
        rows_.blocks + static_cast<std::size_t>(later) * rows_.block_size + 2 * rows_.stride;
    __builtin_prefetch(&world_.grains.bodies[later], 1);
    __builtin_prefetch(&sums_[later], 1);
    __builtin_prefetch(corners);
    __builtin_prefetch(corners + rows_.stride);
  }
  void add_up(const RowBatch& batch, int slot) {
    const int i = batch.first[slot], k = batch.pair[slot];
    auto& pair = world_.contacts.pairs[k];
    Force f;
    if (overlaps_.state[slot] == PairFate::touches) {
      const int place = overlaps_.place[slot];
      const double* row = forces_.force[place];
      f.force = {row[0], row[1]};
      f.torque_i = row[2];
      f.torque_j = row[3];
      pair.memory.spring = forces_.spring[place];
    } else if (!by_itself(i, k, f)) {
      return;
    }
    if (to_list_) {
      world_.contacts.pair_forces[k] = f;
      return;
    }
    if (pair.j < world_.awake) [[likely]] {
      Sum& b = sums_[pair.j];
      b.force -= f.force;
      b.torque += f.torque_j;
    } else {
      world_.contacts.felt[k].add_second(f);
    }
    Sum& a = sums_[i];
    a.force += f.force;
    a.torque += f.torque_i;
  }
  [[gnu::noinline]] GRAINFIELD_FLATTEN bool by_itself(int i, int k, Force& f) {
    return alone_.pair(i, k, dt_, f);
  }

  World& world_;
  ContactForces<World>& alone_;
  std::vector<Sum>& sums_;
  const double dt_;
  const bool to_list_;
  AreaNumbers numbers_;
  CrossingRows rows_;
  PlaneOverlapBatch overlaps_;
  PlaneForceBatch forces_;
};

}  // namespace grainfield::dem
