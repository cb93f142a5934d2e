// Fields of heaps in units that heaps of slightly different height share.
#pragma once
#include <Eigen/Core>

#include "coupling/averaging/ensemble.h"
#include "coupling/base/field.h"

namespace grainfield::coupling {

/// The stresses of a field, in units of `pressure`, and its volume fraction, on scaled points;
/// nx, ny, nz: of a grid, or 0.
Field scaled_field(const Field& field, const Eigen::MatrixXd& points, double pressure, int nx = 0,
                   int ny = 0, int nz = 0);

/// The ensemble of such fields in m and N/m (in space Pa) of the mean heap, with its single values
/// and what `grainfield compare` needs to know of its frame.
Field of_mean_heap(const Ensemble& scaled, double height, double pressure);

}  // namespace grainfield::coupling
