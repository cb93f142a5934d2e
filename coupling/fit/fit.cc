#include "coupling/fit/fit.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unsupported/Eigen/NonLinearOptimization>

#include "continuum/constants.h"
#include "coupling/fit/intervals.h"
#include "coupling/statistics/bootstrap.h"

namespace grainfield::coupling {
namespace {

constexpr int kMostEvaluations = 4000;
constexpr int kHuberRounds = 8;
constexpr double kNearBound = 1e-4;  // of the allowed interval
constexpr double kChance = 1.35e-3;  // of a true model: three standard deviations, one-sided

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
          std::clamp((outer[k] - p.least) / (p.most - p.least), kNearBound, 1 - kNearBound);
      in[k] = std::log(share / (1 - share));
    }
    return in;
  }
};

// What MINPACK minimises: whitened residuals, by central differences.
struct Residuals {
  const FitData& data;
  const Eigen::VectorXd& target;
  const Eigen::MatrixXd& whitener;
  const FitModel& model;
  Bounds bounds;
  Eigen::VectorXd weights;  // square roots, of the whitened residuals

  Eigen::VectorXd plain(const Eigen::VectorXd& inner) const {
    return whitener * (target - predict(data, model, bounds.outer(inner)));
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
  int values() const { return static_cast<int>(whitener.rows()); }
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

double most_by_chance(double dof, double freedom) {
  if (!std::isfinite(freedom)) {
    return boost::math::quantile(complement(boost::math::chi_squared(dof), kChance)) / dof;
  }
  return boost::math::quantile(complement(boost::math::fisher_f(dof, freedom), kChance));
}

Eigen::VectorXd huber_weights(const Eigen::VectorXd& r, double limit) {
  return r.unaryExpr([limit](double v) {
    const double size = std::fabs(v);
    return size <= limit ? 1.0 : std::sqrt(limit / size);
  });
}

// d model / d parameters, whitened; of the parameters in `of`.
Eigen::MatrixXd jacobian_at(const FitData& data, const Eigen::MatrixXd& whitener,
                            const FitModel& model, const Eigen::VectorXd& parameters,
                            const std::vector<Eigen::Index>& of) {
  Eigen::MatrixXd out(whitener.rows(), static_cast<Eigen::Index>(of.size()));
  for (std::size_t c = 0; c < of.size(); ++c) {
    const Eigen::Index k = of[c];
    const FitParameter& p = model.parameters[static_cast<std::size_t>(k)];
    double h = 1e-6 * std::max(1.0, std::fabs(parameters[k]));
    if (std::isfinite(p.least) && std::isfinite(p.most)) {
      h = std::min({h, 0.5 * (parameters[k] - p.least), 0.5 * (p.most - parameters[k])});
    }
    Eigen::VectorXd more = parameters, less = parameters;
    more[k] += h;
    less[k] -= h;
    out.col(static_cast<Eigen::Index>(c)) =
        whitener * (predict(data, model, more) - predict(data, model, less)) / (2 * h);
  }
  return out;
}

}  // namespace

bool better(const Fit& a, const Fit& b) {
  if (std::isnan(a.aicc) || std::isnan(b.aicc)) return a.rel_l2 < b.rel_l2;
  return a.aicc < b.aicc;
}

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
                                const Eigen::MatrixXd& whitener, const FitModel& model,
                                const std::vector<Eigen::VectorXd>& starts, double huber,
                                bool* converged, std::vector<Eigen::VectorXd>* ends) {
  if (starts.empty()) {
    throw std::invalid_argument(fmt::format("fit of {}: no start of the search", model.name));
  }
  if (converged != nullptr) *converged = true;
  if (model.parameters.empty()) return Eigen::VectorXd(0);
  const Bounds bounds{model};
  Residuals residuals{data,  values, whitener,
                      model, bounds, Eigen::VectorXd::Ones(whitener.rows())};
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best = bounds.inner(starts.front());
  bool best_converged = false;
  for (const Eigen::VectorXd& start : starts) {
    Eigen::VectorXd inner = bounds.inner(start);
    bool good = false;
    const double chi2 = minimise(residuals, inner, good);
    if (ends != nullptr && good) ends->push_back(bounds.outer(inner));
    if (chi2 < least) {
      least = chi2;
      best = inner;
      best_converged = good;
    }
  }
  for (int round = 0; huber > 0 && round < kHuberRounds; ++round) {
    residuals.weights = huber_weights(residuals.plain(best), huber);
    minimise(residuals, best, best_converged);
  }
  if (converged != nullptr) *converged = best_converged;
  return bounds.outer(best);
}

Fit fit(const FitData& data, const Covariance& covariance, const FitModel& model,
        const FitOptions& options) {
  const Eigen::VectorXd mean = data.mean();
  const auto k = static_cast<Eigen::Index>(model.parameters.size());
  Fit out;
  out.name = model.name;
  out.label = model.label;
  const std::vector<Eigen::VectorXd> starts = model.starts.empty() && k == 0
                                                  ? std::vector<Eigen::VectorXd>{Eigen::VectorXd(0)}
                                                  : model.starts;
  std::vector<Eigen::VectorXd> ends;
  const Eigen::VectorXd best = best_parameters(data, mean, covariance.whitener, model, starts,
                                               options.huber, &out.converged, &ends);
  int outside = 0;
  out.model = predict(data, model, best, &outside);
  if (outside == data.values()) {
    throw std::invalid_argument(fmt::format(
        "fit of {}: the best constants leave every point outside the model's domain, where it "
        "counts "
        "as 0; the largest value to fit is {:.2g} (heaps: of rho g h; far below 1: other units?)",
        model.name, mean.cwiseAbs().maxCoeff()));
  }
  const Eigen::VectorXd off = mean - out.model;
  out.residual = off.cwiseQuotient(covariance.of_mean.diagonal().cwiseSqrt());
  out.chi2 = (covariance.whitener * off).squaredNorm();
  const double n = covariance.kind == "diagonal" ? covariance.effective_values : data.values();
  out.dof = n - static_cast<double>(k);
  const bool known = covariance.kind != "unknown";
  const bool tested = known && out.dof > 0;
  out.chi2_per_dof = tested ? out.chi2 / out.dof : kNan;
  out.chance = tested ? most_by_chance(out.dof, covariance.freedom) : kNan;
  const double kk = static_cast<double>(k), left = n - kk - 1;
  out.aicc = !known     ? kNan
             : left > 0 ? out.chi2 + 2 * kk + 2 * kk * (kk + 1) / left
                        : std::numeric_limits<double>::infinity();
  out.rel_l2 = off.norm() / mean.norm();
  if (outside > 0)
    out.note = fmt::format("{} values outside the model's domain count as 0", outside);

  Eigen::MatrixXd spread = Eigen::MatrixXd::Constant(k, k, kNan);
  std::vector<bool> bound(static_cast<std::size_t>(k), false);
  for (Eigen::Index p = 0; p < k; ++p) {
    const FitParameter& q = model.parameters[static_cast<std::size_t>(p)];
    const double room = kNearBound * 10 * (q.most - q.least);
    bound[static_cast<std::size_t>(p)] =
        std::isfinite(room) && (best[p] - q.least < room || q.most - best[p] < room);
  }
  // Those at a bound are held there: the others' errors are for it where it is. So are those that
  // no value depends on.
  std::vector<Eigen::Index> inside;
  std::vector<bool> determined(static_cast<std::size_t>(k), true);
  for (Eigen::Index p = 0; p < k; ++p) {
    if (bound[static_cast<std::size_t>(p)]) continue;
    determined[static_cast<std::size_t>(p)] =
        jacobian_at(data, covariance.whitener, model, best, {p}).norm() > 0;
    if (determined[static_cast<std::size_t>(p)]) inside.push_back(p);
  }
  if (!inside.empty()) {
    const auto m = static_cast<Eigen::Index>(inside.size());
    const Eigen::MatrixXd jacobian = jacobian_at(data, covariance.whitener, model, best, inside);
    const Eigen::VectorXd scale = jacobian.colwise().norm();
    const Eigen::MatrixXd scaled = jacobian * scale.cwiseInverse().asDiagonal();
    if (Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(scaled).rank() < m) {
      for (const Eigen::Index p : inside) determined[static_cast<std::size_t>(p)] = false;
    } else if (known) {
      const Eigen::MatrixXd own =
          scale.cwiseInverse().asDiagonal() *
          (scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(m, m)) *
          scale.cwiseInverse().asDiagonal();
      for (Eigen::Index a = 0; a < m; ++a) {
        for (Eigen::Index b = 0; b < m; ++b) {
          spread(inside[static_cast<std::size_t>(a)], inside[static_cast<std::size_t>(b)]) =
              own(a, b);
        }
      }
    }
  }
  for (Eigen::Index p = 0; p < k; ++p) {
    if (determined[static_cast<std::size_t>(p)]) continue;
    out.note += fmt::format("{}the values do not determine {}", out.note.empty() ? "" : "; ",
                            model.parameters[static_cast<std::size_t>(p)].name);
  }
  out.correlation = Eigen::MatrixXd::Constant(k, k, kNan);
  for (Eigen::Index a = 0; a < k; ++a) {
    for (Eigen::Index b = 0; b < k; ++b) {
      out.correlation(a, b) = spread(a, b) / std::sqrt(spread(a, a) * spread(b, b));
    }
  }
  Eigen::VectorXd drawn = Eigen::VectorXd::Constant(k, kNan);
  if (k > 0 && options.bootstrap >= 10 && data.realizations() >= 3) {
    BootstrapOptions draws;
    draws.resamples = options.bootstrap;
    draws.seed = options.seed;
    draws.threads = options.threads;
    const Eigen::MatrixXd all = bootstrap_draws(
        data.realizations(),
        [&](const std::vector<int>& chosen) {
          Eigen::VectorXd values = Eigen::VectorXd::Zero(data.values());
          for (const int r : chosen) values += data.samples.col(r);
          values /= static_cast<double>(chosen.size());
          return best_parameters(data, values, covariance.whitener, model, {best}, options.huber);
        },
        draws);
    const double bias = std::sqrt(data.realizations() / (data.realizations() - 1.0));
    for (Eigen::Index p = 0; p < k; ++p) {
      const Eigen::VectorXd column = all.col(p);
      drawn[p] = bias * std::sqrt((column.array() - column.mean()).square().sum() /
                                  static_cast<double>(column.size() - 1));
    }
  }
  const Eigen::VectorXd left_out_errors = leave_out(data, covariance, model, best, options, out);
  const double t = student(data.realizations(), options.level);
  for (Eigen::Index p = 0; p < k; ++p) {
    FittedParameter f;
    f.parameter = model.parameters[static_cast<std::size_t>(p)];
    f.value = best[p];
    f.at_bound = bound[static_cast<std::size_t>(p)];
    f.determined = determined[static_cast<std::size_t>(p)];
    const bool free = f.determined && !f.at_bound;
    f.covariance_error = f.at_bound ? kNan : std::sqrt(spread(p, p));
    f.bootstrap_error = free ? drawn[p] : kNan;
    f.jackknife_error = free ? left_out_errors[p] : kNan;
    f.error = std::isfinite(f.jackknife_error) ? f.jackknife_error : f.covariance_error;
    const auto about = [&](double error) {
      return Interval{f.value - t * error, f.value + t * error};
    };
    f.by_covariance = about(f.covariance_error);
    f.by_bootstrap = about(f.bootstrap_error);
    f.by_jackknife = about(f.jackknife_error);
    if (free && known && options.profile) {
      f.by_profile = profile_interval(data, covariance, model, best, p, t * t, f.covariance_error);
    }
    f.low = about(f.error).low;
    f.high = about(f.error).high;
    if (f.at_bound) {
      out.note +=
          fmt::format("{}{} ends at its bound", out.note.empty() ? "" : "; ", f.parameter.name);
    }
    out.parameters.push_back(f);
  }
  add_other_minima(data, covariance, model, ends, best, t, out);
  if (!out.converged) {
    out.note += fmt::format("{}the search did not converge", out.note.empty() ? "" : "; ");
  }
  return out;
}

}  // namespace grainfield::coupling
