// What the layer's base feels: the force of the grains on a flat floor or on fixed grains, smeared
// along x with the averaging kernel.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/averaging/average.h"
#include "coupling/averaging/kernel.h"
#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// The packing stands on something that can be told from side walls: a wall named "floor", or fixed
/// grains.
bool has_base(const dem::Snapshot& snapshot);

/// Stress on the base at abscissas x (packing's axes, m). Columns sigma_yy and sigma_xy (N/m,
/// tension positive: a pressing layer gives sigma_yy < 0), `contacts` (1: within the kernel's
/// range). The points are (x, frame floor). Contacts with a wall named "floor" or with a fixed
/// grain count. The integral of -sigma_yy over all x is the total vertical floor force. Throws
/// std::invalid_argument without a base (has_base) and for a snapshot in space (base_stress).
Field base_profile(const dem::Snapshot& snapshot, const Eigen::VectorXd& x, const Kernel& kernel);

/// base_profile(loaded) - base_profile(unloaded). Throws as base_profile and require_same_grains.
Field base_response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
                    const Eigen::VectorXd& x, const Kernel& kernel);

/// A contact of a layer with its base, in the plane and in space.
struct BaseSupport {
  Eigen::Vector3d point;  ///< m, packing's axes
  Eigen::Vector3d force;  ///< of the base on the grain, N
};
/// Every contact of a free grain with a wall named "floor" or with a fixed grain, without images.
/// The sum of their forces is dem::base_force().
std::vector<BaseSupport> base_supports(const dem::Snapshot& snapshot);

/// (vertical base force loaded - unloaded) / applied vertical force, along y in the plane and z in
/// space: `response.total_over_load`. nan without an applied force. Throws as require_same_grains.
double total_over_load(const dem::Snapshot& unloaded, const dem::Snapshot& loaded);

}  // namespace grainfield::coupling
