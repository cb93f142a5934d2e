#include "coupling/statistics/correlation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

// A spread below this share of the largest number is rounding.
constexpr double least_spread = 1e-14;

// Moments of some pairs about a fixed origin; they add up over realizations.
struct PairSums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(const PairSums& o) { n += o.n, x += o.x, y += o.y, xx += o.xx, xy += o.xy, yy += o.yy; }
};

struct Line {
  double r = kNan, slope = kNan, intercept = kNan;
};

// `scale_x`, `scale_y`: size of the numbers, below whose rounding nothing varies.
Line line_of(const PairSums& s, double scale_x, double scale_y) {
  if (s.n < 3) return {};
  const double mx = s.x / s.n, my = s.y / s.n;
  const double vx = s.xx / s.n - mx * mx, vy = s.yy / s.n - my * my, v = s.xy / s.n - mx * my;
  if (!(vx > std::pow(least_spread * scale_x, 2)) || !(vy > std::pow(least_spread * scale_y, 2)))
    return {};
  return {std::clamp(v / std::sqrt(vx * vy), -1.0, 1.0), v / vx, my - v / vx * mx};
}

}  // namespace

Correlation correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const std::vector<int>& realization, const BootstrapOptions& options) {
  if (x.size() != y.size() || static_cast<std::size_t>(x.size()) != realization.size())
    throw std::invalid_argument(fmt::format("correlation of {} and {} numbers of {} realizations",
                                            x.size(), y.size(), realization.size()));
  Correlation result;
  std::map<int, std::vector<Eigen::Index>> members;
  double mean_x = 0, mean_y = 0, scale_x = 0, scale_y = 0;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (std::isnan(x[k]) || std::isnan(y[k])) continue;
    members[realization[static_cast<std::size_t>(k)]].push_back(k);
    mean_x += x[k];
    mean_y += y[k];
    scale_x = std::max(scale_x, std::abs(x[k]));
    scale_y = std::max(scale_y, std::abs(y[k]));
    ++result.pairs;
  }
  mean_x /= std::max(1, result.pairs);
  mean_y /= std::max(1, result.pairs);
  // About the means: the differences of squares lose no digits.
  std::vector<PairSums> sums;
  for (const auto& [number, pairs] : members) {
    PairSums s;
    for (const Eigen::Index k : pairs) {
      const double u = x[k] - mean_x, v = y[k] - mean_y;
      s.add({1, u, v, u * u, u * v, v * v});
    }
    sums.push_back(s);
  }
  result.realizations = static_cast<int>(sums.size());
  PairSums all;
  for (const PairSums& s : sums) all.add(s);
  const Line line = line_of(all, scale_x, scale_y);
  result.r = line.r;
  result.slope = line.slope;
  result.intercept = line.intercept + mean_y - line.slope * mean_x;
  result.interval = {result.r, kNan, kNan, kNan, 0};
  if (std::isnan(result.r)) return result;
  const auto statistic = [&](const std::vector<int>& chosen) {
    PairSums drawn;
    for (const int c : chosen) drawn.add(sums[static_cast<std::size_t>(c)]);
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, line_of(drawn, scale_x, scale_y).r));
  };
  result.interval = bootstrap(result.realizations, statistic, options).front();
  return result;
}

Correlation correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const BootstrapOptions& options) {
  std::vector<int> each(static_cast<std::size_t>(x.size()));
  std::iota(each.begin(), each.end(), 0);
  return correlation(x, y, each, options);
}

}  // namespace grainfield::coupling
