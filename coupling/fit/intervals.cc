#include "coupling/fit/intervals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "continuum/constants.h"
#include "coupling/statistics/parallel.h"

namespace grainfield::coupling {
namespace {

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

}  // namespace

double student(int realizations, double level) {
  if (realizations < 2) return 1.96;
  return boost::math::quantile(boost::math::students_t(realizations - 1.0), 0.5 + 0.5 * level);
}

Eigen::VectorXd leave_out(const FitData& data, const Covariance& covariance, const FitModel& model,
                          const Eigen::VectorXd& best, const FitOptions& options, Fit& out) {
  const int r = data.realizations();
  const Eigen::Index k = best.size();
  if (!options.jackknife || r < 3 || k == 0) return Eigen::VectorXd::Constant(k, kNan);
  std::vector<Eigen::VectorXd> starts = model.starts;
  starts.push_back(best);
  out.left_out.resize(k, r);
  in_parts(r, options.threads, [&](int first, int last) {
    for (int left = first; left < last; ++left) {
      FitData others = data;
      others.samples.resize(data.values(), r - 1);
      others.samples << data.samples.leftCols(left), data.samples.rightCols(r - 1 - left);
      const bool known = covariance.kind != "unknown";
      const Covariance own = covariance_of(others, known ? covariance.kind : "auto");
      out.left_out.col(left) =
          best_parameters(others, others.mean(), own.whitener, model, starts, options.huber);
    }
  });
  Eigen::VectorXd errors(k);
  for (Eigen::Index p = 0; p < k; ++p) {
    const Eigen::VectorXd row = out.left_out.row(p);
    errors[p] = std::sqrt((row.array() - row.mean()).square().sum() * (r - 1) / r);
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

Interval profile_interval(const FitData& data, const Covariance& covariance, const FitModel& model,
                          const Eigen::VectorXd& best, Eigen::Index p, double rise, double error) {
  Interval out;
  if (!(error > 0)) return out;
  const Eigen::VectorXd mean = data.mean();
  const double least = (covariance.whitener * (mean - predict(data, model, best))).squaredNorm();
  const FitParameter& parameter = model.parameters[static_cast<std::size_t>(p)];
  const auto side = [&](double direction) {
    Eigen::VectorXd start(best.size() - 1);
    start << best.head(p), best.tail(best.size() - 1 - p);
    const auto above = [&](double value) {
      const FitModel m = held(model, p, value);
      const Eigen::VectorXd others =
          best_parameters(data, mean, covariance.whitener, m, {start}, 0);
      const double chi2 = (covariance.whitener * (mean - predict(data, m, others))).squaredNorm();
      if (chi2 - least < rise) start = others;  // the next search begins where this one ended
      return chi2 - least >= rise;
    };
    const double bound = direction < 0 ? parameter.least : parameter.most;
    double inside = best[p], step = std::sqrt(rise) * error;
    for (int tries = 0; tries < 6; ++tries, step *= 2) {
      double outside = inside + direction * step;
      const bool beyond = std::isfinite(bound) && (outside - bound) * direction >= 0;
      if (beyond) outside = bound - direction * 1e-9 * (parameter.most - parameter.least);
      if (!above(outside)) {
        if (beyond) return bound;
        inside = outside;
        continue;
      }
      while (std::fabs(outside - inside) > 0.01 * error) {
        const double middle = 0.5 * (inside + outside);
        (above(middle) ? outside : inside) = middle;
      }
      return inside;
    }
    return direction * std::numeric_limits<double>::infinity();
  };
  out.low = side(-1);
  out.high = side(1);
  return out;
}

void add_other_minima(const FitData& data, const Covariance& covariance, const FitModel& model,
                      const std::vector<Eigen::VectorXd>& ends, const Eigen::VectorXd& best,
                      double t, Fit& out) {
  if (covariance.kind == "unknown") return;
  const Eigen::VectorXd mean = data.mean();
  for (const Eigen::VectorXd& end : ends) {
    const double chi2 = (covariance.whitener * (mean - predict(data, model, end))).squaredNorm();
    if (!(chi2 - out.chi2 < t * t)) continue;
    const auto differs = [&](const Eigen::VectorXd& from) {
      for (Eigen::Index p = 0; p < best.size(); ++p) {
        const FittedParameter& f = out.parameters[static_cast<std::size_t>(p)];
        if (f.error > 0 && std::fabs(end[p] - from[p]) > f.error) return true;
      }
      return false;
    };
    bool other = differs(best);
    for (const Eigen::VectorXd& known : out.other_minima) other = other && differs(known);
    if (!other) continue;
    out.other_minima.push_back(end);
    std::vector<std::string> constants;
    for (Eigen::Index p = 0; p < end.size(); ++p) {
      constants.push_back(
          fmt::format("{} = {:.3g}", model.parameters[static_cast<std::size_t>(p)].name, end[p]));
    }
    out.note +=
        fmt::format("{}as likely within the noise: {} (chi2 higher by {:.2g})",
                    out.note.empty() ? "" : "; ", fmt::join(constants, ", "), chi2 - out.chi2);
  }
}

}  // namespace grainfield::coupling
