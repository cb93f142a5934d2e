// The same as base.h in space: the force of the grains on a flat floor or on fixed grains, smeared
// over the plane with the averaging kernel seen from above.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Weight of a kernel of space seen from above, its integral over the height at the horizontal
/// distance d: 1/m2; 0 from its range on.
double seen_from_above(const Kernel& kernel, double d);

/// Stress on the base at places (n x 2, packing's axes, m). Columns sigma_zz, sigma_xz and sigma_yz
/// (Pa, tension positive: a pressing layer gives sigma_zz < 0), `contacts` (1: within the kernel's
/// range). The points are (x, y, frame floor). Contacts with a wall named "floor" or with a fixed
/// grain count, of a periodic packing their images too. The integral of -sigma_zz over the plane is
/// the total vertical floor force. Throws std::invalid_argument without a base (has_base), for a
/// kernel of the plane, or a snapshot of the plane.
Field base_stress(const dem::Snapshot& snapshot, const Eigen::MatrixXd& places,
                  const Kernel& kernel);

/// base_stress(loaded) - base_stress(unloaded). Throws as base_stress and require_same_grains.
Field base_stress_response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                           const Eigen::MatrixXd& places, const Kernel& kernel);

/// Places on rings about a vertical axis at (x, y), one ring after the other, `spacing` apart and
/// eight at least, and the number of each.
struct RingPlaces {
  Eigen::MatrixXd places;  ///< n x 2
  std::vector<Eigen::Index> count;
};
RingPlaces ring_places(const Eigen::Vector2d& axis, const Eigen::VectorXd& radii, double spacing);
/// Means over the rings of values at these places.
Eigen::VectorXd ring_means(const RingPlaces& rings, const Eigen::VectorXd& values);

}  // namespace grainfield::coupling
