#include "coupling/statistics/exponential_tail.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "continuum/constants.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

// Largest difference between the empirical distribution and 1 - exp(-x / mean); sorts.
double distance_of(std::vector<double>& excess, double mean) {
  std::sort(excess.begin(), excess.end());
  const double n = static_cast<double>(excess.size());
  double largest = 0;
  for (std::size_t k = 0; k < excess.size(); ++k) {
    const double model = -std::expm1(-excess[k] / mean);
    const double before = static_cast<double>(k) / n, after = static_cast<double>(k + 1) / n;
    largest = std::max({largest, model - before, after - model});
  }
  return largest;
}

double mean_of(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

}  // namespace

ExponentialTail exponential_tail(const Eigen::VectorXd& numbers, double threshold,
                                 const TailOptions& options) {
  if (!std::isfinite(threshold))
    throw std::invalid_argument(
        fmt::format("the threshold of the tail is {}; it must be finite", threshold));
  if (!(options.level > 0 && options.level < 1))
    throw std::invalid_argument(
        fmt::format("the tail's level is {}; it must be above 0 and below 1", options.level));
  if (options.simulations < 1)
    throw std::invalid_argument(
        fmt::format("{} simulations of the tail; at least 1 is needed", options.simulations));
  ExponentialTail tail{threshold, 0, kNan, kNan, kNan, kNan, kNan, kNan};
  std::vector<double> excess;
  int all = 0;
  for (const double f : numbers) {
    if (std::isnan(f)) continue;
    ++all;
    if (f > threshold) excess.push_back(f - threshold);
  }
  tail.count = static_cast<int>(excess.size());
  if (all > 0) tail.share = static_cast<double>(tail.count) / all;
  if (tail.count < 3) return tail;
  const double n = tail.count, mean = mean_of(excess);
  tail.rate = 1 / mean;
  const boost::math::chi_squared chi(2 * n);
  tail.low = boost::math::quantile(chi, (1 - options.level) / 2) / (2 * n * mean);
  tail.high = boost::math::quantile(chi, (1 + options.level) / 2) / (2 * n * mean);
  tail.distance = distance_of(excess, mean);
  dem::Random random(options.seed);
  int larger = 0;
  for (int s = 0; s < options.simulations; ++s) {
    for (double& x : excess) x = -std::log1p(-random.uniform());
    larger += distance_of(excess, mean_of(excess)) >= tail.distance;
  }
  // The sample itself counts as one of them: never an impossible p-value of 0.
  tail.p_value = (larger + 1.0) / (options.simulations + 1.0);
  return tail;
}

}  // namespace grainfield::coupling
