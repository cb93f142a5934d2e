// Grains that are drawn before a run, to know what bounds its time step.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/heap/grain_family.h"
#include "dem/random/random.h"

namespace grainfield::dem {

/// By how much the time step may miss that of grains that were not drawn.
inline constexpr double kStepReserve = 1.05;

/// Draws the grains of one realization after the other, at most `left` in all:
/// draw(random, left), which takes from `left` what it has drawn, then judge(grains, reserve), with
/// kStepReserve where grains may be missing, else 1.
template <class Draw, class Judge>
void judge_draws(const std::vector<std::uint64_t>& seeds, std::int64_t left, Draw draw,
                 Judge judge) {
  for (const std::uint64_t seed : seeds) {
    if (left < 1) return;
    Random random(seed);
    const std::vector<ShapedGrain> grains = draw(random, left);
    judge(grains, left > 0 ? 1 : kStepReserve);
  }
}

}  // namespace grainfield::dem
