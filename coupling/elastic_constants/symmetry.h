// Does isotropy hold, and by how much not: isotropic against orthotropic elasticity of the plane.
#pragma once
#include "coupling/elastic_constants/constants.h"

namespace grainfield::coupling {

/// Fits of sigma = C eps. Orthotropic with axes x and y (four constants in plane strain):
///   sigma_xx = C11 eps_xx + C12 eps_yy, sigma_yy = C12 eps_xx + C22 eps_yy, sigma_xy = 2 C66
///   eps_xy.
/// Isotropic (two constants): C11 = C22 = K + G, C12 = K - G, C66 = G.
struct SymmetryFit {
  Constant bulk, shear;         ///< isotropic, N/m
  Constant c11, c22, c12, c66;  ///< orthotropic, N/m
  Constant normal_ratio;        ///< C11/C22; 1 if isotropic
  Constant shear_ratio;         ///< 4 C66/(C11 + C22 - 2 C12); 1 if isotropic
  double residual_isotropic =
      std::numeric_limits<double>::quiet_NaN();  ///< root of sum w |sigma - C eps|^2
                                                 ///< over sum w |sigma|^2
  double residual_orthotropic = std::numeric_limits<double>::quiet_NaN();  ///< the same
  int samples = 0;  ///< pairs of stress and strain; three equations each
  double condition = std::numeric_limits<double>::quiet_NaN();  ///< of the orthotropic equations
  /// F = ((R_iso - R_ortho)/2)/(R_ortho/(N - 4)) of the sums of squares R of N equations, and the
  /// chance of a larger one if isotropy holds and all samples are independent.
  double f = std::numeric_limits<double>::quiet_NaN();
  double p_samples = std::numeric_limits<double>::quiet_NaN();
  /// The same chance when only realizations are independent: Hotelling's T squared of the two
  /// constraints with their covariance from the bootstrap. nan below 4 realizations.
  double p_realizations = std::numeric_limits<double>::quiet_NaN();
  /// Corrected information criterion of both (Hurvich and Tsai 1989), smaller is better; counts
  /// samples as independent.
  double aicc_isotropic = std::numeric_limits<double>::quiet_NaN();
  double aicc_orthotropic = std::numeric_limits<double>::quiet_NaN();
  std::string note;  ///< why something is nan; "" if nothing is

  /// True unless isotropy is rejected at 5 %: by p_realizations, or by p_samples where that is
  /// nan; false also where neither is known (see note).
  bool isotropy_holds() const;
};

/// Weighted least squares in the norm of tensors (the shear counts twice). Strains that do not vary
/// enough to tell the constants apart (no shear; only one normal component): orthotropic constants
/// and tests are nan, with a note. Throws as isotropic_constants().
SymmetryFit fit_symmetry(const Increments& increments, const Locality& where,
                         const ElasticOptions& options);

}  // namespace grainfield::coupling
