#include "coupling/fit/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

constexpr int kLeastRealizations = 3;

std::vector<Eigen::VectorXd> starts_of(const Fit& fit) {
  std::vector<Eigen::VectorXd> out{parameters_of(fit)};
  out.insert(out.end(), fit.other_minima.begin(), fit.other_minima.end());
  return out;
}

// Constants and slopes of all realizations but the one.
Eigen::MatrixXd of_realizations(const FitData& data, const Weights& weights, const FitModel& model,
                                const Fit& fit, double huber) {
  const int r = data.realizations();
  Eigen::MatrixXd out(data.values(), r);
  for (int left = 0; left < r; ++left) {
    std::vector<int> rest;
    for (int k = 0; k < r; ++k) {
      if (k != left) rest.push_back(k);
    }
    const FitModel own = model_of(model, rest);
    const Eigen::VectorXd mean = data.samples(Eigen::all, rest).rowwise().mean();
    out.col(left) =
        predict(data, own, best_parameters(data, mean, weights, own, starts_of(fit), huber));
  }
  return out;
}

// Constants of the mean at all heights but the value's own.
Eigen::VectorXd of_heights(const FitData& data, const FitModel& model, const Fit& fit,
                           double huber) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(data.values(), kNan);
  if (data.levels.size() < 2) return out;
  for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
    std::vector<int> in, there;
    for (int k = 0; k < data.values(); ++k) {
      (data.level[static_cast<std::size_t>(k)] == level ? there : in).push_back(k);
    }
    if (in.empty() || there.empty()) continue;
    const FitData rest = rows_of(data, in), at = rows_of(data, there);
    const Eigen::VectorXd constants =
        best_parameters(rest, rest.mean(), weights_of(rest), model, starts_of(fit), huber);
    out(there) = predict(at, model, constants);
  }
  return out;
}

// chi2 with the errors of the values, whose components at a point may be tied and count as one, + 2
// x the numbers that are free.
double akaike(const FitData& data, const Fit& fit) {
  double squares = 0;
  for (const double r : fit.residual) {
    if (std::isfinite(r)) squares += r * r;
  }
  const auto free = std::count_if(fit.parameters.begin(), fit.parameters.end(),
                                  [](const FittedParameter& p) { return std::isfinite(p.error); });
  return squares / static_cast<double>(data.tied()) + 2 * static_cast<double>(free);
}

// The model's entry before it is judged.
JudgedModel entry_of(const FitModel& model, const Fit& fit, const std::vector<Fit>& fits) {
  JudgedModel out;
  out.name = out.label = fit.name;
  out.equations = fit.equations;
  // A number that no value depends on, of a component that was not measured, is none.
  out.free = static_cast<int>(std::count_if(fit.parameters.begin(), fit.parameters.end(),
                                            [](const FittedParameter& p) { return p.determined; }));
  out.description = model.unbalanced;
  out.misfit = fit.chi2_per_dof;
  out.chance = fit.chance;
  out.values = fit.dof;
  out.rel_l2 = fit.rel_l2;
  for (const Fit& other : fits) {
    if (other.name != fit.name && contains(fit, other)) out.special_cases.push_back(other.name);
  }
  return out;
}

}  // namespace

bool contains(const Fit& general, const Fit& special) {
  if (general.name == special.name) return true;
  if (general.equations.empty() || general.kind.empty() || special.kind.empty()) return false;
  if (general.kind == special.kind) return general.parameters.size() >= special.parameters.size();
  // With both of its moduli's ratios free. The smooth base is no special case of the rough one.
  if (general.parameters.size() < 2) return false;
  return (general.kind == "orthotropic_half_plane" && special.kind == "flamant") ||
         (general.kind == "orthotropic_layer smooth" && special.kind == "layer smooth") ||
         (general.kind == "orthotropic_layer rough" && special.kind == "layer rough");
}

Judgement select(const FitData& data, const Weights& weights, const std::vector<FitModel>& models,
                 const std::vector<Fit>& fits, const SelectionOptions& options) {
  if (models.empty() || models.size() != fits.size()) {
    throw std::invalid_argument("selection: one fit per model, and at least one");
  }
  const int r = data.realizations();
  const bool left_out = weights.errors_from == ErrorsFrom::realizations && r >= kLeastRealizations;
  const auto working = [&](const Eigen::MatrixXd& values) -> Eigen::MatrixXd {
    return weights.weight.asDiagonal() * values;
  };
  Evidence evidence;
  evidence.samples = working(data.samples);
  evidence.error = weights.weight.cwiseProduct(weights.error);
  // The components of a point may be tied and count as one.
  evidence.tied = data.tied();
  evidence.errors_from = weights.errors_from;
  evidence.realizations = r;
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < models.size(); ++k) {
    Candidate& c = candidates.emplace_back();
    c.model = entry_of(models[k], fits[k], fits);
    c.forecast =
        working(left_out ? of_realizations(data, weights, models[k], fits[k], options.huber)
                         : Eigen::MatrixXd(fits[k].model));
    // A single field is no new one: what the constants took of its noise is added.
    c.taken = fits[k].expected - fits[k].misfit;
    if (weights.errors_from == ErrorsFrom::data) c.akaike = akaike(data, fits[k]);
    const bool judged = left_out || weights.errors_from == ErrorsFrom::data;
    if (judged && options.by_level && data.levels.size() > 1) {
      c.heights = working(of_heights(data, models[k], fits[k], options.huber));
    }
  }
  Judgement out = judge(evidence, std::move(candidates));
  out.equal = r > 1 && !weights.known();
  for (const JudgedModel& m : out.models) {
    const auto& f =
        *std::find_if(fits.begin(), fits.end(), [&](const Fit& fit) { return fit.name == m.name; });
    if (m.distinguishable == Answer::yes || f.turning_signs.empty()) continue;
    out.doubts.push_back(
        fmt::format("The sign of {} hangs on single realizations: {}. Take more realizations.",
                    f.name, fmt::join(f.turning_signs, "; ")));
  }
  return out;
}

}  // namespace grainfield::coupling
