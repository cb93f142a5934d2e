// Averages over horizontal rings about a vertical axis: fields of radius and height.
#pragma once
#include <Eigen/Core>
#include <functional>

#include "coupling/averaging/gaps.h"
#include "coupling/averaging/options.h"
#include "coupling/base/field.h"

namespace grainfield::coupling {

/// Gives a field of averaging (average.h) at points of space, n x 3, m.
using FieldAt = std::function<Field(const Eigen::MatrixXd& points, const AverageOptions& options)>;

/// The mean over the angle of the field in cylindrical components: columns as average() names them
/// with r, t (along the angle, counter-clockwise from above) and z for x, y and z, so sigma_rr,
/// sigma_tt, sigma_zz, sigma_rz ... `rings`: n x 2, radius and height, m; they are the field's
/// points. Places on a ring are a third of the width apart (a fifth of that of an element), eight
/// at least; those without a value are left out, `grains` is their mean count, and rings with fewer
/// than least_grains are nan. Throws std::invalid_argument for a negative radius and what `at`
/// throws.
Field average_on_rings(const FieldAt& at, const Eigen::Vector2d& axis, const Eigen::MatrixXd& rings,
                       const AverageOptions& options, Gaps* gaps = nullptr);

}  // namespace grainfield::coupling
