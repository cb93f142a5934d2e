// Constants that many files need.
#pragma once
#include <limits>
#include <numbers>

namespace grainfield {

inline constexpr double kDegree = std::numbers::pi / 180;  // rad
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace grainfield
