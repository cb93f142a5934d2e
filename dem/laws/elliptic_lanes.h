// The law of hertz_elliptic.h for several contacts side by side, with the motion at the contact and
// the spring's turning (kinematics3.h): operation by operation what is done for one.
#pragma once
#include "dem/laws/contact_batch.h"
#include "dem/space/lane_width.h"

namespace grainfield::dem {

/// Numbers of a row of the ellipse's table: coefficients of K, and of D.
inline constexpr int kEllipseRow = 18;

struct EllipticNumbers {
  double young = 0, effective_young = 0, poisson = 0, damping = 0;
  bool displacement = false;
  double least_radius = 0, most_radius = 0;
  double friction = 0, dt = 0;    ///< dt > 0, s
  const double* table = nullptr;  ///< EllipseTable::coefficients
};

/// Forces of slots 0 to count - 1. The bits do not depend on W.
template <int W>
void elliptic_forces_of(const EllipticNumbers& law, const OverlapBatch& o, ContactBatch& c,
                        int count);
inline void elliptic_forces(const EllipticNumbers& law, const OverlapBatch& o, ContactBatch& c,
                            int count) {
  with_lanes([&](auto width) { elliptic_forces_of<width()>(law, o, c, count); });
}

}  // namespace grainfield::dem
