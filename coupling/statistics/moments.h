// Mean, spread and standard error of a list of numbers (of fields: coupling/averaging/ensemble.h).
#pragma once
#include <Eigen/Core>

namespace grainfield::coupling {

/// Of independent numbers, in their unit.
struct Moments {
  int count = 0;
  double mean = 0;       ///< nan without numbers
  double deviation = 0;  ///< sample standard deviation s, divisor count - 1; nan below two numbers
  double error = 0;      ///< standard error of the mean, s / sqrt(count); nan below two numbers
};

/// Of all the numbers; a nan among them makes every moment nan.
Moments moments(const Eigen::VectorXd& numbers);

}  // namespace grainfield::coupling
