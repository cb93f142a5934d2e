// Models of fits out of the registry (continuum/registry.h): a table's entry says which of its
// numbers are free, the registry has the stress.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/fit/layer_sight.h"
#include "coupling/fit/model.h"
#include "coupling/models/evaluate_model.h"

namespace grainfield::coupling {

/// Lengths in units of h.
struct RegistryEntry {
  std::string name, label;        ///< of the fit
  std::string registry;           ///< the registry's name; empty: a description
  continuum::Settings fixed;      ///< besides what the facts fill in
  std::vector<std::string> open;  ///< the registry's numbers that follow from the constants
  std::vector<FitParameter> parameters = {};            ///< the constants
  std::vector<Eigen::VectorXd> starts = {numbers({})};  ///< of the search
  /// Constants to the open numbers, where these are other combinations; empty: they are the same.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> values = {};
  /// Finite elements that take the same settings as far as they have them, and these.
  std::vector<std::pair<std::string, continuum::Settings>> elements = {};
  std::string absent = {};  ///< FitModel::absent
  /// A description, which is no model of the registry: points, constants to stresses.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&, const Eigen::VectorXd&)> description = {};
  bool unbalanced = false;  ///< FitModel::unbalanced
};

/// The model with its exact stress; with a sight as it is seen, at the sight's places alone.
/// Absent, for the reason that the registry gives, where it cannot be made of these facts.
FitModel model_of_entry(const RegistryEntry& entry, const RunFacts& facts,
                        std::shared_ptr<const LayerSight> sight = nullptr);

/// The waves of a layer of the registry, with settings as complete() returns them, for sums over
/// wave numbers: node by node these layers take minutes. Nothing of other models.
std::optional<continuum::OrthotropicWaves> waves_of(const std::string& registry,
                                                    const continuum::Settings& settings);

/// The settings with lengths, m, over h.
continuum::Settings in_units_of(double h, const std::string& model, continuum::Settings settings);

/// The stress of nothing: nan, n x 3.
Eigen::MatrixXd no_stress(const Eigen::MatrixXd& points);

}  // namespace grainfield::coupling
