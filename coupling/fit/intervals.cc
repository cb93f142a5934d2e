#include "coupling/fit/intervals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "continuum/constants.h"
#include "coupling/statistics/bootstrap.h"
#include "coupling/statistics/parallel.h"

namespace grainfield::coupling {
namespace {

constexpr double kNoise = 2;  // standard errors of a difference of misfits

// The model with one parameter held.
FitModel held(const FitModel& model, Eigen::Index p, double value) {
  FitModel out = model;
  out.parameters.erase(out.parameters.begin() + p);
  out.stress = [stress = model.stress, p, value](const Eigen::MatrixXd& points,
                                                 const Eigen::VectorXd& others) {
    Eigen::VectorXd all(others.size() + 1);
    all << others.head(p), value, others.tail(others.size() - p);
    return stress(points, all);
  };
  return out;
}

double misfit_of(const FitData& data, const Weights& weights, const Eigen::VectorXd& values,
                 const FitModel& model, const Eigen::VectorXd& parameters) {
  return weights.weight.cwiseProduct(values - predict(data, model, parameters)).squaredNorm();
}

std::vector<int> all_but(int realizations, int left) {
  std::vector<int> out;
  for (int k = 0; k < realizations; ++k) {
    if (k != left) out.push_back(k);
  }
  return out;
}

Eigen::VectorXd mean_of(const FitData& data, const std::vector<int>& chosen) {
  return data.samples(Eigen::all, chosen).rowwise().mean();
}

// Squared differences of single realizations from one field less those from another are linear in
// the realization: standard error of their mean.
double error_of_difference(const FitData& data, const Weights& weights, const Eigen::VectorXd& one,
                           const Eigen::VectorXd& other) {
  const Eigen::VectorXd slope = 2 * weights.weight.cwiseAbs2().cwiseProduct(other - one);
  if (weights.errors_from == ErrorsFrom::data) {
    return std::sqrt(static_cast<double>(data.tied())) * slope.cwiseProduct(weights.error).norm();
  }
  const double r = data.realizations();
  const Eigen::VectorXd each = (data.samples.colwise() - data.mean()).transpose() * slope;
  return std::sqrt(each.squaredNorm() / (r * (r - 1)));
}

}  // namespace

double jackknife_error(const Eigen::VectorXd& left_out) {
  const auto r = static_cast<double>(left_out.size());
  return std::sqrt((left_out.array() - left_out.mean()).square().sum() * (r - 1) / r);
}

double student(int realizations, double level) {
  if (realizations < 2) return 1.96;
  return boost::math::quantile(boost::math::students_t(realizations - 1.0), 0.5 + 0.5 * level);
}

std::vector<Eigen::VectorXd> distinct_ends(const FitData& data, const Weights& weights,
                                           const FitModel& model,
                                           const std::vector<Eigen::VectorXd>& ends,
                                           const Eigen::VectorXd& best,
                                           const std::vector<Eigen::Index>& free,
                                           const Eigen::MatrixXd& spread) {
  std::vector<Eigen::VectorXd> out;
  if (!weights.known()) return out;
  const Eigen::VectorXd mean = data.mean(), here = predict(data, model, best);
  const double least = misfit_of(data, weights, mean, model, best);
  const auto differ = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return std::any_of(free.begin(), free.end(), [&](Eigen::Index p) {
      return std::fabs(a[p] - b[p]) > std::sqrt(spread(p, p));
    });
  };
  for (const Eigen::VectorXd& end : ends) {
    if (!differ(end, best)) continue;
    if (std::any_of(out.begin(), out.end(), [&](const auto& o) { return !differ(end, o); })) {
      continue;
    }
    const double behind = misfit_of(data, weights, mean, model, end) - least;
    const double noise = error_of_difference(data, weights, here, predict(data, model, end));
    if (behind < kNoise * noise) out.push_back(end);
  }
  return out;
}

Eigen::VectorXd leave_out(const FitData& data, const Weights& weights, const FitModel& model,
                          const Eigen::VectorXd& best, const std::vector<Eigen::VectorXd>& others,
                          const FitOptions& options, Fit& out) {
  const int r = data.realizations();
  const Eigen::Index k = best.size();
  if (!options.jackknife || r < 3 || k == 0 || !weights.known()) {
    return Eigen::VectorXd::Constant(k, kNan);
  }
  std::vector<Eigen::VectorXd> starts{best};
  starts.insert(starts.end(), others.begin(), others.end());
  out.left_out.resize(k, r);
  in_parts(r, options.threads, [&](int first, int last) {
    for (int left = first; left < last; ++left) {
      const std::vector<int> rest = all_but(r, left);
      out.left_out.col(left) = best_parameters(data, mean_of(data, rest), weights,
                                               model_of(model, rest), starts, options.huber);
    }
  });
  Eigen::VectorXd errors(k);
  for (Eigen::Index p = 0; p < k; ++p) {
    const Eigen::VectorXd row = out.left_out.row(p);
    errors[p] = jackknife_error(row);
    Eigen::Index other = -1;
    for (Eigen::Index left = 0; left < r; ++left) {
      if (row[left] * best[p] < 0) other = left;
    }
    if (other < 0) continue;
    out.turning_signs.push_back(fmt::format("{} is {:+.3g}, without realization {} {:+.3g}",
                                            model.parameters[static_cast<std::size_t>(p)].name,
                                            best[p], other + 1, row[other]));
  }
  return errors;
}

Interval interval_above(double floor, double value, const Eigen::VectorXd& left_out, double t) {
  const double error = jackknife_error((left_out.array() - floor).log().matrix());
  const double wide = std::exp(t * error);
  return {floor + (value - floor) / wide, floor + (value - floor) * wide};
}

Eigen::VectorXd bootstrap_errors(const FitData& data, const Weights& weights, const FitModel& model,
                                 const Eigen::VectorXd& best, const FitOptions& options) {
  const Eigen::Index k = best.size();
  const double r = data.realizations();
  Eigen::VectorXd out = Eigen::VectorXd::Constant(k, kNan);
  if (k == 0 || options.bootstrap < 10 || r < 3 || !weights.known()) return out;
  BootstrapOptions draws;
  draws.resamples = options.bootstrap;
  draws.seed = options.seed;
  draws.threads = options.threads;
  const Eigen::MatrixXd all = bootstrap_draws(
      data.realizations(),
      [&](const std::vector<int>& chosen) {
        return best_parameters(data, mean_of(data, chosen), weights, model_of(model, chosen),
                               {best}, options.huber);
      },
      draws);
  for (Eigen::Index p = 0; p < k; ++p) {
    const Eigen::VectorXd column = all.col(p);
    out[p] = std::sqrt(r / (r - 1) * (column.array() - column.mean()).square().sum() /
                       static_cast<double>(column.size() - 1));
  }
  return out;
}

Interval profile_interval(const FitData& data, const Weights& weights, const FitModel& model,
                          const Eigen::VectorXd& best, Eigen::Index p, double rise, double reach) {
  Interval out;
  if (!(reach > 0)) return out;
  const Eigen::VectorXd mean = data.mean();
  const double least = misfit_of(data, weights, mean, model, best);
  const FitParameter& parameter = model.parameters[static_cast<std::size_t>(p)];
  const auto side = [&](double direction) {
    Eigen::VectorXd start(best.size() - 1);
    start << best.head(p), best.tail(best.size() - 1 - p);
    const auto above = [&](double value) {
      const FitModel m = held(model, p, value);
      const Eigen::VectorXd others = best_parameters(data, mean, weights, m, {start}, 0);
      const double misfit = misfit_of(data, weights, mean, m, others);
      if (misfit - least < rise) start = others;  // the next search begins where this one ended
      return misfit - least >= rise;
    };
    const double bound = direction < 0 ? parameter.least : parameter.most;
    double inside = best[p], step = reach;
    for (int tries = 0; tries < 6; ++tries, step *= 2) {
      double outside = inside + direction * step;
      const bool beyond = std::isfinite(bound) && (outside - bound) * direction >= 0;
      if (beyond) outside = bound - direction * 1e-9 * (parameter.most - parameter.least);
      if (!above(outside)) {
        if (beyond) return bound;
        inside = outside;
        continue;
      }
      while (std::fabs(outside - inside) > 0.02 * reach) {
        const double middle = 0.5 * (inside + outside);
        (above(middle) ? outside : inside) = middle;
      }
      return 0.5 * (inside + outside);
    }
    return direction * std::numeric_limits<double>::infinity();
  };
  out.low = side(-1);
  out.high = side(1);
  return out;
}

void add_other_minimum(const FitData& data, const Weights& weights, const FitModel& model,
                       const Eigen::VectorXd& other, Fit& out) {
  out.other_minima.push_back(other);
  std::vector<std::string> constants;
  for (Eigen::Index p = 0; p < other.size(); ++p) {
    constants.push_back(
        fmt::format("{} = {:.3g}", model.parameters[static_cast<std::size_t>(p)].name, other[p]));
  }
  const double misfit = misfit_of(data, weights, data.mean(), model, other);
  out.note += fmt::format("{}as likely within the noise: {} (misfit higher by {:.2g} %)",
                          out.note.empty() ? "" : "; ", fmt::join(constants, ", "),
                          100 * (misfit / out.misfit - 1));
}

}  // namespace grainfield::coupling
