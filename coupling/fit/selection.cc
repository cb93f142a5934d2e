#include "coupling/fit/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
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

std::vector<Eigen::VectorXd> starts_of(const FitModel& model, const Fit& fit) {
  Eigen::VectorXd best(static_cast<Eigen::Index>(fit.parameters.size()));
  for (Eigen::Index k = 0; k < best.size(); ++k) {
    best[k] = fit.parameters[static_cast<std::size_t>(k)].value;
  }
  (void)model;
  return {best};
}

// Per realization left out: |W (it - model of the others)|^2 / (R n). W is of the mean of R.
Eigen::VectorXd realization_scores(const FitData& data, const Covariance& c, const FitModel& model,
                                   const Fit& fit, double huber) {
  const int r = data.realizations();
  Eigen::VectorXd out = Eigen::VectorXd::Constant(r, kNan);
  if (r < kLeastRealizations) return out;
  const Eigen::VectorXd sum = data.samples.rowwise().sum();
  for (int left = 0; left < r; ++left) {
    const Eigen::VectorXd others = (sum - data.samples.col(left)) / (r - 1.0);
    const Eigen::VectorXd parameters =
        best_parameters(data, others, c.whitener, model, starts_of(model, fit), huber);
    const Eigen::VectorXd off = data.samples.col(left) - predict(data, model, parameters);
    out[left] = (c.whitener * off).squaredNorm() / (r * c.effective_values);
  }
  return out;
}

Eigen::MatrixXd part(const Eigen::MatrixXd& m, const std::vector<int>& rows) {
  Eigen::MatrixXd out(rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = m(rows[i], rows[j]);
    }
  }
  return out;
}

Eigen::MatrixXd whitener_of(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  return Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL().solve(Eigen::MatrixXd::Identity(n, n));
}

// Mean over levels left out of |W (mean there - model of the other levels)|^2 per value.
double level_score(const FitData& data, const Covariance& c, const FitModel& model, const Fit& fit,
                   double huber) {
  double sum = 0;
  int parts = 0;
  const Eigen::VectorXd mean = data.mean();
  for (int level = 0; level < static_cast<int>(data.levels.size()); ++level) {
    std::vector<int> in, out;
    for (int k = 0; k < data.values(); ++k) {
      (data.level[static_cast<std::size_t>(k)] == level ? out : in).push_back(k);
    }
    if (in.empty() || out.empty()) continue;
    const FitData rest = rows_of(data, in), there = rows_of(data, out);
    const Eigen::VectorXd parameters = best_parameters(
        rest, rest.mean(), whitener_of(part(c.of_mean, in)), model, starts_of(model, fit), huber);
    const Eigen::VectorXd off = there.mean() - predict(there, model, parameters);
    sum +=
        (whitener_of(part(c.of_mean, out)) * off).squaredNorm() / static_cast<double>(out.size());
    ++parts;
  }
  return parts >= 2 ? sum / parts : kNan;
}

// What the best fit's chi squared says against every model; empty: nothing.
std::string doubt(const Fit& best) {
  if (!std::isnan(best.aicc) && !(best.dof > 0)) {
    return fmt::format(" {} has as many free numbers as there are effective values: no test.",
                       best.name);
  }
  if (!(best.chi2_per_dof > best.chance)) return "";
  return fmt::format(
      " No model agrees within the errors: the nearest has chi2/dof {:.3g}, where up to {:.3g} "
      "would be chance.",
      best.chi2_per_dof, best.chance);
}

}  // namespace

double least_errors(int realizations) {
  if (realizations < kLeastRealizations) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::students_t(realizations - 1.0), 0.975);
}

void mark_supported(std::vector<Score>& ranking, double least_aicc, double least_errors) {
  for (Score& s : ranking) {
    const bool clearly_behind = s.aicc_difference > least_aicc &&
                                s.behind > least_errors * s.behind_error;  // false for nan
    s.supported = &s == &ranking.front() || !clearly_behind;
  }
  // Who is at least as far behind in both as one that is not supported is not supported either.
  const std::vector<Score> judged = ranking;
  for (std::size_t k = 1; k < ranking.size(); ++k) {
    for (const Score& other : judged) {
      if (!other.supported && ranking[k].aicc_difference >= other.aicc_difference &&
          ranking[k].behind >= other.behind) {
        ranking[k].supported = false;
      }
    }
  }
}

Selection select(const FitData& data, const Covariance& covariance,
                 const std::vector<FitModel>& models, const std::vector<Fit>& fits,
                 const SelectionOptions& options) {
  if (models.empty() || models.size() != fits.size()) {
    throw std::invalid_argument("selection: one fit per model, and at least one");
  }
  const std::size_t m = models.size();
  std::vector<Eigen::VectorXd> scores;
  std::vector<double> levels;
  for (std::size_t k = 0; k < m; ++k) {
    scores.push_back(realization_scores(data, covariance, models[k], fits[k], options.huber));
    levels.push_back(
        options.by_level ? level_score(data, covariance, models[k], fits[k], options.huber) : kNan);
  }
  std::vector<std::size_t> order(m);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return better(fits[a], fits[b]); });
  const std::size_t best = order.front();
  Selection out;
  const int r = data.realizations();
  for (const std::size_t k : order) {
    Score s;
    s.name = models[k].name;
    // More free numbers than values is behind everything, too.
    s.aicc_difference = fits[k].aicc == fits[best].aicc ? 0 : fits[k].aicc - fits[best].aicc;
    s.realization_score = scores[k].mean();
    s.level_score = levels[k];
    const Eigen::VectorXd behind = scores[k] - scores[best];
    s.behind = behind.mean();
    s.behind_error =
        r >= kLeastRealizations
            ? std::sqrt((behind.array() - behind.mean()).square().sum() / (r - 1.0) / r)
            : kNan;
    out.ranking.push_back(s);
  }
  mark_supported(out.ranking, options.least_aicc, least_errors(r));
  std::stable_partition(out.ranking.begin(), out.ranking.end(),
                        [](const Score& s) { return s.supported; });
  const auto supported = std::count_if(out.ranking.begin(), out.ranking.end(),
                                       [](const Score& s) { return s.supported; });
  out.distinguishable = supported == 1 && m > 1 && r >= kLeastRealizations;
  std::vector<std::string> names;
  for (const Score& s : out.ranking) {
    if (s.supported) names.push_back(s.name);
  }
  if (m == 1) {
    out.sentence = fmt::format("{} is the only model.", names.front());
  } else if (out.distinguishable) {
    const Score& second = out.ranking[1];
    out.sentence = fmt::format(
        "{} is supported: the next, {}, is behind by {:.1f} in AICc and by {:.3g} +- {:.2g} in "
        "cross-validation over {} realizations.",
        names.front(), second.name, second.aicc_difference, second.behind, second.behind_error, r);
  } else {
    out.sentence = fmt::format("Not distinguishable: {}", fmt::join(names, ", "));
    const Score& second = out.ranking[1];
    if (std::isnan(fits[best].aicc)) {
      out.sentence +=
          fmt::format("; the nearest misses by {:.1f} % (relative L2), the next by {:.1f} %.",
                      100 * fits[order[0]].rel_l2, 100 * fits[order[1]].rel_l2);
    } else if (std::isnan(second.behind_error)) {
      out.sentence +=
          fmt::format("; the second is behind by {:.1f} in AICc.", second.aicc_difference);
    } else {
      out.sentence += fmt::format(
          "; the second is behind by {:.1f} in AICc and by {:.3g} +- {:.2g} in cross-validation "
          "over "
          "{} realizations.",
          second.aicc_difference, second.behind, second.behind_error, r);
    }
  }
  out.sentence += doubt(fits[best]);
  for (std::size_t k = 0; k < m; ++k) {
    if (fits[k].turning_signs.empty() ||
        std::find(names.begin(), names.end(), fits[k].name) == names.end()) {
      continue;
    }
    out.sentence += fmt::format(" The sign of {} hangs on single realizations: {}.", fits[k].name,
                                fmt::join(fits[k].turning_signs, "; "));
  }
  return out;
}

}  // namespace grainfield::coupling
