// Holds the normal stresses of a periodic cell by stretching its edges.
#pragma once
#include <array>

#include "dem/snapshot/snapshot.h"
#include "dem/study/archive.h"

namespace grainfield::dem {

/// What the rate of an edge, 1/s, answers to the error e = pressure - target of its direction:
///   rate = b + e / (K T + eta), db/dt = e / (10 T (K T + eta)), |rate| and |b| at most `most`
/// K is the stiffness of the contacts as a stress, eta that of their dashpots, T the time between
/// two measurements. A packing's own modulus is a third of K or less, so that one measurement later
/// part of the error is left: no overshoot. b is the rate that the packing asks for by itself: it
/// leaves no error where a steady flow dilates.
struct CellServo {
  double modulus = 0;            ///< K, Pa (N/m)
  double viscosity = 0;          ///< eta, Pa s (N s/m)
  double interval = 0;           ///< T, s
  double most = 0;               ///< 1/s
  std::array<double, 3> bias{};  ///< b, 1/s

  /// Of the edge along `axis`, 1/s. `target`: above 0, Pa (N/m), compression positive.
  double rate(int axis, double pressure, double target);
  void forget() { bias = {}; }
  void visit(Archive& archive) { archive(bias); }
};

}  // namespace grainfield::dem
