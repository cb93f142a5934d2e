// The bits of a world, and back.
#pragma once
#include <string>
#include <vector>

#include "dem/checkpoint/checkpoint.h"
#include "dem/engine/search.h"
#include "dem/engine/world.h"

namespace grainfield::dem {

/// each(value) for all that a checkpoint holds but the frozen contacts and the shapes, in its
/// order.
template <class World, class Search, class Each>
void visit_world(World& world, Search& search, Each each) {
  each(world.around);
  each(world.beside);
  std::remove_const_t<decltype(world.walls)>::visit(world.walls, each);
  std::remove_const_t<decltype(world.balance)>::visit(world.balance, each);
  std::remove_const_t<decltype(world.rolling)>::visit(world.rolling, each);
  each(world.steps);
  each(world.sleep.on);
  each(world.search_needed);
  each(world.awake);
  std::remove_const_t<decltype(world.grains)>::visit(world.grains, each);
  std::remove_const_t<decltype(world.sleepers)>::visit(world.sleepers, each);
  std::remove_const_t<decltype(world.contacts)>::visit(world.contacts, each);
  each(world.margins);
  MovingCell<World::dim>::visit(world.cell, each);
  std::remove_const_t<Search>::visit(search, each);
}

template <class World>
void write_world(const World& world, const Search<World>& search, CheckpointWriter& w) {
  visit_world(world, search, [&w](const auto& value) { w.put(value); });
  w.put(world.sleepers.frozen.sorted());
  world.grains.shapes.write(w);
}

/// Throws std::invalid_argument when the checkpoint does not fit.
template <class World>
void read_world(World& world, Search<World>& search, CheckpointReader& r) {
  visit_world(world, search, [&r](auto& value) { r.get(value); });
  std::vector<typename World::Frozen> frozen;
  r.get(frozen);
  world.sleepers.frozen.assign(frozen);
  world.grains.shapes.read(r, world.grains.bodies.size());
  const bool periodic = world.cell.is_periodic();
  r.require(world.cell.settle() &&
            world.grains.images.size() == (periodic ? world.grains.bodies.size() : 0) &&
            (periodic || world.contacts.images.empty()) &&
            (!periodic || world.search_needed ||
             world.contacts.images.size() == world.contacts.pairs.with_idle()));
  const int n = world.grains.size();
  const bool searched = !world.search_needed;
  r.require(
      world.awake >= 0 && world.awake <= n && world.grains.fits() &&
      world.sleepers.fits(world.grains.bodies.size()) &&
      world.contacts.fits(searched, world.awake, n, world.walls.slots()) && world.walls.fits() &&
      world.balance.fits(world.contacts.pairs.with_idle(), world.contacts.walls.with_idle(),
                         world.grains.bodies.size(), searched) &&
      world.rolling.fits(world.contacts.pairs.with_idle(), world.contacts.walls.with_idle()) &&
      (!searched || world.margins.size() == static_cast<std::size_t>(world.awake)));
  for (const std::int64_t id : world.grains.ids) r.require(id >= 0 && id < n);
  for (const int kind : world.grains.kinds) r.require(kind < world.acting.kinds());
  if (searched) {
    search.prepare();
    search.bin_sleepers();  // a review may ask it before the next search
  } else {
    world.sleepers.set_changed();
  }
  world.walls.restored();
  world.locate_applied();
}

}  // namespace grainfield::dem
