// Sums from which K and G follow; they add up over samples and realizations.
#pragma once
#include <Eigen/Core>

#include "coupling/elastic_constants/samples.h"

namespace grainfield::coupling {

/// Normal equation of y = 2 e k: y and e are the traces (k is K) or the deviators (k is G).
struct StiffnessSums {
  double strain = 0;  ///< 4 sum of w e^2
  double right = 0;   ///< 2 sum of w e y
  double stress = 0;  ///< sum of w y^2

  void add(const StiffnessSums& other) {
    strain += other.strain;
    right += other.right;
    stress += other.stress;
  }
  /// k; nan without strain.
  double stiffness() const;
  /// Share of the stress that the fit explains.
  double share() const;
};

struct IsotropicSums {
  StiffnessSums trace, deviator;

  void add(const Sample& sample);
  void add(const IsotropicSums& other) {
    trace.add(other.trace);
    deviator.add(other.deviator);
  }
  bool has_volume_change() const;  ///< of the strain, above rounding
  bool has_shear() const;
  /// K, G, E, nu; nan where undefined.
  Eigen::Vector4d constants() const;
};

}  // namespace grainfield::coupling
