#include "coupling/studies/sample/simulation/goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/run/common.h"

namespace grainfield::dem {
namespace {

// A compression to a pressure ends at this share of it; what is left comes in the rest. At rest it
// is met within the second.
constexpr double kNearTarget = 0.9, kMet = 2e-3;
// Overlap over the smaller radius at which a grain counts as crushed: laws of small overlaps, and
// the common normal of two bodies, say nothing any more.
constexpr double kCrushed = 0.5;

}  // namespace

const char* goal_key(const SamplePlan& plan) {
  if (starts_as_filled(plan)) return "base_fraction";
  if (plan.compress_to == "strain") return "compression_strain";
  return plan.compress_to == "pressure" ? "pressure" : "solid_fraction";
}

double compressed_share(const SamplePlan& plan, double last_edge, double box, double fraction) {
  if (plan.compress_to == "strain") return (1 - last_edge / box) / plan.compression_strain;
  return fraction / plan.solid_fraction;
}

bool is_near_pressure(const SamplePlan& plan, const Vec3& pressure) {
  bool near = true;
  for (int a = 0; a < plan.dim; ++a) {
    near = near &&
           (!is_led(plan, SamplePhase::compress, a) || pressure[a] >= kNearTarget * plan.pressure);
  }
  return near;
}

void check_pressure_found(const SampleSetup& setup, double time, double compression_time,
                          double fraction) {
  const SamplePlan& plan = setup.plan;
  const double most = 2 * compression_time + setup.rest.max_time;
  if (time > most) {
    throw ComputationFailed(fmt::format(
        "sample.pressure = {:g} has not been reached within {:.3g} s (twice the way at "
        "sample.compression_rate, and rest.max_time): the lower it is beside the contacts' "
        "stiffness, the slower it is found; raise it, or rest.max_time",
        plan.pressure, most));
  }
  if (fraction > kTooDense) {
    throw ComputationFailed(
        fmt::format("the sample has been compressed to a solid fraction of {:.3g} without reaching "
                    "sample.pressure = {:g}; lower it, or raise the stiffness (material)",
                    fraction, plan.pressure));
  }
}

void check_not_crushed(const SampleSetup& setup, const Diagnostics& state, const std::string& when,
                       const char* key) {
  if (!(state.max_overlap_ratio >= kCrushed)) return;
  const bool by_stiffness = setup.material.law == "linear" || setup.material.law == "penalty";
  throw ComputationFailed(fmt::format(
      "a grain is crushed {}: it overlaps by {:.2g} of its radius, allowed: below {:g}; lower "
      "sample.{}, or raise material.{}",
      when, state.max_overlap_ratio, kCrushed, key, by_stiffness ? "normal_stiffness" : "young"));
}

void check_fraction_ahead(const SamplePlan& plan, double fraction) {
  if (plan.compress_to != "solid_fraction" || fraction < plan.solid_fraction) return;
  throw ComputationFailed(fmt::format(
      "sample.solid_fraction = {:g} cannot be compressed to: the sample has a solid fraction of "
      "{:.4g} before its compression; raise sample.solid_fraction",
      plan.solid_fraction, fraction));
}

double servo_error(const SamplePlan& plan, SamplePhase phase, const Vec3& pressure) {
  double worst = 0;
  for (int a = 0; a < plan.dim; ++a) {
    if (is_led(plan, phase, a)) {
      worst = std::max(worst, std::fabs(pressure[a] / plan.pressure - 1));
    }
  }
  return worst;
}

bool is_prepared(const SampleSetup& setup, SamplePhase phase, const Diagnostics& state,
                 const Vec3& pressure) {
  return at_rest(state, setup.rest) &&
         (!any_led(setup.plan, phase) || servo_error(setup.plan, phase, pressure) <= kMet);
}

void fail_to_prepare(const SampleSetup& setup, const Diagnostics& state, const Vec3& pressure) {
  const SamplePlan& plan = setup.plan;
  if (state.contacts == 0) {
    throw ComputationFailed(fmt::format(
        "no grain touches another after rest.max_time = {:g} s: the sample is too loose to be "
        "sheared; raise sample.{}",
        setup.rest.max_time, goal_key(plan)));
  }
  if (at_rest(state, setup.rest)) {
    throw ComputationFailed(fmt::format(
        "sample.pressure = {:g} has not been met within rest.max_time = {:g} s: the grains rest at "
        "pressures of {:.4g} along x and {:.4g} along {}; raise it, or lower "
        "sample.compression_rate",
        plan.pressure, setup.rest.max_time, pressure[0], pressure[plan.dim - 1],
        plan.dim == 2 ? "y" : "z"));
  }
  fail_to_rest(state, setup.rest, "after the compression",
               compresses_to_pressure(plan)
                   ? ", or lower sample.compression_rate"
                   : ", or compress further: a sample below jamming carries no stress");
}

}  // namespace grainfield::dem
