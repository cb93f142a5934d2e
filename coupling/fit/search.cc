// The search for the best constants.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unsupported/Eigen/NonLinearOptimization>

#include "coupling/fit/fit.h"

namespace grainfield::coupling {
namespace {

constexpr int kMostEvaluations = 4000;
constexpr int kHuberRounds = 8;
constexpr double kOffBound = 1e-4;  // of the allowed interval

// Between the bounds by the logistic function, beyond them never.
struct Bounds {
  const FitModel& model;

  bool bounded(Eigen::Index k) const {
    const FitParameter& p = model.parameters[static_cast<std::size_t>(k)];
    return std::isfinite(p.least) && std::isfinite(p.most);
  }
  Eigen::VectorXd outer(const Eigen::VectorXd& inner) const {
    Eigen::VectorXd out = inner;
    for (Eigen::Index k = 0; k < inner.size(); ++k) {
      const FitParameter& p = model.parameters[static_cast<std::size_t>(k)];
      if (bounded(k)) out[k] = p.least + (p.most - p.least) / (1 + std::exp(-inner[k]));
    }
    return out;
  }
  Eigen::VectorXd inner(const Eigen::VectorXd& outer) const {
    Eigen::VectorXd in = outer;
    for (Eigen::Index k = 0; k < outer.size(); ++k) {
      const FitParameter& p = model.parameters[static_cast<std::size_t>(k)];
      if (!bounded(k)) continue;
      const double share =
          std::clamp((outer[k] - p.least) / (p.most - p.least), kOffBound, 1 - kNearBound);
      in[k] = std::log(share / (1 - share));
    }
    return in;
  }
};

// What MINPACK minimises: residuals in working units, by central differences.
struct Residuals {
  const FitData& data;
  const Eigen::VectorXd& target;
  const FitModel& model;
  Bounds bounds;
  Eigen::VectorXd weights;

  Eigen::VectorXd plain(const Eigen::VectorXd& inner) const {
    return target - predict(data, model, bounds.outer(inner));
  }
  int operator()(const Eigen::VectorXd& inner, Eigen::VectorXd& out) const {
    out = weights.cwiseProduct(plain(inner));
    return 0;
  }
  int df(const Eigen::VectorXd& inner, Eigen::MatrixXd& jacobian) const {
    for (Eigen::Index k = 0; k < inner.size(); ++k) {
      const double h = 1e-6 * std::max(1.0, std::fabs(inner[k]));
      Eigen::VectorXd more = inner, less = inner;
      more[k] += h;
      less[k] -= h;
      jacobian.col(k) = weights.cwiseProduct(plain(more) - plain(less)) / (2 * h);
    }
    return 0;
  }
  int inputs() const { return static_cast<int>(model.parameters.size()); }
  int values() const { return static_cast<int>(weights.size()); }
};

double minimise(Residuals& residuals, Eigen::VectorXd& inner, bool& converged) {
  Eigen::LevenbergMarquardt<Residuals> solver(residuals);
  solver.parameters.maxfev = kMostEvaluations;
  solver.parameters.xtol = solver.parameters.ftol = 1e-12;
  const auto status = solver.minimize(inner);
  converged = status > 0 && status != Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation;
  Eigen::VectorXd r;
  residuals(inner, r);
  return r.squaredNorm();
}

// Square roots of Huber's weights of residuals beyond `limits`.
Eigen::VectorXd huber_weights(const Eigen::VectorXd& residuals, const Eigen::VectorXd& limits) {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(residuals.size());
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    const double size = std::fabs(residuals[k]);
    if (size > limits[k]) out[k] = std::sqrt(limits[k] / size);
  }
  return out;
}

}  // namespace

Eigen::VectorXd predict(const FitData& data, const FitModel& model,
                        const Eigen::VectorXd& parameters, int* outside) {
  const Eigen::MatrixXd stress = model.stress(data.points, parameters);
  Eigen::VectorXd out(data.values());
  int missing = 0;
  for (int k = 0; k < data.values(); ++k) {
    const std::string& name =
        data.components[static_cast<std::size_t>(data.component[static_cast<std::size_t>(k)])];
    const double v = stress(k, name == "sigma_xx" ? 0 : name == "sigma_yy" ? 1 : 2);
    missing += std::isfinite(v) ? 0 : 1;
    out[k] = std::isfinite(v) ? v : 0;
  }
  if (outside != nullptr) *outside = missing;
  return out;
}

Eigen::VectorXd best_parameters(const FitData& data, const Eigen::VectorXd& values,
                                const Weights& weights, const FitModel& model,
                                const std::vector<Eigen::VectorXd>& starts, double huber,
                                bool* converged, std::vector<Eigen::VectorXd>* ends) {
  if (starts.empty()) {
    throw std::invalid_argument(fmt::format("fit of {}: no start of the search", model.name));
  }
  if (converged != nullptr) *converged = true;
  if (model.parameters.empty()) return Eigen::VectorXd(0);
  const Bounds bounds{model};
  Residuals residuals{data, values, model, bounds, weights.weight};
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best = bounds.inner(starts.front());
  bool best_converged = false, best_answers = false;
  for (const Eigen::VectorXd& start : starts) {
    Eigen::VectorXd inner = bounds.inner(start);
    bool good = false;
    const double misfit = minimise(residuals, inner, good);
    if (ends != nullptr && good) ends->push_back(bounds.outer(inner));
    // Where no value is inside, 0 everywhere is no answer of the model, however near it is.
    int outside = 0;
    predict(data, model, bounds.outer(inner), &outside);
    const bool answers = outside < data.values();
    if ((answers && !best_answers) || (answers == best_answers && misfit < least)) {
      least = misfit;
      best = inner;
      best_converged = good;
      best_answers = answers;
    }
  }
  for (int round = 0; huber > 0 && weights.known() && round < kHuberRounds; ++round) {
    residuals.weights =
        weights.weight.cwiseProduct(huber_weights(residuals.plain(best), huber * weights.error));
    minimise(residuals, best, best_converged);
  }
  if (converged != nullptr) *converged = best_converged;
  return bounds.outer(best);
}

Eigen::VectorXd parameters_of(const Fit& fit) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(fit.parameters.size()));
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    out[static_cast<Eigen::Index>(k)] = fit.parameters[k].value;
  }
  return out;
}

}  // namespace grainfield::coupling
