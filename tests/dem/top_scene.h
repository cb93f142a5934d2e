// A free asymmetric top in closed form, beside integrators of turning.
#pragma once
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>

#include "dem/motion/verlet3.h"

namespace grainfield::dem::top {

using Eigen::Vector3d;

// Euler's top, moments 1 < 2 < 3, omega_2(0) = 0 (Landau and Lifshitz, vol. 1, section 37).
inline const Vector3d kMoments(1, 2, 3), kStart(0.9, 0, 1.1);

inline double energy_of(const Vector3d& spin) {
  return 0.5 * kMoments.dot(spin.cwiseProduct(spin));
}

/// Spin in the body frame at a time; the motion that starts at kStart with omega_2 rising.
inline Vector3d exact_spin(double time) {
  const double energy2 = 2 * energy_of(kStart);
  const double momentum2 = kMoments.cwiseProduct(kStart).squaredNorm();
  const double i1 = kMoments[0], i2 = kMoments[1], i3 = kMoments[2];
  // M^2 > 2 E I_2: the spin goes round the third axis.
  const double k2 =
      (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1));
  const double rate = std::sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3));
  const double tau = rate * time, k = std::sqrt(k2);
  // I_2 omega_2' = (I_3 - I_1) omega_3 omega_1 > 0 at the start.
  return {kStart[0] * boost::math::jacobi_cn(k, tau),
          std::sqrt((energy2 * i3 - momentum2) / (i2 * (i3 - i2))) * boost::math::jacobi_sn(k, tau),
          kStart[2] * boost::math::jacobi_dn(k, tau)};
}

struct Ended {
  Vector3d spin;      ///< in the body frame
  Vector3d momentum;  ///< in space
  double unit_error;  ///< of the rotation's size
  RotationOf<3> rotation;
};

/// The same top after `steps` steps of an integrator, at `time`.
template <class Integrator>
Ended turned(double time, int steps) {
  const Integrator integrator(time / steps);
  Inertia<3> inertia;
  inertia.mass = 1;
  inertia.moments = kMoments;
  Body<3> b;
  b.inverse_mass = 1;
  b.inverse_inertia = 0.5;
  b.spin = kStart;
  typename Integrator::Memory m;
  for (int s = 0; s < steps; ++s) {
    integrator.begin(b, m, inertia);
    integrator.end(b, m, inertia, {});
  }
  const Vector3d spin = m.rotation.conjugate() * b.spin;
  return {spin, m.rotation * Vector3d(kMoments.cwiseProduct(spin)),
          std::fabs(m.rotation.norm() - 1), m.rotation};
}

}  // namespace grainfield::dem::top
