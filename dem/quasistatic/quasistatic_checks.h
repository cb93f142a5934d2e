// What the quasi-static solver refuses.
#pragma once
#include <Eigen/Core>

#include "dem/quasistatic/quasistatic.h"

namespace grainfield::dem {

/// The functions throw std::invalid_argument naming what was found and what is allowed.
void check_settings(const QuasistaticSettings& settings);
void check_start(const Snapshot& start);
/// check_start, and what only strain() refuses.
void check_strained(const Snapshot& start);
/// A strain must be small.
void check_gradient(const Eigen::Matrix3d& gradient);

}  // namespace grainfield::dem
