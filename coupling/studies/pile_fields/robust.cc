#include "coupling/studies/pile_fields/robust.h"

#include <algorithm>
#include <cmath>

namespace grainfield::coupling {
namespace {

constexpr double kNormal = 1.4826;  // standard deviation over median distance of normal numbers

// Share of normal numbers below one standard deviation above the mean.
constexpr double kOneAbove = 0.8413;

std::vector<double> known(const std::vector<double>& numbers) {
  std::vector<double> out;
  std::copy_if(numbers.begin(), numbers.end(), std::back_inserter(out),
               [](double v) { return std::isfinite(v); });
  return out;
}

}  // namespace

double median_of(std::vector<double> numbers) {
  numbers = known(numbers);
  if (numbers.empty()) return std::nan("");
  std::sort(numbers.begin(), numbers.end());
  return sorted_quantile(numbers, 0.5);
}

double robust_deviation(const std::vector<double>& numbers) {
  std::vector<double> distances = known(numbers);
  if (distances.size() < 2) return std::nan("");
  const double middle = median_of(distances);
  for (double& v : distances) v = std::fabs(v - middle);
  return kNormal * median_of(std::move(distances));
}

RobustMean robust_mean(const std::vector<double>& numbers, int resamples) {
  const std::vector<double> all = known(numbers);
  RobustMean out;
  out.count = static_cast<int>(all.size());
  out.median = median_of(all);
  if (all.size() < 2) return out;
  BootstrapOptions options;
  options.interval = "percentile";
  options.resamples = resamples;
  const Statistic statistic = [&](const std::vector<int>& chosen) -> Eigen::VectorXd {
    std::vector<double> drawn;
    for (const int r : chosen) drawn.push_back(all[static_cast<std::size_t>(r)]);
    return Eigen::VectorXd::Constant(1, median_of(std::move(drawn)));
  };
  const Eigen::MatrixXd draws = bootstrap_draws(out.count, statistic, options);
  const auto interval = bootstrap_intervals(out.count, statistic, draws, options);
  std::vector<double> sorted(draws.col(0).begin(), draws.col(0).end());
  std::sort(sorted.begin(), sorted.end());
  out.error = (sorted_quantile(sorted, kOneAbove) - sorted_quantile(sorted, 1 - kOneAbove)) / 2;
  out.low = interval[0].low;
  out.high = interval[0].high;
  return out;
}

void add_median(Summary& summary, const std::string& key, const std::vector<double>& numbers,
                int resamples) {
  const RobustMean mean = robust_mean(numbers, resamples);
  summary[key] = mean.median;
  const std::vector<double> all = known(numbers);
  if (all.size() < 2) return;
  summary[key + ".standard_error"] = mean.error;
  summary[key + ".least"] = *std::min_element(all.begin(), all.end());
  summary[key + ".most"] = *std::max_element(all.begin(), all.end());
}

}  // namespace grainfield::coupling
