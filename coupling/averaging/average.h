// Grains and contacts to fields on points, by interchangeable weights (docs/averaging.md).
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/averaging/balance.h"
#include "coupling/averaging/gaps.h"
#include "coupling/averaging/layer.h"
#include "coupling/averaging/options.h"
#include "coupling/averaging/points.h"
#include "coupling/base/field.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {

/// Fields of one snapshot at `points` (n x 2 or n x 3, packing's axes, m). Columns, tension
/// positive, in the order of quantities.h; in 2D:
///   sigma_xx sigma_yy sigma_xy sigma_yx (N/m; sigma_ab: force a, branch b; contact part),
///   sigma_antisymmetric, kinetic_xx kinetic_yy kinetic_xy (N/m), density (kg/m2),
///   volume_fraction (1), traction_x traction_y, load_x load_y (N/m2: force densities of walls and
///   of the applied force), momentum_x momentum_y, coordination, coordination_bearing, rattlers,
///   fabric_xx .., inertia_xx .. (m4), grains (1: centres in the support).
/// Fixed grains belong to the apparatus: they are not counted.
/// coarse_graining obeys div sigma + density g + traction + load = 0 up to the grains' unbalanced
/// forces. Points with fewer than least_grains grains, or with less than a tenth of an RVE inside
/// the packing, are nan; `gaps` (may be null) is told which. Throws std::invalid_argument for bad
/// options or points of another dimension than the snapshot's.
Field average(const dem::Snapshot& snapshot, const Eigen::MatrixXd& points,
              const AverageOptions& options, Gaps* gaps = nullptr);

/// How it was averaged, as attributes: method, kernel and width, m.
void say_averaging(const AverageOptions& options, Field& field);

/// after - before, column by column, at the places before; of the column `counted`, numbers of
/// grains or contacts, the smaller one.
Field change_between(const Field& before, Field after, const std::string& counted);

/// average(loaded) - average(unloaded), column by column; `grains` is the smaller count. Throws
/// std::invalid_argument "snapshots do not belong together: ..." unless both hold the same grains.
Field response(const dem::Snapshot& unloaded, const dem::Snapshot& loaded,
               const Eigen::MatrixXd& points, const AverageOptions& options, Gaps* gaps = nullptr);

/// Throws std::invalid_argument "snapshots do not belong together: ..." unless both hold the same
/// grains by id, radius, outline and fixedness, and the same walls.
void require_same_grains(const dem::Snapshot& unloaded, const dem::Snapshot& loaded);

}  // namespace grainfield::coupling
