// Slip lines of a stress field: where the limit of friction is reached, the two families of lines
// at 45 degrees - phi/2 to the direction of the largest compression.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace grainfield::coupling {

/// Stress (n x 3: xx, yy, xy, tension positive; nan outside) at points (n x 2).
using PlaneStress = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& points)>;

/// Mobilized part of the friction, (s1 - s3) / (-(s1 + s3) sin phi): 1 at the limit without
/// cohesion; of the two principal stresses in the plane; nan where they are nan or pull.
double mobilized_friction(double xx, double yy, double xy, double phi_deg);

struct SlipLines {
  double phi_deg = 28;
  double mobilized = 0.97;  ///< a line ends where less of the friction is mobilized
  double step = 0.01;       ///< along a line, m; midpoint rule
  double apart = 0.08;      ///< lines of one family keep this distance, m
};

/// Each line a n x 2 matrix of points in order, both families, begun at the given seeds in their
/// order where no line of the family is near. The same bits for the same seeds.
std::vector<Eigen::MatrixXd> slip_lines(const PlaneStress& stress, const Eigen::MatrixXd& seeds,
                                        const SlipLines& how);

}  // namespace grainfield::coupling
