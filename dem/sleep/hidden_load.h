// Sleepers hide a part of the load of the levels of a packing: how much.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grainfield::dem {

/// A grain above or below a level.
struct LevelShare {
  double height = 0;  ///< m, against gravity
  double weight = 0;  ///< N
  double hidden = 0;  ///< N: its residual force along gravity, of a sleeper; 0 awake
};

// Levels with less than this share of the whole weight above them are not asked.
inline constexpr double kLeastAbove = 0.05;

/// Largest share of the weight above a level that the sleepers above it hide from it: |sum of their
/// residual forces along gravity| over that weight. Residuals of one sign add up from grain to
/// grain, so that a bound on each grain's own bounds this sum only by the number of layers times
/// that bound. What sleepers hide sideways, or of opposite signs at one height, is not seen; where
/// walls press harder than the weight, the share is larger than that of the load. Sorts `grains`,
/// highest first; 0 without weight.
inline double largest_hidden_share(std::vector<LevelShare>& grains) {
  std::sort(grains.begin(), grains.end(),
            [](const LevelShare& a, const LevelShare& b) { return a.height > b.height; });
  double whole = 0, above = 0, hidden = 0, largest = 0;
  for (const LevelShare& g : grains) whole += g.weight;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    above += grains[k].weight;
    hidden += grains[k].hidden;
    const bool level = k + 1 == grains.size() || grains[k + 1].height < grains[k].height;
    if (level && above > 0 && above >= kLeastAbove * whole) {
      largest = std::max(largest, std::fabs(hidden) / above);
    }
  }
  return largest;
}

}  // namespace grainfield::dem
