// What the methods of [average] make of an ensemble: lines, a map, and how well forces balance.
#pragma once
#include <string>
#include <vector>

#include "coupling/averaging/balance.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/result/tables.h"
#include "coupling/run/averaging_setup.h"

namespace grainfield::coupling {

struct MethodAverages {
  std::string method;
  AverageOptions options;
  std::vector<Ensemble> lines, beside;  ///< the study's own; `beside`: further ones
  Ensemble map;
  double balance_rms = 0, balance_largest = 0;

  /// The residual of one of so many realizations.
  void add_balance(const BalanceResidual& residual, std::size_t realizations);
};

/// Empty averages by every method of the setup, for grains of this mean diameter, m.
std::vector<MethodAverages> methods_of(const AverageSetup& setup, double diameter, int threads,
                                       std::size_t lines, std::size_t beside = 0);

/// Keys average.METHOD.balance_*, average.width or .rve_radius and, of the lines' component where
/// one is named, average.METHOD.fluctuation.
void add_method_figures(Summary& summary, const MethodAverages& averages,
                        const std::string& component = "");

}  // namespace grainfield::coupling
