// Contacts of a grain with a wall that moves or is no plane: each place where the wall is near is a
// half space to the shape and the law, and keeps the slot that remembers it.
#pragma once
#include <array>

#include "dem/space/lever.h"
#include "dem/walls/walls.h"

namespace grainfield::dem {

// A contact whose direction has turned by less than 60 degrees in a step is the same.
inline constexpr double kSameContact = 0.5;

/// Gives each of `count` patches one of `slots`: the slot whose contact had the most similar
/// normal, else one that remembers something and not where (after a restart: by rank), else a free
/// one. `normals`: of the slots' contacts, 0: not known. `filled(slot)`: it remembers something.
template <int D, class Filled>
std::array<int, kMostPatches> slots_for(const Patch<D>* patches, int count,
                                        const VectorOf<D>* normals, int slots, Filled filled) {
  std::array<int, kMostPatches> out;
  out.fill(-1);
  std::array<bool, kMostPatches> used{};
  const auto take = [&](int rank, int slot) {
    out[rank] = slot;
    used[slot] = true;
  };
  for (int rank = 0; rank < count; ++rank) {
    int best = -1;
    double most = kSameContact;
    for (int slot = 0; slot < slots; ++slot) {
      const double same = normals[slot].dot(patches[rank].plane.normal);
      if (!used[slot] && same > most) {
        best = slot;
        most = same;
      }
    }
    if (best >= 0) take(rank, best);
  }
  for (int rank = 0; rank < count; ++rank) {
    const bool waits = rank < slots && normals[rank].isZero(0) && filled(rank) && !used[rank];
    if (out[rank] < 0 && waits) take(rank, rank);
  }
  for (int rank = 0; rank < count; ++rank) {
    for (int slot = 0; out[rank] < 0 && slot < slots; ++slot) {
      if (!used[slot] && !filled(slot)) take(rank, slot);
    }
    for (int slot = 0; out[rank] < 0 && slot < slots; ++slot) {
      if (!used[slot]) take(rank, slot);
    }
  }
  return out;
}

/// visit(rank, pair, overlap, wall as a body at the contact, normal of the wall) for each contact
/// of body i with the wall whose first slot is pair `first` of the list, the nearest first. `b`:
/// the body's motion as it is to count.
template <class World, class Visit>
void visit_wall(const World& world, int i, const typename World::Body& b, int first, Visit visit) {
  constexpr int dim = World::dim;
  const auto& contacts = world.contacts;
  const int wall = world.walls.wall_of(contacts.walls[first].j);
  const int slots = world.walls.slots_of(wall);
  Patch<dim> patches[kMostPatches];
  const int count = world.walls.touching(wall, b.position, b.radius, patches);
  const auto slot_of = slots_for<dim>(patches, count, &contacts.wall_normals[first], slots,
                                      [&](int slot) { return world.remembers_wall(first + slot); });
  for (int rank = 0; rank < count; ++rank) {
    typename World::Overlap o;
    if (!world.overlap_patch(i, b, patches[rank], o)) continue;
    visit(rank, first + slot_of[rank], o, world.wall_body(wall, b, o), patches[rank].plane.normal);
  }
}

}  // namespace grainfield::dem
