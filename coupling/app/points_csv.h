// Points and stresses as CSV.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::coupling {

/// The columns x,y (dim 2) or x,y,z (dim 3) of a CSV file with a header, in any order, other
/// columns ignored; n x dim. Lines starting with '#' are comments. Throws std::invalid_argument
/// "FILE[:LINE]: what" for a missing or empty file, a missing column, a line that is too short or
/// too long, a value that is no finite number, or no points at all.
Eigen::MatrixXd read_points_csv(const std::string& file, int dim);

/// The same of rings: columns r,z, radius and height; n x 2. Throws likewise.
Eigen::MatrixXd read_rings_csv(const std::string& file);

/// "x,y,sigma_xx,sigma_yy,sigma_xy" (3D: six components, `cylindrical`: as
/// continuum/cylindrical.h has them), then the names of the quantities that are not among them,
/// with all digits; nan outside the model.
std::string stresses_csv(const Eigen::MatrixXd& points, const Eigen::MatrixXd& stresses,
                         const std::vector<continuum::Quantity>& quantities = {},
                         bool cylindrical = false);

}  // namespace grainfield::coupling
