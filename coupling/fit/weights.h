// How the values of a fit count, and what is known of their errors.
//
// The weights are fixed before the data are seen: a value counts by its difference from the model
// in its own working unit (FitData::scale). Weights made of the ensemble itself (an inverse
// covariance) change with its size, and where no model holds exactly the best constants follow
// them: 4 and 128 realizations then aim at different constants. Errors do not come from the weights
// either, but from what the constants do over the realizations.
#pragma once
#include <Eigen/Core>
#include <string>

#include "coupling/judge/judgement.h"
#include "coupling/observe/data.h"

namespace grainfield::coupling {

struct Weights {
  ErrorsFrom errors_from = ErrorsFrom::nothing;
  std::string note;        ///< why nothing better is known; may be empty
  Eigen::VectorXd weight;  ///< of a value's difference: 1 / its working unit, m/N
  Eigen::VectorXd error;   ///< standard error of a value's mean, N/m; nan where nothing is known

  bool known() const { return errors_from != ErrorsFrom::nothing; }
};

/// Throws std::invalid_argument for data that do not pass check().
Weights weights_of(const FitData& data);

}  // namespace grainfield::coupling
