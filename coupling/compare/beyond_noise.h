// How far a model is from the truth behind an ensemble, beyond the noise of its mean: the squared
// distance from a mean of N realizations is larger by the mean's variance than that from the truth.
#pragma once
#include <Eigen/Core>

#include "continuum/constants.h"

namespace grainfield::coupling {

struct BeyondNoise {
  double squared =
      kNan;             ///< sum (mean - model)^2 less the noise, over sum model^2; may be negative
  double error = kNan;  ///< its standard error, by the jackknife over the realizations
  double noise = kNan;  ///< what was taken away
  int degrees = 0;      ///< of freedom of the error; 0: it is unknown
  double bound = kNan;  ///< upper end of 95 % (one-sided, Student's t) of `squared`, wide

  /// The model is right to this share: the root of the bound, 0 where that is negative.
  double right_to() const;
};

/// `samples`: places x realizations; places where a number is nan are left out. nan for one
/// realization, and without error for two. Throws std::invalid_argument when the sizes differ.
BeyondNoise misfit_beyond_noise(const Eigen::MatrixXd& samples, const Eigen::VectorXd& model);

}  // namespace grainfield::coupling
