#include "coupling/fit/fit.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/fit/intervals.h"
#include "coupling/statistics/agreement.h"
#include "coupling/statistics/bootstrap.h"

namespace grainfield::coupling {
namespace {

constexpr double kNearBound = 1e-3;  // of the allowed interval
constexpr double kRounding = 1e-12;  // of the largest value: an error below it is none

void add_note(Fit& out, const std::string& clause) {
  out.note += (out.note.empty() ? "" : "; ") + clause;
}

// A step of a constant for differences; no farther than half way to a bound.
double step_of(const FitParameter& p, double value) {
  const double h = 1e-6 * std::max(1.0, std::fabs(value));
  if (!std::isfinite(p.least) || !std::isfinite(p.most)) return h;
  return std::min({h, 0.5 * (value - p.least), 0.5 * (p.most - value)});
}

// Beside these constants there is no such model: the constant stands at a bound that is not stated.
bool ends_beside(const FitData& data, const FitModel& model, const Eigen::VectorXd& best,
                 Eigen::Index k) {
  const double h = step_of(model.parameters[static_cast<std::size_t>(k)], best[k]);
  for (const double step : {-h, h}) {
    Eigen::VectorXd there = best;
    there[k] += step;
    int outside = 0;
    predict(data, model, there, &outside);
    if (outside == data.values()) return true;
  }
  return false;
}

// d model / d parameters in working units; of the parameters in `of`.
Eigen::MatrixXd jacobian_at(const FitData& data, const Weights& weights, const FitModel& model,
                            const Eigen::VectorXd& parameters,
                            const std::vector<Eigen::Index>& of) {
  Eigen::MatrixXd out(data.values(), static_cast<Eigen::Index>(of.size()));
  for (std::size_t c = 0; c < of.size(); ++c) {
    const Eigen::Index k = of[c];
    const double h = step_of(model.parameters[static_cast<std::size_t>(k)], parameters[k]);
    Eigen::VectorXd more = parameters, less = parameters;
    more[k] += h;
    less[k] -= h;
    out.col(static_cast<Eigen::Index>(c)) =
        weights.weight.cwiseProduct(predict(data, model, more) - predict(data, model, less)) /
        (2 * h);
  }
  return out;
}

// The model at its best constants, straightened: mean - model moves by J (change of constants).
struct Straightened {
  std::vector<Eigen::Index> free;  // neither at a bound nor undetermined
  std::vector<bool> bound, determined;
  Eigen::MatrixXd jacobian;      // values x free, working units
  Eigen::MatrixXd to_constants;  // free x values: (J^T J)^-1 J^T

  // What of differences (values x any, working units) the constants do not follow.
  Eigen::MatrixXd left(const Eigen::MatrixXd& differences) const {
    if (free.empty()) return differences;
    return differences - jacobian * (to_constants * differences);
  }
};

Straightened straightened(const FitData& data, const Weights& weights, const FitModel& model,
                          const Eigen::VectorXd& best) {
  const Eigen::Index k = best.size();
  Straightened out;
  out.bound.assign(static_cast<std::size_t>(k), false);
  out.determined.assign(static_cast<std::size_t>(k), true);
  for (Eigen::Index p = 0; p < k; ++p) {
    const auto at = static_cast<std::size_t>(p);
    const FitParameter& q = model.parameters[at];
    const double room = kNearBound * (q.most - q.least);
    out.bound[at] =
        (std::isfinite(room) && (best[p] - q.least < room || q.most - best[p] < room)) ||
        ends_beside(data, model, best, p);
    // Those at a bound are held there: the others' errors are for it where it is. So are those
    // that no value depends on.
    if (out.bound[at]) continue;
    out.determined[at] = jacobian_at(data, weights, model, best, {p}).norm() > 0;
    if (out.determined[at]) out.free.push_back(p);
  }
  if (out.free.empty()) return out;
  const auto m = static_cast<Eigen::Index>(out.free.size());
  out.jacobian = jacobian_at(data, weights, model, best, out.free);
  const Eigen::VectorXd scale = out.jacobian.colwise().norm();
  const Eigen::MatrixXd scaled = out.jacobian * scale.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  if (qr.rank() < m) {
    for (const Eigen::Index p : out.free) out.determined[static_cast<std::size_t>(p)] = false;
    out.free.clear();
    out.jacobian.resize(data.values(), 0);
    return out;
  }
  out.to_constants = scale.cwiseInverse().asDiagonal() *
                     qr.solve(Eigen::MatrixXd::Identity(data.values(), data.values()));
  return out;
}

// Misfit against what the errors make of a true model, and the criterion.
void measure(const FitData& data, const Weights& weights, const Straightened& line,
             const Eigen::VectorXd& off, Fit& out) {
  const Eigen::VectorXd difference = weights.weight.cwiseProduct(off);
  out.misfit = out.expected = difference.squaredNorm();
  out.dof = data.values() - static_cast<double>(out.parameters.size());
  out.chi2_per_dof = out.chance = kNan;
  if (!weights.known()) return;
  Agreement found;
  double taken = 0;  // of the noise's squares, by the constants
  if (weights.errors_from == ErrorsFrom::realizations) {
    const Eigen::MatrixXd all =
        weights.weight.asDiagonal() * (data.samples.colwise() - data.mean());
    const Eigen::MatrixXd left = line.left(all);
    const double r = data.realizations();
    taken = (all - left).squaredNorm() / (r * (r - 1));
    found = agreement(difference, left);
  } else {
    const Eigen::VectorXd errors = weights.weight.cwiseProduct(weights.error);
    // The share of every value's error that is left, I - J (J^T J)^-1 J^T on its diagonal.
    Eigen::VectorXd share = Eigen::VectorXd::Ones(errors.size());
    if (!line.free.empty()) {
      share -= line.jacobian.cwiseProduct(line.to_constants.transpose()).rowwise().sum();
    }
    share = share.cwiseMax(0);
    taken = errors.cwiseAbs2().dot(Eigen::VectorXd::Ones(share.size()) - share);
    found = agreement(difference, errors.cwiseProduct(share.cwiseSqrt()), data.tied());
  }
  out.expected += 2 * taken;
  out.dof = found.values;
  out.chi2_per_dof = found.ratio;
  out.chance = found.chance;
}

// Covariance of all parameters, nan where there is none.
Eigen::MatrixXd sandwich(const FitData& data, const Weights& weights, const Straightened& line,
                         Eigen::Index k) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Constant(k, k, kNan);
  if (line.free.empty() || !weights.known()) return out;
  Eigen::MatrixXd own;
  if (weights.errors_from == ErrorsFrom::realizations) {
    const double r = data.realizations();
    const Eigen::MatrixXd each =
        line.to_constants * weights.weight.asDiagonal() * (data.samples.colwise() - data.mean());
    own = each * each.transpose() / (r * (r - 1));
  } else {
    // The components of a point may be tied: they count as one.
    const Eigen::MatrixXd each =
        line.to_constants * weights.weight.cwiseProduct(weights.error).asDiagonal();
    own = static_cast<double>(data.tied()) * each * each.transpose();
  }
  for (std::size_t a = 0; a < line.free.size(); ++a) {
    for (std::size_t b = 0; b < line.free.size(); ++b) {
      out(line.free[a], line.free[b]) =
          own(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    }
  }
  return out;
}

}  // namespace

Fit fit(const FitData& data, const Weights& weights, const FitModel& model,
        const FitOptions& options) {
  const Eigen::VectorXd mean = data.mean();
  const auto k = static_cast<Eigen::Index>(model.parameters.size());
  Fit out;
  out.name = model.name;
  out.label = model.label;
  out.equations = model.equations;
  out.kind = model.kind;
  std::vector<Eigen::VectorXd> ends;
  const Eigen::VectorXd best = best_parameters(data, mean, weights, model, model.starts,
                                               options.huber, &out.converged, &ends);
  int outside = 0;
  out.model = predict(data, model, best, &outside);
  if (outside == data.values()) {
    throw std::invalid_argument(fmt::format(
        "fit of {0}: found no constants with which the model has a stress at any of the points "
        "(slope too steep for it?); leave {0} out, or set constants, as {0}:NAME=VALUE. The "
        "largest "
        "value to fit is {1:.2g} (heaps: of rho g h; far below 1: other units?)",
        model.name, mean.cwiseAbs().maxCoeff()));
  }
  if (outside > 0) {
    add_note(out, fmt::format("{} values outside the model's domain count as 0", outside));
  }
  const Eigen::VectorXd off = mean - out.model;
  out.residual = off.cwiseQuotient(weights.error);
  out.rel_l2 = off.norm() / mean.norm();
  const Straightened line = straightened(data, weights, model, best);
  out.parameters.resize(static_cast<std::size_t>(k));
  measure(data, weights, line, off, out);

  const Eigen::MatrixXd spread = sandwich(data, weights, line, k);
  out.correlation = Eigen::MatrixXd::Constant(k, k, kNan);
  for (Eigen::Index a = 0; a < k; ++a) {
    for (Eigen::Index b = 0; b < k; ++b) {
      out.correlation(a, b) = spread(a, b) / std::sqrt(spread(a, a) * spread(b, b));
    }
  }
  const Eigen::VectorXd drawn = bootstrap_errors(data, weights, model, best, options);
  const std::vector<Eigen::VectorXd> others =
      distinct_ends(data, weights, model, ends, best, line.free, spread);
  const Eigen::VectorXd left_out = leave_out(data, weights, model, best, others, options, out);
  const double t = student(data.realizations(), options.level);
  for (Eigen::Index p = 0; p < k; ++p) {
    const auto at = static_cast<std::size_t>(p);
    FittedParameter& f = out.parameters[at];
    f.parameter = model.parameters[at];
    f.value = best[p];
    f.at_bound = line.bound[at];
    f.determined = line.determined[at];
    const bool free = f.determined && !f.at_bound;
    const auto kept = [&](double error) {
      return free && error > kRounding * std::max(1.0, std::fabs(best[p])) ? error : kNan;
    };
    f.covariance_error = kept(std::sqrt(spread(p, p)));
    f.bootstrap_error = kept(drawn[p]);
    f.jackknife_error = kept(left_out[p]);
    f.error = out.left_out.size() > 0 ? f.jackknife_error : f.covariance_error;
    const auto about = [&](double error) {
      return Interval{f.value - t * error, f.value + t * error};
    };
    f.by_covariance = about(f.covariance_error);
    f.by_bootstrap = about(f.bootstrap_error);
    f.by_jackknife = std::isfinite(f.jackknife_error) && std::isfinite(f.parameter.floor)
                         ? interval_above(f.parameter.floor, f.value, out.left_out.row(p), t)
                         : about(f.jackknife_error);
    if (free && options.profile && f.covariance_error > 0) {
      // (J^T J)^-1 of p: the misfit rises by 1 over that per unit squared.
      Eigen::Index row = 0;
      while (line.free[static_cast<std::size_t>(row)] != p) ++row;
      const double flat = line.to_constants.row(row).squaredNorm();
      const double error = f.covariance_error;
      f.by_profile =
          profile_interval(data, weights, model, best, p, t * t * error * error / flat, t * error);
    }
    const Interval quoted = out.left_out.size() > 0 ? f.by_jackknife : f.by_covariance;
    f.low = quoted.low;
    f.high = quoted.high;
    if (f.at_bound) add_note(out, f.parameter.name + " ends at its bound");
    if (!f.determined) add_note(out, "the values do not determine " + f.parameter.name);
    if (free && weights.known() && !std::isfinite(f.error)) {
      add_note(out, f.parameter.name + " is the same for all realizations: no error");
    }
  }
  for (const Eigen::VectorXd& other : others) add_other_minimum(data, weights, model, other, out);
  if (!out.converged) add_note(out, "the search did not converge");
  return out;
}

}  // namespace grainfield::coupling
