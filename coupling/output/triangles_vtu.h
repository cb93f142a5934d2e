// A model's mesh and lines in the plane as VTK unstructured grids (ASCII .vtu), as text.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::coupling {

/// Triangles with point data and cell data; z = 0. Throws std::invalid_argument for data of another
/// size.
std::string triangles_vtu(const continuum::MeshField& mesh);
/// One polyline per n x 2 matrix; points that are nan are left out. Cell data: line, its number.
std::string lines_vtu(const std::vector<Eigen::MatrixXd>& lines);

}  // namespace grainfield::coupling
