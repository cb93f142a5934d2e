#include "coupling/run/sweep_differences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "continuum/constants.h"
#include "coupling/statistics/holm.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {
namespace {

constexpr double kLevel = 0.05;

double figure_in(const Summary& summary, const std::string& key) {
  const auto at = summary.find(key);
  if (at == summary.end()) return kNan;
  if (const auto* value = std::get_if<double>(&at->second)) return *value;
  const auto* count = std::get_if<std::int64_t>(&at->second);
  return count == nullptr ? kNan : static_cast<double>(*count);
}

void correct(std::vector<SweepDifference>& all) {
  std::vector<double> p_values;
  for (const SweepDifference& d : all) p_values.push_back(d.p_value);
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].p_holm = corrected[k];
}

}  // namespace

double welch_p_value(double d, double s1, int n1, double s2, int n2) {
  const double v1 = s1 * s1, v2 = s2 * s2, sum = v1 + v2;
  if (n1 < least_for_significance || n2 < least_for_significance || !(sum > 0)) return kNan;
  const double freedom = sum * sum / (v1 * v1 / (n1 - 1) + v2 * v2 / (n2 - 1));
  const boost::math::students_t t(freedom);
  return 2 * cdf(complement(t, std::fabs(d) / std::sqrt(sum)));
}

std::vector<SweepDifference> sweep_differences(const std::vector<OverviewColumn>& columns,
                                               const std::vector<Summary>& members) {
  std::vector<SweepDifference> out;
  for (const OverviewColumn& column : columns) {
    for (std::size_t m = 1; m < members.size(); ++m) {
      const Summary &one = members.front(), &other = members[m];
      const double s1 = figure_in(one, column.error()), s2 = figure_in(other, column.error());
      const double n1 = figure_in(one, "ensemble.realizations"),
                   n2 = figure_in(other, "ensemble.realizations");
      SweepDifference d{column.heading, column.key, m};
      d.difference = figure_in(other, column.key) - figure_in(one, column.key);
      d.error = std::hypot(s1, s2);
      if (std::isnan(n1) || std::isnan(n2)) continue;
      d.p_value = welch_p_value(d.difference, s1, static_cast<int>(n1), s2, static_cast<int>(n2));
      if (!std::isnan(d.p_value)) out.push_back(d);
    }
  }
  correct(out);
  return out;
}

std::string differences_sentence(const std::vector<SweepDifference>& differences,
                                 const std::vector<std::string>& names) {
  if (differences.empty()) return "";
  std::vector<std::string> found;
  const SweepDifference* nearest = &differences.front();
  for (const SweepDifference& d : differences) {
    if (d.p_value < nearest->p_value) nearest = &d;
    if (d.p_holm < kLevel) {
      found.push_back(fmt::format("{} of {} is {} that of {} by {:.3g} ± {:.2g} (p = {:.2g})",
                                  d.heading, names[d.member], d.difference > 0 ? "above" : "below",
                                  names.front(), std::fabs(d.difference), d.error, d.p_value));
    }
  }
  const std::string how = fmt::format(
      "at 5 % (Welch's t over realizations, Holm's correction for {} "
      "comparison{})",
      differences.size(), differences.size() == 1 ? "" : "s");
  if (!found.empty()) return fmt::format("Different {}: {}.", how, fmt::join(found, "; "));
  return fmt::format(
      "Nothing differs {}. The least p is that of {} of {} against {}: {:+.3g} ± {:.2g}, p = "
      "{:.2g}.",
      how, nearest->heading, names[nearest->member], names.front(), nearest->difference,
      nearest->error, nearest->p_value);
}

}  // namespace grainfield::coupling
