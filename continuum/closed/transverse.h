// Point load on a half space whose elastic axis is the vertical, the same in every horizontal
// direction (Michell 1900; Elliott 1948). With z down, g_i^2 = 1/n_i and n_i the roots of
//   c11 c44 n^2 + (c13 (c13 + 2 c44) - c11 c33) n + c33 c44 = 0,
// displacement and stress follow from the potentials A_i ln(R_i + z_i), z_i = g_i z,
// R_i^2 = r^2 + z_i^2: with k_i = (c11 n_i - c44)/(c13 + c44), a_i = c44 (1 + k_i) A_i and
// a_1 + a_2 = F/(2 pi), a_1 g_1 + a_2 g_2 = 0 (no shear on the surface),
//   s_zz = -sum a_i z_i/R_i^3,  s_rz = -sum a_i g_i r/R_i^3,
//   s_rr = sum a_i g_i^2 z_i/R_i^3 - (c11 - c12) sum A_i/(R_i (R_i + z_i)),
//   s_tt = sum (a_i g_i^2 - (c11 - c12) A_i) z_i/R_i^3 + (c11 - c12) sum A_i/(R_i (R_i + z_i)),
//   u_r = sum A_i r/(R_i (R_i + z_i)),  u_z = sum k_i A_i g_i/R_i.
// The roots are real or conjugate; where they nearly agree (isotropy) they are held apart.
#pragma once
#include <Eigen/Core>
#include <array>
#include <complex>
#include <string>

#include "continuum/closed/orthotropic.h"

namespace grainfield::continuum {

/// Elastic constants, Pa; only their ratios count for the stress.
struct TransverseModuli {
  double E_h = 1, E_v = 1;  ///< Young's moduli, horizontal and vertical
  double nu_h = 0.3;        ///< -eps_yy/eps_xx under s_xx
  double nu_v = 0.3;        ///< -eps_xx/eps_zz under s_zz
  double G_v = 1 / 2.6;     ///< shear modulus of vertical planes

  /// Whether every strain takes work.
  bool is_stable() const;
  /// Moduli of a vertical plane that does not strain across itself; x horizontal, y vertical. The
  /// stress across it is then nu_h s_xx + nu_v E_h/E_v s_yy.
  PlaneModuli plane_strain() const;
  /// Stress xx, yy, zz, yz, xz, xy of the strains xx, yy, zz, 2 yz, 2 xz, 2 xy; z vertical, Pa.
  Eigen::Matrix<double, 6, 6> stiffness() const;
};

/// E_h, E_v, nu_h, nu_v, G_v of a model's settings and their check: throws BadParameter naming the
/// model when they are not stable.
std::vector<Parameter> transverse_parameters();
TransverseModuli transverse_moduli(const std::string& model, const Settings& settings);

class TransverseHalfSpace {
 public:
  /// The moduli must be stable.
  TransverseHalfSpace(double F, const TransverseModuli& moduli);
  /// xx, yy, zz, yz, xz, xy at a point, z up, z < 0, load at the origin, down; Pa, tension
  /// positive.
  std::array<double, 6> stress(double x, double y, double z) const;
  /// x, y, z at a point, m; vanishes far away.
  std::array<double, 3> displacement(double x, double y, double z) const;

 private:
  struct Term {
    std::complex<double> g, a, A, down;  // down: k A
  };
  std::array<Term, 2> terms_;
  double plane_ = 0;  // c11 - c12
};

}  // namespace grainfield::continuum
