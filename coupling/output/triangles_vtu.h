// A model's mesh and lines in the plane as VTK unstructured grids (ASCII .vtu), as text.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::coupling {

/// Triangles with point data and cell data; z = 0. Throws std::invalid_argument for data of another
/// size.
std::string triangles_vtu(const continuum::MeshField& mesh);
/// Triangles between points in space (n x 3) with data of the points. Throws likewise.
std::string surface_vtu(const Eigen::MatrixXd& points,
                        const std::vector<std::array<int, 3>>& triangles,
                        const std::vector<continuum::Quantity>& at_points);
/// One polyline per n x 2 matrix; points that are nan are left out. Cell data: line, its number.
std::string lines_vtu(const std::vector<Eigen::MatrixXd>& lines);

}  // namespace grainfield::coupling
