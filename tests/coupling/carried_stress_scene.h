// Packings of disks whose contact forces carry a known stress field: the truth that an import, an
// average and a verdict have to find again.
//
// The network is a jittered triangular lattice. Every contact begins with the traction of the field
// over its share of the area, and with noise:
//   f0 = sigma(x) a + noise s xi,   a = normal x share,   s = |sigma(x)| |a|,   xi normal numbers.
// The correction of least weighted norm then balances forces and moments of every grain,
//   f = f0 + W A^T (A W A^T)^-1 (b - A f0),   A f = b the equations of balance,   W = s^2,
// which projects the noise on the force fields that balance themselves. Repeated until the rest is
// round-off.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>

#include "dem/snapshot/snapshot.h"

namespace grainfield::test {

/// xx, yy, xy, tension positive, at points n x 2; a row of nan: there is none.
using StressAt = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

struct Disorder {
  double jitter = 0.02;  ///< of the places, diameters, uniform in each direction
  double noise = 0.5;    ///< of the contact forces before they are balanced, of their own size
  std::uint64_t seed = 1;
};

/// A layer on a floor between two walls, at rest under its weight, and under a load on the grain in
/// the middle of its surface.
struct CarriedLayer {
  int columns = 39, rows = 11;
  double diameter = 0.009;  ///< m
  double load = 10;         ///< N
  Disorder disorder;

  double depth() const;  ///< m
};

struct LoadedLayer {
  dem::Snapshot unloaded, loaded;
};

/// `response`: the stress that the load adds, in the frame of the models: load at (0, 0), base at
/// y = -depth().
LoadedLayer carried_layer(const CarriedLayer& setup, const StressAt& response);

/// A heap on a floor.
struct CarriedHeap {
  double slope_deg = 28;
  double diameter = 0.01;  ///< m
  int rows = 35;           ///< odd: a grain at the apex
  Disorder disorder;
};

/// Weight per area of a heap, N/m2.
double carried_rho_g();
/// `stress`: apex at (0, 0).
dem::Snapshot carried_heap(const CarriedHeap& setup, const StressAt& stress);

/// Largest resultant force of a free grain, weight and applied force included, and largest moment
/// over the grain's radius: over the mean contact force.
double largest_imbalance(const dem::Snapshot& s);

/// Share of the contacts that pull.
double pulling_share(const dem::Snapshot& s);

}  // namespace grainfield::test
