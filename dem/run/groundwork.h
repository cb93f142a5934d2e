// What a study's run and its forecast have in common: checks, draws and settings, told once.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

#include "dem/random/random.h"
#include "dem/run/outlook.h"

namespace grainfield::dem {

/// By how much the time step may miss that of grains that were not drawn.
inline constexpr double kStepReserve = 1.05;

/// How many grains may be drawn: all those of a run, some of a forecast.
class Allowance {
 public:
  Allowance() = default;
  explicit Allowance(std::int64_t draws) : left_(static_cast<double>(draws)) {}

  /// As many of `wanted` as are left, one at least; `work`: of drawing one.
  int grant(double wanted, double work = 1) {
    const double granted = std::min(wanted, std::max(1.0, std::floor(left_ / work)));
    cut_ = cut_ || granted < wanted;
    left_ -= granted * work;
    used_ = true;
    return static_cast<int>(granted);
  }
  /// One more, where it is left.
  bool grant_one(double work) {
    cut_ = cut_ || left_ < work;
    return !cut_ && grant(1, work) == 1;
  }

  /// As many as could be granted, without counting them: of grains that change no limit.
  int at_most(double wanted) const {
    return static_cast<int>(std::min(wanted, std::max(1.0, std::floor(left_))));
  }

  bool is_used() const { return used_; }
  /// Whether less was granted than wanted.
  bool is_cut() const { return cut_; }
  bool is_left() const { return !cut_ && left_ > 0; }

 private:
  double left_ = std::numeric_limits<double>::infinity();
  bool used_ = false, cut_ = false;
};

/// Static functions that throw std::invalid_argument naming the key:
/// - check(setup): what can be judged without the grains;
/// - draw(setup, random, allowance): the grains on which settings depend, in the run's order;
/// - settings(setup, grains, reserve): of the engine, on one thread. Its limits are tighter by
///   `reserve` (engine_settings) where not all grains were drawn, else 1;
/// - outlook(setup, settings): what a realization takes.
/// kName begins the fingerprint of checkpoints.
template <class G>
concept Groundwork = requires(const typename G::Setup& setup, Random& random,
                              Allowance& allowance) {
  { G::kName } -> std::convertible_to<const char*>;
  G::check(setup);
  {
    G::outlook(setup, G::settings(setup, G::draw(setup, random, allowance), 1.0))
    } -> std::same_as<Outlook>;
};

/// All grains of a run.
template <Groundwork G>
auto draw_all(const typename G::Setup& setup, Random& random) {
  Allowance all;
  return G::draw(setup, random, all);
}

/// Throws as a run of any of these seeds would; draws at most so many grains.
template <Groundwork G>
Outlook foresee(const typename G::Setup& setup, const std::vector<std::uint64_t>& seeds,
                std::int64_t draws) {
  G::check(setup);
  Outlook out;
  Allowance allowance(draws);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    Random random(seeds[k]);
    const auto grains = G::draw(setup, random, allowance);
    const bool all_known = !allowance.is_cut() && (allowance.is_left() || k + 1 == seeds.size());
    const auto settings = G::settings(setup, grains, all_known ? 1 : kStepReserve);
    if (k == 0) out = G::outlook(setup, settings);
    if (!allowance.is_used() || !allowance.is_left()) break;  // no other grains to judge
  }
  return out;
}

}  // namespace grainfield::dem
