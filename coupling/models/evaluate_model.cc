#include "coupling/models/evaluate_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>

#include "continuum/constants.h"
#include "continuum/settings.h"
#include "continuum/size.h"
#include "continuum/without_effect.h"
#include "coupling/compare/compare.h"
#include "coupling/models/fit_names.h"

namespace grainfield::coupling {

continuum::Settings filled_settings(const ModelChoice& choice, const RunFacts& facts) {
  continuum::Settings out = choice.settings;
  bool friction_filled = false;
  const continuum::ModelInfo& info = continuum::find_model(choice.name);
  for (const auto& parameter : info.parameters) {
    if (parameter.name == "F") out.emplace("F", fmt::format("{}", facts.force));
    if (parameter.name == "h") out.emplace("h", fmt::format("{}", facts.height));
    if (parameter.name == "depth") out.emplace("depth", fmt::format("{}", facts.depth));
    const auto& words = parameter.choices;
    if (parameter.name == "base" &&
        std::find(words.begin(), words.end(), facts.base) != words.end()) {
      out.emplace("base", facts.base);
    }
    if (parameter.name == "dim") out.emplace("dim", std::to_string(facts.dim));
    const auto number = facts.numbers.find(parameter.name);
    if (number == facts.numbers.end() || out.count(parameter.name) != 0) continue;
    // What the case sets may leave it without effect, as a map does r and t.
    if (!continuum::without_effect_because(info, parameter.name, continuum::complete(info, out))
             .empty())
      continue;
    if (std::isnan(number->second)) {
      throw continuum::BadParameter(fmt::format(
          "model {}: {} cannot be measured on this heap (too few grains on its flanks); "
          "set it in [model.{}]",
          choice.name, parameter.name, choice.label));
    }
    out.emplace(parameter.name, fmt::format("{}", number->second));
    if (parameter.name == "phi_deg") friction_filled = true;
  }
  // A heap with two slopes is at least as frictional as the steeper of them.
  for (const char* slope : {"left_deg", "right_deg"}) {
    const auto at = out.find(slope);
    if (friction_filled && at != out.end() &&
        continuum::number_of(out, slope) > continuum::number_of(out, "phi_deg"))
      out["phi_deg"] = at->second;
  }
  return out;
}

void require_models(const std::vector<ModelChoice>& choices, const RunFacts& facts) {
  for (const ModelChoice& choice : choices) {
    const auto& info = continuum::find_model(choice.name);
    const continuum::Settings settings = filled_settings(choice, facts);
    if (const auto found = continuum::find_without_effect(info, settings)) {
      throw continuum::BadParameter(found->refusal);
    }
    const continuum::Settings full = continuum::complete(info, settings);
    continuum::require_possible(info, full);
    if (!choice.name.starts_with("fe_")) info.make(full);
  }
}

void require_models(const std::vector<ModelChoice>& choices, int dim) {
  constexpr double kHeights[] = {1e-3, 0.1, 10}, kSlopes[] = {20, 27, 35};
  for (const ModelChoice& choice : choices) {
    std::set<std::string> said;
    for (std::size_t k = 0; k < std::size(kHeights); ++k) {
      const double h = kHeights[k], slope = kSlopes[k];
      RunFacts facts{1, h, dim, 0.1 * h, "", {}};
      facts.numbers = {{"rho_g", 1 / h},      {"phi_deg", slope},
                       {"left_deg", slope},   {"right_deg", slope},
                       {"chi_g", 1},          {"alpha_deg", slope},
                       {"spacing", 0.01 * h}, {"width", 2 * h / std::tan(slope * kDegree)}};
      try {
        require_models({choice}, facts);
        said.emplace();
      } catch (const continuum::BadParameter& e) {
        said.emplace(e.what());
      }
    }
    if (said.size() == 1 && !said.begin()->empty()) throw continuum::BadParameter(*said.begin());
  }
}

// Constants that the label of a model with a name of its own tells.
constexpr std::size_t kMostTold = 3;

// A file without its folder: a label is of the model, wherever its table lies.
std::string told_value(const std::string& value) {
  return value.substr(value.find_last_of('/') + 1);
}

std::string model_label(const ModelChoice& choice) {
  // A name that fits give says its settings itself.
  const FitName* known = find_fit_name(choice.label);
  if (known != nullptr && known->registry != choice.name) known = nullptr;
  std::vector<std::string> items;
  for (const auto& [name, value] : choice.settings) {
    if (known == nullptr || known->fixed.count(name) == 0)
      items.push_back(name + "=" + told_value(value));
  }
  const bool one = choice.label == choice.name || known != nullptr;
  const std::string name = one ? choice.label : choice.label + "=" + choice.name;
  // A name of its own stands for many constants, which legends and titles have no room for.
  const bool told = !one && items.size() > kMostTold;
  return items.empty() || told ? name : fmt::format("{} ({})", name, fmt::join(items, ", "));
}

std::map<std::string, double> over_grains_height(std::map<std::string, double> figures,
                                                 double spanned) {
  for (const char* name : {"base_centre", "base_largest"}) {
    const auto at = figures.find(name);
    if (at != figures.end()) at->second *= spanned;
  }
  return figures;
}

Eigen::MatrixXd stress_at(const ModelChoice& choice, continuum::Model& model,
                          Eigen::MatrixXd points) {
  points.rightCols<1>().array() += choice.below;
  Eigen::MatrixXd out = model.stress(points);
  if (choice.below > 0) {
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      if (points.row(k).tail<1>().value() >= 0) out.row(k).setZero();
  }
  return out;
}

Evaluation evaluate_model(const ModelChoice& choice, const RunFacts& facts,
                          const std::vector<PointSet>& sets) {
  const auto start = std::chrono::steady_clock::now();
  const auto model = continuum::make_model(choice.name, filled_settings(choice, facts));
  // A half plane or space knows no base: below it the stresses go on.
  const std::string family = family_of(choice.name);
  const double depth = family == "half plane" || family == "half space" ? 0 : facts.height;
  const Eigen::MatrixXd stresses =
      ObservationOperator(sets, depth).seen([&](const Eigen::MatrixXd& nodes) {
        return stress_at(choice, *model, nodes);
      });
  Evaluation out;
  Eigen::Index row = 0;
  for (const auto& set : sets) {
    out.stresses.emplace_back(stresses.middleRows(row, set.points.rows()));
    row += set.points.rows();
  }
  out.figures = model->figures();
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace grainfield::coupling
