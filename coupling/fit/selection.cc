#include "coupling/fit/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
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

// What every realization is held against by one judge: the model's values, values x realizations.
using Forecast = Eigen::MatrixXd;

// Constants and slopes of all realizations but the one.
Forecast of_realizations(const FitData& data, const Weights& weights, const FitModel& model,
                         const Fit& fit, double huber) {
  const int r = data.realizations();
  Forecast out(data.values(), r);
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

// Mean and standard error of the paired difference of squares of two forecasts.
struct Difference {
  double mean = kNan, error = kNan;
};

Difference paired(const FitData& data, const Weights& weights, const Forecast& one,
                  const Forecast& best) {
  Difference out;
  const double r = data.realizations();
  const auto squares = [&](const Forecast& f) -> Eigen::VectorXd {
    return (weights.weight.asDiagonal() * (data.samples - f)).colwise().squaredNorm();
  };
  const Eigen::VectorXd behind = squares(one) - squares(best);
  out.mean = behind.mean();
  if (weights.errors_from == ErrorsFrom::data) {
    // Linear in the values; the components of a point may be tied and count as one.
    const Eigen::VectorXd slope = 2 * weights.weight.cwiseAbs2().cwiseProduct((best - one).col(0));
    out.error =
        std::sqrt(static_cast<double>(data.tied())) * slope.cwiseProduct(weights.error).norm();
  } else if (r >= kLeastRealizations) {
    out.error = std::sqrt((behind.array() - out.mean).square().sum() / (r - 1) / r);
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

// How many have judged.
std::string judges(int count) {
  return count == 1 ? "one field with errors" : fmt::format("{} realizations", count);
}

// What the best fit says against it, or against every model where all disagree; empty: nothing.
std::string doubt(const Fit& best, const std::vector<Fit>& fits, ErrorsFrom errors_from) {
  if (!disagrees(best)) return "";
  const bool all = std::all_of(fits.begin(), fits.end(), disagrees);
  return fmt::format(
      " {} within the errors: {} misses by {:.3g} times what the {} "
      "explains, where up to {:.3g} would be chance (relative L2 {:.1f} %).",
      all ? "No model agrees" : best.name + " does not agree", all ? "the nearest" : "it",
      best.chi2_per_dof, errors_from == ErrorsFrom::data ? "error" : "spread", best.chance,
      100 * best.rel_l2);
}

}  // namespace

double least_errors(int realizations) {
  if (realizations == 1) return 1.96;
  if (realizations < kLeastRealizations) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::students_t(realizations - 1.0), 0.975);
}

bool disagrees(const Fit& fit) { return fit.chi2_per_dof > fit.chance; }

std::string standing(const Score& score, const Fit& fit) {
  if (!score.supported) return "no";
  return disagrees(fit) ? kOnlyNearest : "yes";
}

std::string evidence(const Score& s) {
  if (std::fabs(s.behind) < kSame && !(std::fabs(s.heights_behind) >= kSame) &&
      !(std::fabs(s.aic_behind) >= 0.05)) {
    return "the same stress here";
  }
  if (std::isfinite(s.aic_behind)) {
    return fmt::format("behind by {:.1f} in chi2 + 2 x free numbers (more than {:g} counts)",
                       s.aic_behind, kNoSupport);
  }
  std::string out =
      fmt::format("behind by {:.2g} +- {:.1g} on realizations left out", s.behind, s.behind_error);
  if (std::isfinite(s.heights_behind)) {
    out += fmt::format(" and by {:.2g} +- {:.1g} on heights left out", s.heights_behind,
                       s.heights_error);
  }
  return out + " (squared, of the signal's)";
}

std::string sign_warnings(const std::vector<Fit>& fits, const std::vector<std::string>& names) {
  std::string out;
  for (const Fit& f : fits) {
    if (f.turning_signs.empty() || std::find(names.begin(), names.end(), f.name) == names.end()) {
      continue;
    }
    out += fmt::format(" The sign of {} hangs on single realizations: {}.", f.name,
                       fmt::join(f.turning_signs, "; "));
  }
  return out;
}

void mark_supported(std::vector<Score>& ranking, double least_errors) {
  for (Score& s : ranking) {
    const bool clearly_behind = s.behind > kSame && s.behind > least_errors * s.behind_error &&
                                !(s.heights_behind < -kSame) &&  // false for nan
                                !(s.aic_behind <= kNoSupport);
    s.supported = &s == &ranking.front() || !clearly_behind;
  }
  // Who is at least as far behind in both as one that is not supported is not supported either.
  const std::vector<Score> judged = ranking;
  for (std::size_t k = 1; k < ranking.size(); ++k) {
    for (const Score& other : judged) {
      if (!other.supported && ranking[k].behind > other.behind - kSame &&
          !(ranking[k].heights_behind < other.heights_behind - kSame)) {
        ranking[k].supported = false;
      }
    }
  }
}

Selection select(const FitData& data, const Weights& weights, const std::vector<FitModel>& models,
                 const std::vector<Fit>& fits, const SelectionOptions& options) {
  if (models.empty() || models.size() != fits.size()) {
    throw std::invalid_argument("selection: one fit per model, and at least one");
  }
  const std::size_t m = models.size();
  const int r = data.realizations();
  const bool left_out = weights.errors_from == ErrorsFrom::realizations && r >= kLeastRealizations;
  const bool judged = left_out || weights.errors_from == ErrorsFrom::data;
  const double signal = weights.weight.cwiseProduct(data.mean()).squaredNorm();
  std::vector<Forecast> forecasts(m);
  std::vector<Eigen::VectorXd> heights(m);
  std::vector<double> scores(m, kNan);
  for (std::size_t k = 0; judged && k < m; ++k) {
    forecasts[k] = left_out ? of_realizations(data, weights, models[k], fits[k], options.huber)
                            : Forecast(fits[k].model);
    heights[k] = options.by_level ? of_heights(data, models[k], fits[k], options.huber)
                                  : Eigen::VectorXd::Constant(data.values(), kNan);
    const Eigen::MatrixXd off = weights.weight.asDiagonal() * (data.samples - forecasts[k]);
    // A single field is no new one: what the constants took of its noise is added.
    scores[k] =
        off.colwise().squaredNorm().mean() + (left_out ? 0 : fits[k].expected - fits[k].misfit);
  }
  const auto rank = [&](std::size_t k) { return judged ? scores[k] : fits[k].rel_l2; };
  std::vector<std::size_t> order(m);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  const std::size_t best = order.front();
  Selection out;
  for (const std::size_t k : order) {
    Score s;
    s.name = models[k].name;
    s.score = scores[k] / signal;
    s.behind = s.behind_error = s.heights_behind = s.heights_error = kNan;
    if (judged) {
      s.behind = (scores[k] - scores[best]) / signal;
      s.behind_error = paired(data, weights, forecasts[k], forecasts[best]).error / signal;
      const Difference apart =
          paired(data, weights, heights[k].replicate(1, r), heights[best].replicate(1, r));
      s.heights_behind = apart.mean / signal;
      s.heights_error = apart.error / signal;
      if (!left_out) s.aic_behind = akaike(data, fits[k]) - akaike(data, fits[best]);
    }
    out.ranking.push_back(s);
  }
  mark_supported(out.ranking, least_errors(r));
  std::stable_partition(out.ranking.begin(), out.ranking.end(),
                        [](const Score& s) { return s.supported; });
  std::vector<std::string> names;
  for (const Score& s : out.ranking) {
    if (s.supported) names.push_back(s.name);
  }
  out.distinguishable = judged && names.size() == 1 && m > 1;
  if (m == 1) {
    out.sentence = fmt::format("{} is the only model.", names.front());
  } else if (out.distinguishable) {
    const Score& second = out.ranking[1];
    out.sentence = fmt::format("{} is {}: the next, {}, is {}; {}.", names.front(),
                               disagrees(fits[best]) ? "the nearest of those asked" : "supported",
                               second.name, evidence(second), judges(r));
  } else {
    out.sentence = fmt::format("Not distinguishable: {}", fmt::join(names, ", "));
    if (names.size() < m) {
      std::vector<std::string> behind;
      for (const Score& s : out.ranking) {
        if (!s.supported) behind.push_back(s.name);
      }
      out.sentence += fmt::format("; not supported: {}", fmt::join(behind, ", "));
    }
    if (judged) {
      const Score& second = out.ranking[1];
      out.sentence += fmt::format("; {} is {}; {}.", second.name, evidence(second), judges(r));
    } else {
      out.sentence +=
          fmt::format("; the nearest misses by {:.1f} % (relative L2), the next by {:.1f} %.",
                      100 * fits[order[0]].rel_l2, 100 * fits[order[1]].rel_l2);
    }
  }
  out.sentence += doubt(fits[best], fits, weights.errors_from) + sign_warnings(fits, names);
  return out;
}

}  // namespace grainfield::coupling
