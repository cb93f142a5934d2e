#include "coupling/fit/finite_elements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "coupling/compare/compare.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/models/evaluate_model.h"
#include "dem/shared/number.h"

namespace grainfield::coupling {

namespace {

// "base=rough, nu=0.2113": numbers with four digits.
std::string constants_text(const continuum::Settings& settings) {
  std::vector<std::string> out;
  for (const auto& [key, value] : settings) {
    const std::optional<double> number = parse_number(value);
    out.push_back(fmt::format("{}={}", key, number ? fmt::format("{:.4g}", *number) : value));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

// Fills model and distances from the stresses at the data's rows.
void measure(const FitData& data, const Weights& weights, const Fit& fitted,
             const Eigen::MatrixXd& stresses, FiniteElementFit& out) {
  const FitModel given{out.name,
                       out.name,
                       {},
                       {Eigen::VectorXd(0)},
                       [&](const Eigen::MatrixXd&, const Eigen::VectorXd&) { return stresses; },
                       ""};
  out.model = predict(data, given, Eigen::VectorXd(0));
  const Eigen::VectorXd mean = data.mean(), off = mean - out.model;
  // The fitted model's spread is this one's, too.
  out.chi2_per_dof =
      fitted.chi2_per_dof * weights.weight.cwiseProduct(off).squaredNorm() / fitted.misfit;
  out.rel_l2 = off.norm() / mean.norm();
  out.from_closed = (out.model - fitted.model).norm() / fitted.model.norm();
}

}  // namespace

ModelChoice registry_choice(const FitModel& model, const Eigen::VectorXd& constants, double h) {
  const RegistryModel& closed = model.in_registry.front();
  return {model.name, closed.name, closed.settings(constants, h)};
}

std::optional<ModelChoice> finite_element_choice(const std::string& name,
                                                 const std::vector<FitModel>& models,
                                                 const std::vector<Fit>& fits, double h,
                                                 std::string& of) {
  const Fit* best = nullptr;
  const RegistryModel* known = nullptr;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    for (const RegistryModel& one : models[k].in_registry) {
      if (one.name != name || (best != nullptr && !better(fits[k], *best))) continue;
      best = &fits[k];
      known = &one;
    }
  }
  if (best == nullptr) return std::nullopt;
  of = best->name;
  return ModelChoice{name, name, known->settings(parameters_of(*best), h)};
}

std::vector<FiniteElementFit> solve_elements(const std::vector<std::string>& names,
                                             const std::vector<FitModel>& models,
                                             const std::vector<Fit>& fits, const FitData& data,
                                             const Weights& weights, const SeenAtRows& seen) {
  std::vector<FiniteElementFit> out;
  for (const std::string& name : names) {
    FiniteElementFit& e = out.emplace_back();
    e.name = name;
    const auto choice = finite_element_choice(name, models, fits, 1, e.of);
    if (!choice) {
      e.why = "no fitted model that it represents";
      continue;
    }
    e.constants = constants_text(choice->settings);
    RunFacts facts;
    facts.force = facts.height = 1;
    // The half plane's finite elements need the least depth one looks at.
    facts.depth = 0.1;
    try {
      const auto model = continuum::make_model(name, filled_settings(*choice, facts));
      const StressFunction stress = [&](const Eigen::MatrixXd& at) { return model->stress(at); };
      measure(data, weights, fit_of(fits, e.of), seen(stress, family_of(name) == "half plane"), e);
    } catch (const ComputationFailed& failure) {
      e.why = failure.what();
    }
  }
  return out;
}

const std::vector<std::string>& elements_header() {
  static const std::vector<std::string> header{"finite elements", "constants of", "constants",
                                               "misfit",          "relative L2",  "from that fit"};
  return header;
}

std::vector<std::vector<std::string>> element_rows(const std::vector<FiniteElementFit>& elements) {
  std::vector<std::vector<std::string>> rows;
  for (const FiniteElementFit& e : elements) {
    if (!e.why.empty()) {
      rows.push_back({e.name, e.of, e.why, "-", "-", "-"});
      continue;
    }
    rows.push_back({e.name, e.of, e.constants, number(e.chi2_per_dof),
                    fmt::format("{:.1f} %", 100 * e.rel_l2),
                    fmt::format("{:.2g} %", 100 * e.from_closed)});
  }
  return rows;
}

void add_elements(Summary& summary, const std::vector<FiniteElementFit>& elements) {
  for (const FiniteElementFit& e : elements) {
    const std::string prefix = "fe." + e.name + ".";
    summary[prefix + "constants_of"] = e.of;
    summary[prefix + "note"] = e.why;
    if (!e.why.empty()) continue;
    summary[prefix + "chi2_per_dof"] = e.chi2_per_dof;
    summary[prefix + "rel_l2"] = e.rel_l2;
    summary[prefix + "from_closed_form"] = e.from_closed;
  }
}

}  // namespace grainfield::coupling
