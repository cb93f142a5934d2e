// How far a snapshot is from equilibrium, from its contacts alone: nothing of the engine or of the
// solver that made it is asked.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dem/snapshot/images.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

struct Imbalance {
  double force = 0;   ///< mean resultant on the free grains / mean contact force
  double moment = 0;  ///< mean |moment| / radius likewise
  double pull = 0;    ///< largest attraction of a contact / mean contact force
  double beyond = 0;  ///< largest tangential force beyond Coulomb's limit / mean contact force
};

inline Imbalance imbalance_of(const Snapshot& s) {
  std::vector<Vec3> force(s.grains.size()), moment(s.grains.size(), Vec3(0, 0, 0));
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    force[k] = s.grains[k].mass * s.gravity;
    if (is_loaded(s, s.grains[k].id)) force[k] += s.applied_force;
  }
  Imbalance out;
  double mean = 0;
  const auto push = [&](std::int64_t k, const Vec3& f, const Vec3& at) {
    force[k] += f;
    moment[k] += (at - s.grains[k].position).cross(f);
  };
  for (const Contact& c : s.contacts) {
    mean += c.force.norm() / static_cast<double>(s.contacts.size());
    push(c.i, c.force, c.point);
    if (c.j >= 0) push(c.j, -c.force, c.point + (s.grains[c.j].position - second_place(s, c)));
    const double repulsion = -c.force.dot(c.normal);
    const double along = (c.force + repulsion * c.normal).norm();
    out.pull = std::max(out.pull, -repulsion);
    out.beyond = std::max(out.beyond, along - c.friction * repulsion);
  }
  double free = 0;
  for (std::size_t k = 0; k < s.grains.size(); ++k) {
    if (s.grains[k].fixed) continue;
    ++free;
    out.force += force[k].norm();
    out.moment += moment[k].norm() / s.grains[k].radius;
  }
  for (double* sum : {&out.force, &out.moment}) *sum /= free * mean;
  for (double* most : {&out.pull, &out.beyond}) *most /= mean;
  return out;
}

/// The contacts as they stand hold every grain, repel and stay within friction.
inline void expect_balanced(const Snapshot& s, double ratio, const std::string& what = "") {
  const Imbalance b = imbalance_of(s);
  EXPECT_LE(b.force, ratio) << what;
  EXPECT_LE(b.moment, ratio) << what;
  EXPECT_LE(b.pull, 0) << what;
  EXPECT_LE(b.beyond, 1e-9) << what;
}

}  // namespace grainfield::dem
