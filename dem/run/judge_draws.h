// Grains that are drawn before a run, to know what bounds its time step.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grains/grain_family.h"
#include "dem/grains/packing.h"
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

/// Draws the grains of one realization after the other, at most so many in all.
class Draws {
 public:
  Draws(std::int64_t most, std::size_t realizations)
      : left_(static_cast<double>(most)), realizations_(realizations) {}

  /// Goes on to the next realization that can be drawn.
  bool next() {
    if (cut_ || (at_ >= 0 && left_ <= 0)) return false;
    return static_cast<std::size_t>(++at_) < realizations_;
  }
  std::size_t at() const { return static_cast<std::size_t>(at_); }
  /// Whether this realization is whole and another one can follow, or none is left.
  bool all_known() const { return !cut_ && (left_ > 0 || at() + 1 == realizations_); }

  /// `count` grains, or as many as are left; one at least.
  void draw(const ShapeSetup& shape, double count, Random& random, GrainTally& tally) {
    const double work = draw_work(shape);
    for (double k = 0; k < count; ++k) {
      if (left_ < work && k > 0) {
        cut_ = true;
        return;
      }
      tally.add(draw_grain(shape, random));
      left_ -= work;
    }
  }
  /// Side by side on a length.
  void fill(const ShapeSetup& shape, double room, Random& random, GrainTally& tally) {
    const double work = draw_work(shape);
    for (; left_ >= work; left_ -= work) {
      const ShapedGrain next = draw_grain(shape, random);
      room -= 2 * next.radius;
      if (room < 0) return;
      tally.add(next);
    }
    cut_ = true;
  }

 private:
  double left_;
  std::int64_t at_ = -1;
  std::size_t realizations_;
  bool cut_ = false;  // in the midst of a realization
};

}  // namespace grainfield::dem
