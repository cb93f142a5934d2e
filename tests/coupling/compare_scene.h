// Profiles for the suites of the comparison.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <stdexcept>
#include <string>

#include "tests/refusal.h"

namespace grainfield::coupling {

inline Eigen::VectorXd axis(int n, double reach) {
  return Eigen::VectorXd::LinSpaced(n, -reach, reach);
}

inline Eigen::VectorXd bell(const Eigen::VectorXd& x, double at, double width, double height) {
  return height * (-((x.array() - at) / width).square() / 2).exp();
}

}  // namespace grainfield::coupling
