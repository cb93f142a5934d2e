// Fields of heaps in units that heaps of slightly different height share.
#pragma once
#include <Eigen/Core>

#include "coupling/field.h"

namespace grainfield::coupling {

/// The stresses of a field, in units of `pressure`, and its volume fraction, on scaled points;
/// nx, ny, nz: of a grid, or 0.
Field scaled_field(const Field& field, const Eigen::MatrixXd& points, double pressure, int nx = 0,
                   int ny = 0, int nz = 0);

}  // namespace grainfield::coupling
