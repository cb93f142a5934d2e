#include "dem/snapshot/contact_changes.h"

#include <algorithm>
#include <stdexcept>

#include "dem/snapshot/displacements.h"
#include "dem/snapshot/same_grain.h"

namespace grainfield::dem {

ContactChanges compare_contacts(const Snapshot& before, const Snapshot& after) {
  if (before.grains.size() != after.grains.size()) {
    throw std::invalid_argument("snapshots do not belong together: different numbers of grains");
  }
  ContactChanges c;
  const Displacements displacements(before, after);
  for (std::size_t k = 0; k < before.grains.size(); ++k) {
    const Grain& a = before.grains[k];
    const Grain& b = after.grains[k];
    if (a.id != b.id || !same_radius(a, b)) {
      throw std::invalid_argument("snapshots do not belong together: different grains");
    }
    c.max_displacement_over_radius =
        std::max(c.max_displacement_over_radius, displacements.of(k).norm() / a.radius);
  }
  // Both lists are sorted by (i, j).
  auto a = before.contacts.begin();
  auto b = after.contacts.begin();
  const auto less = [](const Contact& p, const Contact& q) {
    return p.i != q.i ? p.i < q.i : p.j < q.j;
  };
  while (a != before.contacts.end() || b != after.contacts.end()) {
    if (b == after.contacts.end() || (a != before.contacts.end() && less(*a, *b))) {
      ++c.lost;
      ++a;
    } else if (a == before.contacts.end() || less(*b, *a)) {
      ++c.gained;
      ++b;
    } else {
      if (b->sliding && !a->sliding) ++c.newly_sliding;
      ++a;
      ++b;
    }
  }
  return c;
}

Vec3 base_force(const Snapshot& s) {
  Vec3 sum(0, 0, 0);
  for (const Contact& c : s.contacts) {
    if (c.j < 0) {
      if (!s.grains[c.i].fixed && s.walls[-1 - c.j].name == "floor") sum += c.force;
    } else if (s.grains[c.i].fixed != s.grains[c.j].fixed) {
      sum += s.grains[c.i].fixed ? Vec3(-c.force) : c.force;
    }
  }
  return sum;
}

}  // namespace grainfield::dem
