// Models of the registry with fitted constants: closed forms for a run's tables, finite elements
// beside the fits.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupling/compare/smooth.h"
#include "coupling/fit/fit.h"
#include "coupling/models/choice.h"
#include "coupling/result/tables.h"

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

/// The closed form of the registry with these constants, of a layer or heap of height h, m (F and h
/// are left to the run); label: the fitted model's name.
ModelChoice registry_choice(const FitModel& model, const Eigen::VectorXd& constants, double h);

/// The finite-element model `name` with the constants of the best of the fits (least expected
/// misfit) that it can represent (FitModel::in_registry), whose name is `of`; nothing when there is
/// no such fit. `fits`: in the order of `models`.
std::optional<ModelChoice> finite_element_choice(const std::string& name,
                                                 const std::vector<FitModel>& models,
                                                 const std::vector<Fit>& fits, double h,
                                                 std::string& of);

/// A model's stress at the data's rows, n x 3; the flag: it knows no base.
using SeenAtRows = std::function<Eigen::MatrixXd(const StressFunction&, bool half_plane)>;

/// Each solved in the units of the fits (h = 1, F = 1 or rho g = 1), nan counted as 0. Without such
/// a fit, or where the solve fails, `why` says so.
std::vector<FiniteElementFit> solve_elements(const std::vector<std::string>& names,
                                             const std::vector<FitModel>& models,
                                             const std::vector<Fit>& fits, const FitData& data,
                                             const Weights& weights, const SeenAtRows& seen);

const std::vector<std::string>& elements_header();
std::vector<std::vector<std::string>> element_rows(const std::vector<FiniteElementFit>& elements);
/// fe.NAME.*: see figures.cc.
void add_elements(Summary& summary, const std::vector<FiniteElementFit>& elements);

}  // namespace grainfield::coupling
