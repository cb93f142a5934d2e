#include "coupling/specimen/dip.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "coupling/averaging/base.h"

namespace grainfield::coupling {
namespace {

constexpr double kLevel = 0.05;  // two-sided

// The standard error of so few normal numbers is itself uncertain by 1/sqrt(2 (n - 1)).
std::string few_realizations(int n) {
  if (n >= 5) return "";
  return fmt::format(", an error that is itself uncertain by {:.0f} %",
                     100 / std::sqrt(2.0 * (n - 1)));
}

}  // namespace

BaseWindows base_windows(const dem::Snapshot& pile, const PileFrame& frame,
                         const HeapSetup& setup) {
  double centre = 0, shoulder = 0;
  for (const BaseSupport& f : base_supports(pile)) {
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

std::vector<std::string> dip_lines(const Dip& dip) {
  const std::string numbers =
      fmt::format("The base carries {:.3f} rho g h under the apex and {:.3f} under the shoulders",
                  dip.centre, dip.shoulder);
  const int n = dip.difference.values;
  if (dip.verdict == "undecided") {
    return {fmt::format("Whether there is a pressure dip needs at least {} realizations that "
                        "differ; there {} {}.",
                        least_for_significance, n == 1 ? "is" : "are", n),
            numbers + "."};
  }
  const char* const found = dip.verdict == "dip"    ? "The heaps have a pressure dip"
                            : dip.verdict == "peak" ? "The heaps have a pressure peak and no dip"
                                                    : "The heaps show no dip or peak beyond chance";
  const double p = dip.difference.p_value;
  std::vector<std::string> out{
      fmt::format("{} ({} realizations, 95 %).", found, n),
      fmt::format("{}: difference {:.3f} ± {:.3f}{}. If there were none, a difference this "
                  "large would occur by chance in {:.2g} % of ensembles.",
                  numbers, dip.difference.mean, dip.difference.standard_error, few_realizations(n),
                  200 * std::min(p, 1 - p))};
  if (dip.verdict == "neither") {
    // The interval that the heaps leave open: without it "no dip" is read as a measurement.
    const double reach =
        dip.difference.standard_error * quantile(boost::math::students_t(n - 1), 1 - kLevel / 2);
    out.back() += fmt::format(
        " The true difference can be anything from {:.2f} (peak) to {:.2f} (dip) rho g h "
        "(95 %): pour more heaps to narrow this.",
        dip.difference.mean - reach, dip.difference.mean + reach);
  }
  return out;
}

}  // namespace grainfield::coupling
