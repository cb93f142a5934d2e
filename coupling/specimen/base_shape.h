// The pressure on the base of a heap in words and figures: dip, plateau or peak.
#pragma once
#include <Eigen/Core>
#include <string>

namespace grainfield::coupling {

/// The pressure on the base in words and figures.
struct BaseShape {
  double axis = 0;        ///< mean pressure within 5 % of the half width about x = 0, N/m
  double largest = 0;     ///< N/m
  double largest_at = 0;  ///< |x| of it, m
  double quarter = 0;     ///< at 1/4 of the half width, the lower side, N/m
  double dip_ratio = 0;   ///< axis over largest
  std::string word;  ///< dip: on either side there is more than axis/0.98, not at the axis; else
                     ///< plateau: quarter >= 0.98 axis; else peak
};
/// Shape of pressures at ascending x, some on either side of 0; nan points are left out.
/// `half_width`: of the base. Throws std::invalid_argument where no value lies near the axis.
BaseShape base_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& pressure, double half_width);

}  // namespace grainfield::coupling
