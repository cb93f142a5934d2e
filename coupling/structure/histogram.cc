#include "coupling/structure/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainfield::coupling {

Eigen::VectorXd DensityHistogram::centres() const {
  const Eigen::Index n = counts.size();
  return (edges.head(n) + edges.tail(n)) / 2;
}

DensityHistogram density_histogram(const Eigen::VectorXd& numbers, double low, double high,
                                   int bins) {
  if (bins < 1 || !(high > low) || !std::isfinite(high - low))
    throw std::invalid_argument(fmt::format(
        "histogram: found {} bins from {:g} to {:g}; allowed: 1 or more, from a lower to "
        "a higher number",
        bins, low, high));
  DensityHistogram out;
  out.edges = Eigen::VectorXd::LinSpaced(bins + 1, low, high);
  out.counts = Eigen::VectorXi::Zero(bins);
  int all = 0;
  for (const double number : numbers) {
    if (std::isnan(number)) continue;
    ++all;
    if (number < low || number > high) {
      ++out.outside;
      continue;
    }
    const auto bin = static_cast<int>((number - low) / (high - low) * bins);
    ++out.counts[std::min(bin, bins - 1)];
  }
  const double unit = all > 0 ? all * (high - low) / bins : 1;
  out.density = out.counts.cast<double>() / unit;
  out.error = out.counts.cast<double>().cwiseSqrt() / unit;
  return out;
}

}  // namespace grainfield::coupling
