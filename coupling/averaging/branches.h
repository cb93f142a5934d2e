// The branches along which coarse graining spreads a contact's force.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "coupling/averaging/region.h"
#include "dem/snapshot/images.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// How branches end on walls and fixed grains.
struct BranchEnds {
  bool extend = true;
  double floor = 0;   ///< m
  double beyond = 0;  ///< length of the extension, m
};

/// Calls branch(a, b, force) for every piece from a to b that carries `force` on the grain at its
/// start, and end(point, force) where a branch ends on the apparatus. Between free grains: centroid
/// to centroid (of the image that is touched). Wall or fixed grain: centroid to contact point, and
/// with `extend` on into the wall (for fixed grains along gravity, from above the floor so much
/// farther).
template <class Branch, class End>
void for_each_branch(const dem::Snapshot& snapshot, const BranchEnds& ends, Branch&& branch,
                     End&& end) {
  const dem::Vec3 up = snapshot.dim == 2 ? dem::Vec3(0, 1, 0) : dem::Vec3(0, 0, 1);
  const dem::Vec3 down =
      snapshot.gravity.norm() > 0 ? dem::Vec3(snapshot.gravity.normalized()) : dem::Vec3(-up);
  for (const dem::Contact& contact : snapshot.contacts) {
    const dem::Grain& gi = snapshot.grains[static_cast<std::size_t>(contact.i)];
    const dem::Grain* gj =
        contact.j >= 0 ? &snapshot.grains[static_cast<std::size_t>(contact.j)] : nullptr;
    if (gi.fixed && (!gj || gj->fixed)) continue;
    if (gj && !gi.fixed && !gj->fixed) {
      branch(gi.position, dem::second_place(snapshot, contact), contact.force);
      continue;
    }
    const dem::Vec3 free = gi.fixed ? dem::second_place(snapshot, contact) : dem::Vec3(gi.position);
    const dem::Vec3 force = gi.fixed ? dem::Vec3(-contact.force) : contact.force;
    branch(free, contact.point, force);
    if (!ends.extend) {
      end(contact.point, force);
      continue;
    }
    dem::Vec3 far = contact.point;
    if (gj)
      far += (ends.beyond + std::max(0.0, contact.point.dot(up) - ends.floor)) * down;
    else if (const auto& wall = snapshot.walls[static_cast<std::size_t>(-1 - contact.j)];
             wall.shape == "plane")
      far -= ends.beyond * wall.normal;
    else
      far += ends.beyond * contact.normal;
    branch(contact.point, far, force);
    end(far, force);
  }
}

}  // namespace grainfield::coupling
