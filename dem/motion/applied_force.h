// A force from outside on one grain.
#pragma once
#include <algorithm>
#include <cstdint>

namespace grainfield::dem {

/// A force on one grain that rises from 0 to its full value along a smooth ramp (3 s^2 - 2 s^3).
struct AppliedForce {
  std::int64_t id = -1;   ///< grain, -1: none
  double fx = 0, fy = 0;  ///< full force, N
  double start = 0;       ///< s
  double ramp = 0;        ///< s; 0: at once
  double fz = 0;          ///< N; in 3D

  /// Share of the full force that acts at time t, s.
  double share_at(double t) const {
    const double since = t - start;
    const double s = ramp > 0 ? std::clamp(since / ramp, 0.0, 1.0) : 1.0;
    return s * s * (3 - 2 * s);
  }
};

}  // namespace grainfield::dem
