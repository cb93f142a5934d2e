// Constants that must come back with errors.
#pragma once
#include <gtest/gtest.h>

#include "coupling/fit/fit.h"

namespace grainfield::coupling {

inline void expect_back(const Fit& fit, const Eigen::VectorXd& truth) {
  ASSERT_EQ(fit.parameters.size(), static_cast<std::size_t>(truth.size()));
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FittedParameter& p = fit.parameters[k];
    EXPECT_GT(p.error, 0) << fit.name << " " << p.parameter.name;
    EXPECT_LT(p.error, p.parameter.unit == "deg" ? 1 : 0.1) << fit.name << " " << p.parameter.name;
    EXPECT_NEAR(p.value, truth[static_cast<Eigen::Index>(k)], 4 * p.error)
        << fit.name << " " << p.parameter.name;
  }
}

}  // namespace grainfield::coupling
