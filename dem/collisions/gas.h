// A gas of equal hard disks or spheres in a periodic box: how it starts, and what theory says of
// it.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "dem/collisions/scene.h"
#include "dem/random/random.h"

namespace grainfield::dem {

/// Volume of a sphere, area of a disk.
template <int D>
double round_volume(double radius) {
  const double square = std::numbers::pi * radius * radius;
  return D == 2 ? square : 4.0 / 3 * radius * square;
}

struct GasSetup {
  std::int64_t grains = 10000;
  double fraction = 0.35;  ///< of the box that the grains fill
  double radius = 1e-3;    ///< m
  double mass = 1;         ///< kg
  double speed = 1;        ///< root mean square of each component of the velocities, m/s
};

/// The box, periodic along all axes: a square, a cube.
template <int D>
HardBox<D> gas_box(const GasSetup& gas);

/// The largest fraction that start_gas can place. Disks stand on a triangular lattice, spheres on a
/// face-centred cubic one, as it fits into a square or a cube.
template <int D>
double largest_fraction(std::int64_t grains, double radius);

/// Grains on sites of the lattice that are drawn, with velocities of a normal distribution, whose
/// mean is 0 and whose square is `speed`^2 times D (1 - 1/grains), and without spin. The fraction
/// is at most largest_fraction(). The same bits on every machine.
template <int D>
std::vector<Body<D>> start_gas(const GasSetup& gas, Random& random);

/// k T, J: twice the kinetic energy of the grains' motion, without spins, over D (n - 1).
template <int D>
double temperature_of(const std::vector<Body<D>>& grains);
/// The same of their spins, over 1 (disks) or 3 times n.
template <int D>
double spin_temperature_of(const std::vector<Body<D>>& grains);

// -- theory

/// Z = p V/(n k T): Henderson 1975 of disks, Carnahan and Starling 1969 of spheres.
template <int D>
double gas_compressibility(double fraction) {
  const double f = fraction, rest = 1 - f;
  if (D == 2) return (1 + f * f / 8) / (rest * rest);
  return (1 + f + f * f - f * f * f) / (rest * rest * rest);
}

/// The same by the ten virial coefficients that are known (Clisby and McCoy 2006), the rest as a
/// geometric series. For fractions of a fluid.
template <int D>
double gas_virial_series(double fraction) {
  // B_k over B_2^{k-1} from k = 2 on; B_2 is 2^{D-1} times a grain's volume.
  constexpr double kDisks[] = {1,         0.78200443, 0.53223180, 0.33355604, 0.1988425,
                               0.1148728, 0.0649930,  0.0362193,  0.0199537};
  constexpr double kSpheres[] = {1,          0.625,     0.2869495, 0.110252, 0.03888198,
                                 0.01302354, 0.0041832, 0.0013094, 0.0004035};
  const auto& shares = D == 2 ? kDisks : kSpheres;
  const double x = (D == 2 ? 2 : 4) * fraction;
  double sum = 1, power = 1, last = 0;
  for (const double share : shares) {
    power *= x;
    last = share * power;
    sum += last;
  }
  const double ratio = x * shares[8] / shares[7];
  return sum + last * ratio / (1 - ratio);
}

/// Enskog's collisions of a grain per second, each pair's counted for both: those of a dilute gas
/// times the value of the pair distribution at contact, (Z - 1)/(2^{D-1} fraction). `speed`:
/// sqrt(k T/m), m/s.
template <int D>
double enskog_rate(double fraction, double radius, double speed, double compressibility) {
  // 2 n d sqrt(pi k T/m) of disks and 4 n d^2 sqrt(pi k T/m) of spheres, n per area and volume.
  const double root = std::sqrt(std::numbers::pi);
  const double contact = (compressibility - 1) / (D == 2 ? 2 * fraction : 4 * fraction);
  const double dilute = (D == 2 ? 8 : 24) * fraction / (2 * radius * root) * speed;
  return contact * dilute;
}

/// Haff's time tau, s: smooth grains of restitution e < 1 that stay mixed cool as
/// T = T_0/(1 + t/tau)^2, 1/tau = (1 - e^2) rate/(2 D), by the rate at t = 0 (Haff 1983).
template <int D>
double haff_time(double rate, double restitution) {
  return 2 * D / ((1 - restitution * restitution) * rate);
}

#define GRAINFIELD_GAS(D)                                                      \
  extern template HardBox<D> gas_box<D>(const GasSetup&);                      \
  extern template double largest_fraction<D>(std::int64_t, double);            \
  extern template std::vector<Body<D>> start_gas<D>(const GasSetup&, Random&); \
  extern template double temperature_of<D>(const std::vector<Body<D>>&);       \
  extern template double spin_temperature_of<D>(const std::vector<Body<D>>&);
GRAINFIELD_GAS(2)
GRAINFIELD_GAS(3)
#undef GRAINFIELD_GAS

}  // namespace grainfield::dem
