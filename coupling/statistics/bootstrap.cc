#include "coupling/statistics/bootstrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/base/unknown_name.h"
#include "coupling/statistics/parallel.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

// More draws without a value than this share: no interval.
constexpr double most_undefined = 0.1;

void check(int realizations, const BootstrapOptions& options) {
  if (realizations < 1)
    throw std::invalid_argument(
        fmt::format("bootstrap over {} realizations; at least 1 is needed", realizations));
  if (options.interval != "bca" && options.interval != "percentile")
    throw std::invalid_argument(
        unknown_name("bootstrap interval", options.interval, {"bca", "percentile"}));
  if (!(options.level > 0 && options.level < 1))
    throw std::invalid_argument(
        fmt::format("bootstrap level is {}; it must be above 0 and below 1", options.level));
  if (options.resamples < 10)
    throw std::invalid_argument(
        fmt::format("bootstrap with {} resamples; at least 10 are needed", options.resamples));
  if (options.threads < 1)
    throw std::invalid_argument(
        fmt::format("bootstrap on {} threads; at least 1 is needed", options.threads));
}

// Streams that start at hashed states: neighbouring draws share nothing.
dem::Random stream(std::uint64_t seed, int draw) {
  dem::Random hash(seed);
  dem::Random of_draw(hash.bits() ^ static_cast<std::uint64_t>(draw));
  return dem::Random(of_draw.bits());
}

std::vector<int> everyone(int n) {
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }
double normal_share(double z) { return boost::math::cdf(boost::math::normal(), z); }

// Acceleration from the jackknife (Efron and Tibshirani 1993 eq. 14.15); 0 where it is undefined.
Eigen::VectorXd accelerations(int n, const Statistic& statistic, Eigen::Index values,
                              const BootstrapOptions& options) {
  Eigen::MatrixXd left_out(n, values);
  in_parts(n, options.threads, [&](int first, int last) {
    for (int r = first; r < last; ++r) {
      std::vector<int> others = everyone(n);
      others.erase(others.begin() + r);
      left_out.row(r) = statistic(others).transpose();
    }
  });
  Eigen::VectorXd result(values);
  for (Eigen::Index v = 0; v < values; ++v) {
    const Eigen::ArrayXd d = left_out.col(v).mean() - left_out.col(v).array();
    const double a = d.cube().sum() / (6 * std::pow(d.square().sum(), 1.5));
    result[v] = std::isfinite(a) ? a : 0;
  }
  return result;
}

// Share of the draws at which an end of the bca interval lies (same book, eq. 14.10), given the
// normal quantile z of that end.
double shifted_share(double z, double bias, double acceleration) {
  const double w = bias + z, divisor = 1 - acceleration * w;
  return divisor > 0 ? normal_share(bias + w / divisor) : (w > 0 ? 1.0 : 0.0);
}

// Normal quantile of the upper end before any correction of bias.
double upper_quantile(int n, const BootstrapOptions& options) {
  const double p = (1 + options.level) / 2;
  if (!options.widen) return normal_quantile(p);
  return std::sqrt(n / (n - 1.0)) * boost::math::quantile(boost::math::students_t(n - 1), p);
}

BootstrapInterval interval_of(double value, const Eigen::VectorXd& draws, double acceleration,
                              int realizations, const BootstrapOptions& options) {
  std::vector<double> sorted;
  for (const double draw : draws)
    if (!std::isnan(draw)) sorted.push_back(draw);
  BootstrapInterval result{value, kNan, kNan, kNan,
                           static_cast<int>(draws.size()) - static_cast<int>(sorted.size())};
  if (std::isnan(value) || result.undefined > most_undefined * static_cast<double>(draws.size()))
    return result;
  std::sort(sorted.begin(), sorted.end());
  const double n = static_cast<double>(sorted.size());
  const double mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / n;
  double squares = 0;
  for (const double draw : sorted) squares += (draw - mean) * (draw - mean);
  result.error = std::sqrt(squares / (n - 1));
  const double z = upper_quantile(realizations, options);
  double low = normal_share(-z), high = normal_share(z);
  if (options.interval == "bca") {
    const auto range = std::equal_range(sorted.begin(), sorted.end(), value);
    const double below = static_cast<double>(range.first - sorted.begin()),
                 equal = static_cast<double>(range.second - range.first);
    // Kept half a draw away from the ends, where the bias would be infinite.
    const double share = std::clamp((below + equal / 2) / n, 0.5 / n, 1 - 0.5 / n);
    const double bias = normal_quantile(share);
    low = shifted_share(-z, bias, acceleration);
    high = shifted_share(z, bias, acceleration);
  }
  result.low = sorted_quantile(sorted, low);
  result.high = sorted_quantile(sorted, high);
  return result;
}

}  // namespace

double sorted_quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  if (k + 1 >= sorted.size()) return sorted.back();
  return sorted[k] + (at - static_cast<double>(k)) * (sorted[k + 1] - sorted[k]);
}

Eigen::MatrixXd bootstrap_draws(int realizations, const Statistic& statistic,
                                const BootstrapOptions& options) {
  check(realizations, options);
  const Eigen::Index values = statistic(everyone(realizations)).size();
  Eigen::MatrixXd draws(options.resamples, values);
  in_parts(options.resamples, options.threads, [&](int first, int last) {
    std::vector<int> chosen(static_cast<std::size_t>(realizations));
    for (int b = first; b < last; ++b) {
      dem::Random random = stream(options.seed, b);
      for (int& r : chosen) r = static_cast<int>(random.uniform() * realizations);
      draws.row(b) = statistic(chosen).transpose();
    }
  });
  return draws;
}

std::vector<BootstrapInterval> bootstrap_intervals(int realizations, const Statistic& statistic,
                                                   const Eigen::MatrixXd& draws,
                                                   const BootstrapOptions& options) {
  check(realizations, options);
  const Eigen::VectorXd value = statistic(everyone(realizations));
  std::vector<BootstrapInterval> result;
  if (realizations == 1) {
    for (const double v : value) result.push_back({v, kNan, kNan, kNan, 0});
    return result;
  }
  const Eigen::VectorXd acceleration =
      options.interval == "bca" ? accelerations(realizations, statistic, value.size(), options)
                                : Eigen::VectorXd(Eigen::VectorXd::Zero(value.size()));
  for (Eigen::Index v = 0; v < value.size(); ++v)
    result.push_back(interval_of(value[v], draws.col(v), acceleration[v], realizations, options));
  return result;
}

std::vector<BootstrapInterval> bootstrap(int realizations, const Statistic& statistic,
                                         const BootstrapOptions& options) {
  return bootstrap_intervals(realizations, statistic,
                             bootstrap_draws(realizations, statistic, options), options);
}

}  // namespace grainfield::coupling
