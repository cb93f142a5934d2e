#include "coupling/fit/derived.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "continuum/closed/osl.h"
#include "continuum/constants.h"
#include "coupling/fit/intervals.h"

namespace grainfield::coupling {
namespace {

bool has(const Fit& fit, const std::string& name) {
  return std::any_of(fit.parameters.begin(), fit.parameters.end(),
                     [&](const FittedParameter& p) { return p.parameter.name == name; });
}

// Over the realizations left out; nan without.
double jackknife(const Fit& fit, const std::function<double(const Eigen::VectorXd&)>& of) {
  const Eigen::Index r = fit.left_out.cols();
  if (r < 3) return kNan;
  Eigen::VectorXd values(r);
  for (Eigen::Index k = 0; k < r; ++k) values[k] = of(fit.left_out.col(k));
  return jackknife_error(values);
}

FittedParameter derived(const std::string& name, const std::string& unit, const Fit& fit,
                        const std::function<double(const Eigen::VectorXd&)>& of) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::VectorXd at(n), gradient(n), error(n), drawn(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const FittedParameter& p = fit.parameters[static_cast<std::size_t>(k)];
    at[k] = p.value;
    error[k] = p.covariance_error;
    drawn[k] = p.bootstrap_error;
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const double h = 1e-6 * std::max(1.0, std::fabs(at[k]));
    Eigen::VectorXd more = at, less = at;
    more[k] += h;
    less[k] -= h;
    gradient[k] = (of(more) - of(less)) / (2 * h);
  }
  const auto spread = [&](const Eigen::VectorXd& errors) {
    if (!errors.allFinite() || !fit.correlation.allFinite()) return kNan;
    const Eigen::VectorXd part = gradient.cwiseProduct(errors);
    return std::sqrt(std::max(0.0, part.dot(fit.correlation * part)));
  };
  FittedParameter out;
  out.parameter.name = name;
  out.parameter.unit = unit;
  out.value = of(at);
  out.covariance_error = spread(error);
  out.jackknife_error = jackknife(fit, of);
  out.error = std::isfinite(out.jackknife_error) ? out.jackknife_error : out.covariance_error;
  out.bootstrap_error = error.allFinite() ? spread(drawn) : kNan;
  out.low = out.high = kNan;
  return out;
}

}  // namespace

std::vector<FittedParameter> derived_figures(const Fit& fit, double slope_deg) {
  const double phi = slope_deg * kDegree;
  if (has(fit, "a_yy") && fit.parameters.size() == 7) {
    const double t = std::tan(phi);
    return {derived("flank_balance_x", "-", fit,
                    [t](const Eigen::VectorXd& p) { return p[5] - p[3] * t; }),
            derived("flank_balance_y", "-", fit,
                    [t](const Eigen::VectorXd& p) { return p[4] - 1 - p[5] * t; })};
  }
  const bool both = fit.parameters.size() == 2 && has(fit, "eta") && has(fit, "mu");
  if (!both && fit.name != "osl_yield") return {};
  const auto closure = [phi, both](const Eigen::VectorXd& p) {
    if (both) return continuum::Closure{p[0], p[1]};
    return continuum::Closure{continuum::eta_at_yield(phi, p[0]), p[0]};
  };
  std::vector<FittedParameter> out{
      derived("K", "-", fit,
              [&](const Eigen::VectorXd& p) { return continuum::ratio_of(closure(p)).K; }),
      derived("tau_deg", "deg", fit, [&](const Eigen::VectorXd& p) {
        return continuum::ratio_of(closure(p)).tau / kDegree;
      })};
  if (!both) {
    out.push_back(
        derived("eta", "-", fit, [&](const Eigen::VectorXd& p) { return closure(p).eta; }));
  }
  return out;
}

}  // namespace grainfield::coupling
