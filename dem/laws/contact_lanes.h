// The laws of hertz_elliptic.h and penalty.h for several contacts side by side, with the motion at
// the contact and the spring's turning (kinematics3.h): operation by operation what is done for
// one.
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
struct PenaltyNumbers {
  double normal = 0, tangential = 0, damping = 0;
  double friction = 0, dt = 0;  ///< dt > 0, s
};

/// Forces of slots 0 to count - 1, of an EllipticNumbers or a PenaltyNumbers. The bits do not
/// depend on W.
template <int W, class Law>
void contact_forces_of(const Law& law, const OverlapBatch& o, ContactBatch& c, int count);
template <class Law>
void contact_forces(const Law& law, const OverlapBatch& o, ContactBatch& c, int count) {
  with_lanes([&](auto width) { contact_forces_of<width()>(law, o, c, count); });
}

}  // namespace grainfield::dem
