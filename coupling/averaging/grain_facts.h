// What every grain brings to an average: its contacts, virial, fabric and shape.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Facts of one grain; tensors are 3 x 3, with zeros in the third row and column in 2D.
struct GrainFacts {
  const dem::Grain* grain = nullptr;
  int contacts = 0;          ///< with grains and walls
  bool bearing = true;       ///< no rattler
  int bearing_contacts = 0;  ///< force-bearing, with grains that are no rattlers and with walls
  Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();   ///< sum F (outer) x, x from centroid to
                                                      ///< contact (Roul ch. 2.6), N m
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();   ///< sum n (outer) n, n along x (Roul 2.93)
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< see inertia_of
  Eigen::Vector3d load{0, 0, 0};                      ///< applied force, N
};

/// In the order of snapshot.grains. Pointers into the snapshot: keep it alive.
std::vector<GrainFacts> grain_facts(const dem::Snapshot& snapshot);

/// Rattlers: free grains with fewer than two force-bearing contacts (force not exactly 0; walls,
/// fixed grains and an applied force support), removed one after the other until none is left: a
/// grain that only leans on rattlers is one. True per grain, in the snapshot's order.
std::vector<bool> rattlers(const dem::Snapshot& snapshot);

/// Inertia tensor of the grain's area (volume) about its centroid, at density 1: theta_xx =
/// integral of y y, theta_yy = of x x, theta_xy = - of x y (Roul 2.82, 2.87, 2.91), m4 in 2D. In 3D
/// integral of (r r 1 - x (outer) x) of the sphere of its volume, m5. Polygons from their corners
/// (turned by the grain's angle), grains without outline as disks.
Eigen::Matrix3d inertia_of(const dem::Grain& grain, int dim);

}  // namespace grainfield::coupling
