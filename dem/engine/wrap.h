// Grains back into the cell, between steps.
#pragma once
#include "dem/engine/world.h"

namespace grainfield::dem {

/// A body outside the cell goes on at its image inside. Whatever is kept of its place goes with it.
template <class World>
void carry_home(World& world, int i) {
  auto& grains = world.grains;
  auto& b = grains.bodies[i];
  const auto home = world.cell.home(b.position);
  if (home == decltype(home){}) return;
  const typename World::Vector way = world.cell.shift(home);
  b.position -= way;
  b.velocity -= world.cell.drift(home);
  for (int a = 0; a < World::dim; ++a) grains.images[i][a] += home[a];
  world.sleepers.shift(i, -way);
  grains.shapes.place(i, b, world.rotation(i));
}

/// Chooses the cell's edges anew and carries all bodies into it, sleepers only where they have
/// changed. Contacts keep what they remember: they know the grains, not the images.
template <class World>
void settle_cell(World& world) {
  if (!world.cell.is_periodic()) return;
  auto& images = world.grains.images;
  for (const auto& exchange : world.cell.reduce()) {
    for (auto& n : images) n[exchange.from] += exchange.times * n[exchange.to];
  }
  world.cell.set_listed();
  const int last = world.sleepers.have_changed() ? world.grains.size() : world.awake;
  for (int i = 0; i < last; ++i) carry_home(world, i);
}

}  // namespace grainfield::dem
