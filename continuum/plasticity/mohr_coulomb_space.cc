// The law is isotropic: stress and trial strain have the same principal directions n_i, so that
//   sigma = sum s_i n_i n_i,   d sigma = sum a_ij (n_j . d eps n_j) n_i n_i
//           + sum over i < j of (s_i - s_j)/(e_i - e_j) (n_i . d eps n_j) (n_i n_j + n_j n_i),
// a the tangent among principal values; where e_i = e_j the quotient is its limit a_ii - a_ij
// (de Souza Neto, Peric and Owen 2008, appendix A).
#include "continuum/plasticity/mohr_coulomb_space.h"

#include <Eigen/Eigenvalues>

namespace grainfield::continuum::plasticity {
namespace {

// Principal strains that differ by less than this part of the largest have directions of round-off.
constexpr double kSameStrain = 1e-12;

// The symmetric part of a b^T, as components of a stress.
Vector6 product(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Vector6 out;
  out << a[0] * b[0], a[1] * b[1], a[2] * b[2], 0.5 * (a[1] * b[2] + a[2] * b[1]),
      0.5 * (a[0] * b[2] + a[2] * b[0]), 0.5 * (a[0] * b[1] + a[1] * b[0]);
  return out;
}

Eigen::Matrix3d tensor_of_strain(const Vector6& e) {
  Eigen::Matrix3d out;
  out << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return out;
}

}  // namespace

Matrix6 hooke_in_space(double E, double nu) {
  const double shear = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>().setConstant(lambda);
  out.diagonal().head<3>().array() += 2 * shear;
  out.diagonal().tail<3>().setConstant(shear);
  return out;
}

Vector6 elastic_strain_in_space(const Vector6& stress, double E, double nu) {
  const double trace = stress.head<3>().sum();
  Vector6 out = (1 + nu) / E * stress;
  out.head<3>().array() -= nu * trace / E;
  out.tail<3>() *= 2;
  return out;
}

ReturnedSpace return_in_space(const MohrCoulombLaw& law, const Vector6& trial_strain) {
  const MohrCoulomb& m = law.constants();
  const Matrix6 hooke = hooke_in_space(m.E, m.nu);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(tensor_of_strain(trial_strain));
  // Ascending there, descending here.
  const Eigen::Vector3d e = axes.eigenvalues().reverse();
  const Eigen::Matrix3d n = axes.eigenvectors().rowwise().reverse();
  const Eigen::Vector3d trial = hooke.topLeftCorner<3, 3>() * e;
  const MohrCoulombLaw::Principal found = law.principal_return(trial);
  ReturnedSpace out;
  out.regime = found.regime;
  if (found.regime == Regime::elastic) {
    out.stress = hooke * trial_strain;
    out.elastic_strain = trial_strain;
    out.tangent = hooke;
    return out;
  }
  Eigen::Matrix<double, 6, 3> own;
  for (int i = 0; i < 3; ++i) own.col(i) = product(n.col(i), n.col(i));
  out.stress = own * found.stress;
  out.elastic_strain = elastic_strain_in_space(out.stress, m.E, m.nu);
  out.tangent = own * found.tangent * own.transpose();
  const auto& a = found.tangent;
  const double scale = e.cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      const double quotient = e[i] - e[j] > kSameStrain * scale
                                  ? (found.stress[i] - found.stress[j]) / (e[i] - e[j])
                                  : (a(i, i) + a(j, j) - a(i, j) - a(j, i)) / 2;
      const Vector6 turn = product(n.col(i), n.col(j));
      out.tangent += 2 * quotient * turn * turn.transpose();
    }
  }
  return out;
}

}  // namespace grainfield::continuum::plasticity
