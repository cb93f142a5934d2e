// A ring or a peak: whether a response to a point load is largest on the load's axis, as elliptic
// equations have it, or on a ring about it, as hyperbolic ones do (Bouchaud, Cates and Claudin
// 1995).
#pragma once
#include <Eigen/Core>
#include <string>

namespace grainfield::coupling {

struct RingAgainstAxis {
  double at = 0;          ///< radius of the ring: mean over the realizations, unit of r
  double difference = 0;  ///< ring less axis, mean over the realizations, unit of the samples
  double error = 0;       ///< its standard error
  double p = 0;           ///< two-sided, of a difference as large if there were none

  /// "ring", "peak", or "neither" where p is 0.05 or more; empty where nothing was measured.
  std::string word() const;
};

/// `r`: ascending from 0; `samples`: pressures, r.size() x realizations. Every realization's ring
/// lies where the mean of the others is largest at `least` or farther out, so that no noise chooses
/// its own place: without a ring the difference is that of the axis and some place beside it, below
/// 0. All nan with fewer than three realizations, without a radius of at least `least`, or where a
/// value is nan.
RingAgainstAxis ring_against_axis(const Eigen::VectorXd& r, const Eigen::MatrixXd& samples,
                                  double least);

}  // namespace grainfield::coupling
