// Models whose parameters are fitted. A new one is one file and one line in models.cc.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "continuum/model.h"

namespace grainfield::coupling {

struct FitParameter {
  std::string name;     ///< for summary keys: "eta", "beta_hat_deg"
  std::string unit;     ///< "-", "deg", "N/m"
  std::string meaning;  ///< one line
  double least = 0;     ///< open bounds of the search; infinite: none
  double most = 0;
  /// A limit that no material passes, of ratios of moduli: the interval over realizations is even
  /// in log(value - floor), so the same for a ratio and its reciprocal. -infinite: even in the
  /// value.
  double floor = -std::numeric_limits<double>::infinity();
};

/// A model of the registry (continuum/registry.h) that is a model of fits with these constants, of
/// a layer or heap of height h, m.
struct RegistryModel {
  std::string name;
  std::function<continuum::Settings(const Eigen::VectorXd& parameters, double h)> settings;
};

/// A model with free parameters; without any it is only compared.
struct FitModel {
  std::string name;   ///< key: "cantelaube_free"
  std::string label;  ///< for people, with what is held fixed
  std::vector<FitParameter> parameters;
  std::vector<Eigen::VectorXd> starts;  ///< of the search; the best end wins. At least one
  /// Points (n x 2, models' frame), parameters -> n x 3 stresses xx, yy, xy in N/m, tension
  /// positive; nan outside the model's domain or for parameters it cannot take.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&, const Eigen::VectorXd&)> stress;
  std::string absent;  ///< why there is no such field for this heap; empty: there is
  /// The model with what it takes from the packings (slopes) measured on these realizations alone,
  /// with repetitions; empty: it takes nothing from them.
  std::function<FitModel(const std::vector<int>&)> measured_on = {};
  /// Its name in the registry and, where it has one, its base: models of one kind differ in what is
  /// free. Empty: a description.
  std::string kind = {};
  std::string equations = {};  ///< "elliptic" or "hyperbolic"; empty: nothing is said of it
  /// The same in the registry: the closed form first, where there is one, then finite elements.
  std::vector<RegistryModel> in_registry = {};
  /// Its constants are free of equilibrium: a description, which wins no verdict.
  bool unbalanced = false;
};

/// The model as these realizations alone have it; itself where it takes nothing from them or where
/// there is no such field for them.
inline FitModel model_of(const FitModel& model, const std::vector<int>& realizations) {
  if (!model.measured_on) return model;
  FitModel out = model.measured_on(realizations);
  return out.absent.empty() ? out : model;
}

/// A vector of these numbers.
inline Eigen::VectorXd numbers(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(),
                                           static_cast<Eigen::Index>(values.size()));
}

}  // namespace grainfield::coupling
