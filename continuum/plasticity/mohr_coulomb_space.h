// The Mohr-Coulomb law of mohr_coulomb.h in space: all six components, with the exact tangent.
#pragma once
#include "continuum/plasticity/mohr_coulomb.h"

namespace grainfield::continuum::plasticity {

/// Components xx, yy, zz, yz, xz, xy; a strain's shears are the engineering ones.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct ReturnedSpace {
  Vector6 stress = Vector6::Zero();
  Vector6 elastic_strain = Vector6::Zero();  ///< of this stress
  Matrix6 tangent = Matrix6::Zero();         ///< d stress / d trial strain; exact
  Regime regime = Regime::elastic;
};

/// Hooke's law of Young's modulus and Poisson's ratio, and its inverse.
Matrix6 hooke_in_space(double E, double nu);
Vector6 elastic_strain_in_space(const Vector6& stress, double E, double nu);

/// The stress for this trial elastic strain.
ReturnedSpace return_in_space(const MohrCoulombLaw& law, const Vector6& trial_strain);

}  // namespace grainfield::continuum::plasticity
