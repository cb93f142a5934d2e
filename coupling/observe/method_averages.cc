#include "coupling/observe/method_averages.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainfield::coupling {

void MethodAverages::add_balance(const BalanceResidual& residual, std::size_t realizations) {
  balance_rms += residual.rms / static_cast<double>(realizations);
  balance_largest = std::max(balance_largest, residual.largest);
}

std::vector<MethodAverages> methods_of(const AverageSetup& setup, double diameter, int threads,
                                       std::size_t lines, std::size_t beside) {
  std::vector<MethodAverages> out;
  for (const std::string& method : setup.methods) {
    MethodAverages a;
    a.method = method;
    a.options = average_options(setup, method, diameter, threads);
    a.lines.resize(lines);
    a.beside.resize(beside);
    out.push_back(std::move(a));
  }
  return out;
}

void add_method_figures(Summary& summary, const MethodAverages& averages,
                        const std::string& component) {
  const std::string prefix = "average." + averages.method + ".";
  summary[prefix + "balance_rms"] = averages.balance_rms;
  summary[prefix + "balance_largest"] = averages.balance_largest;
  summary[averages.method == "coarse_graining" ? "average.width" : "average.rve_radius"] =
      averages.options.width;
  if (component.empty()) return;
  double largest = 0, error = 0;
  int count = 0;
  for (const Ensemble& line : averages.lines) {
    const Field mean = line.mean();
    const Column& column = *mean.find(component);
    for (Eigen::Index i = 0; i < column.value.size(); ++i) {
      if (std::isnan(column.value[i])) continue;
      largest = std::max(largest, std::fabs(column.value[i]));
      if (std::isnan(column.error[i])) continue;
      error += column.error[i];
      ++count;
    }
  }
  if (count > 0 && largest > 0) summary[prefix + "fluctuation"] = error / count / largest;
}

}  // namespace grainfield::coupling
