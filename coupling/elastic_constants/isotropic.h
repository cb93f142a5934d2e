// Sums from which K and G follow; they add up over samples and realizations.
#pragma once
#include <Eigen/Core>

#include "coupling/elastic_constants/samples.h"

namespace grainfield::coupling {

/// Normal equations of y = 2 e (k_0 + k_x dx + k_y dy): y and e are the traces (k is K) or the
/// deviators (k is G). Offsets in units of `scale`, so that the equations are well conditioned.
struct StiffnessSums {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double stress = 0;  ///< sum of w y^2

  void add(const StiffnessSums& other) {
    matrix += other.matrix;
    right += other.right;
    stress += other.stress;
  }
  /// k_0 with `degree` 0 or 1; nan when the equations are singular. matrix(0, 0) is 4 sum of w e^2.
  double stiffness(int degree) const;
  /// Share of the stress that the fit explains.
  double share(int degree) const;
};

struct IsotropicSums {
  StiffnessSums trace, deviator;

  void add(const Sample& sample, double scale);
  void add(const IsotropicSums& other) {
    trace.add(other.trace);
    deviator.add(other.deviator);
  }
  bool has_volume_change() const;  ///< of the strain, above rounding
  bool has_shear() const;
  /// K, G, E, nu; nan where undefined.
  Eigen::Vector4d constants(int degree) const;
};

}  // namespace grainfield::coupling
