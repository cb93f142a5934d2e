// Holds the normal stresses of a periodic cell by stretching its edges.
#pragma once
#include <array>

#include "dem/run/archive.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::dem {

/// What the rate of an edge, 1/s, answers to the error e = pressure - target of its direction:
///   rate = b + e / (K (T + s)), db/dt = e / (10 K (T + s)^2), |rate| and |b| at most `most`
/// K is the stiffness of the contacts as a stress (sample_servo.cc), K s that of their dashpots, T
/// the time between two measurements. The modulus with which a packing answers at once is below K,
/// so an error is never answered by more than itself: no overshoot. b is the rate that the packing
/// asks for by itself: it leaves no error where a steady flow dilates. With a modulus of K/4, about
/// that of a packing at rest, the two together are damped at 0.8 of critical.
struct CellServo {
  double modulus = 0;            ///< K, Pa (N/m)
  double slowness = 0;           ///< s, s
  double interval = 0;           ///< T, s
  double most = 0;               ///< 1/s
  std::array<double, 3> bias{};  ///< b, 1/s

  /// Rate of the edge along `axis`, 1/s. `target`: above 0, Pa (N/m), compression positive.
  double rate(int axis, double pressure, double target);
  void forget() { bias = {}; }
  void visit(Archive& archive) { archive(bias); }
};

}  // namespace grainfield::dem
