// Elastic constants in space from changes of stress and strain of whole samples, and which symmetry
// they support: isotropic, transversely isotropic about z, or less (docs/elastic-constants.md).
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "continuum/constants.h"
#include "coupling/elastic_constants/constants.h"

namespace grainfield::coupling {

/// A change of stress (tension positive, Pa) with the strain that made it (extension positive).
struct SpaceIncrement {
  Eigen::Matrix3d stress, strain;
};
using SpaceIncrements = std::vector<SpaceIncrement>;

/// Those of a small displacement gradient: its symmetric part, and the change of stress less what
/// the rotation W does to the stress that was there, W sigma - sigma W (Jaumann).
SpaceIncrement increment_of(const Eigen::Matrix3d& gradient, const Eigen::Matrix3d& before,
                            const Eigen::Matrix3d& after);

/// Constants of one sample, Pa; nan where the strains do not tell them.
struct SpaceModuli {
  double bulk = kNan, shear = kNan;     ///< isotropic
  double young = kNan, poisson = kNan;  ///< isotropic
  /// Transversely isotropic about z: of the plane and along z; nu_vh: strain of the plane over that
  /// along z, when z is loaded.
  double e_h = kNan, e_v = kNan, nu_h = kNan, nu_vh = kNan, g_vh = kNan;
  /// Root of sum |sigma - C eps|^2 over sum |sigma|^2.
  double residual_isotropic = kNan, residual_transverse = kNan;
};

/// Least squares of all increments in the norm of tensors. Without shear along z g_vh is nan.
/// Throws std::invalid_argument when a number is not finite.
SpaceModuli space_moduli(const SpaceIncrements& increments);

/// Whether a smaller symmetry holds beside the next larger one.
struct SymmetryTest {
  double p_samples = kNan;       ///< F test: all equations independent
  double p_realizations = kNan;  ///< Hotelling's test: realizations alone are
  /// p_realizations; p_samples where that is nan.
  double p() const;
};

struct SpaceSymmetry {
  SymmetryTest isotropic;   ///< within transverse isotropy
  SymmetryTest transverse;  ///< within orthotropy along x, y, z; needs all six directions
  /// "isotropic", "transversely isotropic" or "less": the first whose test gives 5 % or more;
  /// "not known" where no test could be made.
  std::string symmetry() const;
};

/// Symmetry of all realizations together. Throws as space_moduli() and bootstrap().
SpaceSymmetry space_symmetry(const std::vector<SpaceIncrements>& realizations,
                             const ElasticOptions& options);

}  // namespace grainfield::coupling
