// Finite-element solves with fitted constants, beside the fits.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/models/choice.h"
#include "coupling/output/tables.h"

namespace grainfield::coupling {

/// A finite-element model of the registry with the constants of a fit, on the fit's points.
struct FiniteElementFit {
  std::string name, of;     ///< registry's name, fitted model whose constants it has
  std::string constants;    ///< "base=rough, nu=0.21"
  std::string why;          ///< not empty: was not solved, for this reason
  Eigen::VectorXd model;    ///< at the data's rows
  double chi2_per_dof = 0;  ///< with the fitted model's spread
  double rel_l2 = 0;        ///< |grains - it| / |grains|
  double from_closed = 0;   ///< |it - fitted model| / |fitted model|
};

/// "base=rough, nu=0.2113": numbers with four digits.
std::string constants_text(const continuum::Settings& settings);

/// Fills model and the distances of `out` from the stresses (n x 3, tension positive; nan counts as
/// 0) at the data's rows.
void judge_elements(FiniteElementFit& out, const FitData& data, const Weights& weights,
                    const Fit& fitted, const Eigen::MatrixXd& stresses);

const std::vector<std::string>& elements_header();
std::vector<std::vector<std::string>> element_rows(const std::vector<FiniteElementFit>& elements);
/// fe.NAME.*: see figures.cc.
void add_elements(Summary& summary, const std::vector<FiniteElementFit>& elements);

}  // namespace grainfield::coupling
