#include "coupling/heap/dip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/averaging/base.h"

namespace grainfield::coupling {
namespace {

constexpr double kLevel = 0.05;  // two-sided

// Of so few normal numbers the standard error itself is uncertain by 1/sqrt(2 (n - 1)).
std::string few_realizations(int n) {
  if (n >= 5) return "";
  return fmt::format("; of {} realizations that error itself is uncertain by {:.0f} %", n,
                     100 / std::sqrt(2.0 * (n - 1)));
}

}  // namespace

BaseWindows base_windows(const dem::Snapshot& pile, const PileFrame& frame,
                         const HeapSetup& setup) {
  double centre = 0, shoulder = 0;
  for (const BaseContact& f : base_contacts(pile)) {
    const double at = std::fabs(frame.in_half_bases(f.point.x()));
    if (at < setup.centre) centre += f.force.y();
    if (at >= setup.shoulder_from && at < setup.shoulder_to) shoulder += f.force.y();
  }
  const double base = frame.half_left + frame.half_right;
  BaseWindows out;
  out.centre = centre / (setup.centre * base) / frame.pressure();
  out.shoulder = shoulder / ((setup.shoulder_to - setup.shoulder_from) * base) / frame.pressure();
  return out;
}

Dip judge_dip(const std::vector<BaseWindows>& piles) {
  Dip out;
  std::vector<double> differences;
  for (const BaseWindows& p : piles) {
    out.centre += p.centre / static_cast<double>(piles.size());
    out.shoulder += p.shoulder / static_cast<double>(piles.size());
    differences.push_back(p.shoulder - p.centre);
  }
  out.window_ratio = out.centre / out.shoulder;
  out.difference = spread_of(differences);
  const double p = out.difference.p_value;
  out.verdict = std::isnan(p)          ? "undecided"
                : 2 * p < kLevel       ? "dip"
                : 2 * (1 - p) < kLevel ? "peak"
                                       : "neither";
  return out;
}

std::string dip_sentence(const Dip& dip) {
  const std::string numbers =
      fmt::format("the base carries {:.3f} rho g h under the apex and {:.3f} under the shoulders",
                  dip.centre, dip.shoulder);
  if (dip.verdict == "undecided") {
    return fmt::format("{} realization{}: {}; whether that is a dip needs at least {} that differ.",
                       dip.difference.values, dip.difference.values == 1 ? "" : "s", numbers,
                       least_for_significance);
  }
  const bool peak = dip.verdict == "peak";
  const double p = dip.difference.p_value;
  const std::string spread = fmt::format(
                                 "{}; difference {:.3f} +- {:.3f} over {} realizations, p = {:.2g} "
                                 "(two-sided; dip.p_value "
                                 "= {:.2g} is one-sided) if there were none",
                                 numbers, dip.difference.mean, dip.difference.standard_error,
                                 dip.difference.values, 2 * std::min(p, 1 - p), p) +
                             few_realizations(dip.difference.values);
  if (dip.verdict == "dip") return fmt::format("A pressure dip: {}.", spread);
  if (peak) return fmt::format("No dip but a pressure peak: {}.", spread);
  return fmt::format("No dip and no peak beyond the spread: {}.", spread);
}

}  // namespace grainfield::coupling
