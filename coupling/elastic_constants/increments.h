// Changes of stress and strain at the same points in several realizations: what elastic constants
// are fitted to.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/base/field.h"

namespace grainfield::coupling {

/// Columns of the matrices: xx, yy, xy (tensor components, not twice the shear), tension and
/// extension positive. Rows: points. nan: no value there.
struct Increments {
  Eigen::MatrixXd points;                ///< n x 2, m
  std::vector<Eigen::MatrixX3d> stress;  ///< one per realization, N/m
  std::vector<Eigen::MatrixX3d> strain;  ///< one per realization, 1

  int realizations() const { return static_cast<int>(stress.size()); }
  /// Adds a realization: columns sigma_xx, sigma_yy, sigma_xy (and sigma_yx: their mean is taken)
  /// of response(), strain_xx, strain_yy, strain_xy of strain(). Throws std::invalid_argument when
  /// a column is missing or the points differ from each other or from the first realization's.
  void add(const Field& stress_change, const Field& strain_change);
};

/// A place and what each point of the increments counts there.
struct Locality {
  Eigen::Vector2d centre{0, 0};  ///< m
  Eigen::VectorXd weights;       ///< one per point, >= 0
};

/// Weights of the points around `centre`: kernel (lucy, gaussian, heaviside) of width w over its
/// value at distance 0; width 0: 1 for the nearest point, 0 for the others. Throws
/// std::invalid_argument for an unknown kernel or a negative width.
Locality locality(const Eigen::MatrixXd& points, const Eigen::Vector2d& centre,
                  const std::string& kernel, double width);
/// All points count alike.
Locality everywhere(const Eigen::MatrixXd& points);

/// Throws std::invalid_argument unless the matrices fit each other and the weights, there is a
/// realization, and no weight is negative.
void check_increments(const Increments& increments, const Locality& where);

}  // namespace grainfield::coupling
