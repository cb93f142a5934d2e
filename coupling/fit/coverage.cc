#include "coupling/fit/coverage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/result/text_table.h"
#include "coupling/statistics/agreement.h"
#include "coupling/statistics/parallel.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

// The first `size` of a shuffled row of numbers below n, and the rest.
std::pair<std::vector<int>, std::vector<int>> draw(int n, int size, std::uint64_t seed) {
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  dem::Random random(seed);
  for (int k = 0; k < size; ++k) {
    const auto other = k + static_cast<int>(random.uniform() * (n - k));
    std::swap(all[static_cast<std::size_t>(k)],
              all[static_cast<std::size_t>(std::min(other, n - 1))]);
  }
  return {{all.begin(), all.begin() + size}, {all.begin() + size, all.end()}};
}

// The model as the drawn realizations have it, whose own subsets count among the drawn.
FitModel of_drawn(const FitModel& model, const std::vector<int>& chosen) {
  if (!model.measured_on) return model;
  FitModel out = model_of(model, chosen);
  out.measured_on = [whole = model.measured_on, chosen](const std::vector<int>& part) {
    std::vector<int> numbers;
    for (const int k : part) numbers.push_back(chosen[static_cast<std::size_t>(k)]);
    return whole(numbers);
  };
  return out;
}

struct Drawn {
  std::vector<Fit> fits;                ///< in the order of the models
  std::vector<Eigen::VectorXd> others;  ///< constants of the rest
  std::string named;                    ///< the model supported alone; empty: none
  bool alarm = false;                   ///< its mean disagrees with that of the rest
};

Drawn fit_draw(const FitData& data, const std::vector<FitModel>& models,
               const std::vector<Fit>& all, const CoverageOptions& options, int size,
               std::uint64_t seed) {
  const auto [chosen, rest] = draw(data.realizations(), size, seed);
  const FitData few = realizations_of(data, chosen), many = realizations_of(data, rest);
  const Weights own = weights_of(few), theirs = weights_of(many);
  FitOptions fitting;
  fitting.huber = options.huber;
  fitting.bootstrap = options.bootstrap;
  fitting.level = options.level;
  fitting.profile = options.profile;
  Drawn out;
  std::vector<FitModel> of_few;
  for (std::size_t m = 0; m < models.size(); ++m) {
    of_few.push_back(of_drawn(models[m], chosen));
    out.fits.push_back(fit(few, own, of_few.back(), fitting));
    out.others.push_back(best_parameters(many, many.mean(), theirs, model_of(models[m], rest),
                                         {parameters_of(all[m])}, options.huber));
  }
  SelectionOptions selecting;
  selecting.huber = options.huber;
  const Judgement judgement = select(few, own, of_few, out.fits, selecting);
  if (judgement.distinguishable == Answer::yes) out.named = judgement.best;
  const Eigen::VectorXd apart = own.weight.cwiseProduct(few.mean() - many.mean());
  const Eigen::MatrixXd spread = own.weight.asDiagonal() * (few.samples.colwise() - few.mean());
  const double share = static_cast<double>(size) / static_cast<double>(rest.size());
  out.alarm = !agreement(apart, spread, share).holds();
  return out;
}

// Both ends as far again from the middle as `wider` says.
Interval widened(const Interval& i, double middle, double wider) {
  return {middle - wider * (middle - i.low), middle + wider * (i.high - middle)};
}

ConstantCoverage of_constant(const std::vector<Drawn>& draws, std::size_t m, std::size_t p,
                             double wider) {
  ConstantCoverage out;
  const Fit& first = draws.front().fits[m];
  out.model = first.name;
  out.parameter = first.parameters[p].parameter.name;
  double sum = 0, squares = 0;
  for (const Drawn& d : draws) {
    const FittedParameter& f = d.fits[m].parameters[p];
    const double truth = d.others[m][static_cast<Eigen::Index>(p)];
    const double room = 1e-3 * (f.parameter.most - f.parameter.least);
    const bool bound = std::isfinite(room) &&
                       (truth - f.parameter.least < room || f.parameter.most - truth < room);
    if (bound || f.at_bound || !f.determined) continue;
    ++out.draws;
    out.by_covariance += widened(f.by_covariance, f.value, wider).holds(truth);
    out.by_bootstrap += widened(f.by_bootstrap, f.value, wider).holds(truth);
    out.by_jackknife += widened(f.by_jackknife, f.value, wider).holds(truth);
    out.by_profile += widened(f.by_profile, f.value, wider).holds(truth);
    sum += f.value;
    squares += f.value * f.value;
    out.covariance_error += f.covariance_error * f.covariance_error;
    out.jackknife_error += f.jackknife_error * f.jackknife_error;
  }
  const double n = out.draws;
  for (double* share :
       {&out.by_covariance, &out.by_bootstrap, &out.by_jackknife, &out.by_profile}) {
    *share = n > 0 ? *share / n : kNan;
  }
  // Not asked for: no share.
  const FittedParameter& one = draws.front().fits[m].parameters[p];
  if (std::isnan(one.by_bootstrap.low)) out.by_bootstrap = kNan;
  if (std::isnan(one.by_profile.low)) out.by_profile = kNan;
  out.spread = n > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1)) : kNan;
  out.covariance_error = std::sqrt(out.covariance_error / n);
  out.jackknife_error = std::sqrt(out.jackknife_error / n);
  return out;
}

}  // namespace

Coverage coverage_of(const FitData& data, const std::vector<FitModel>& models,
                     const CoverageOptions& options) {
  const int n = data.realizations();
  if (n < 6) {
    throw std::invalid_argument(
        fmt::format("coverage: found {} realization{}, allowed: 6 or more (at least 3 are drawn, "
                    "from at most half of them)",
                    n, n == 1 ? "" : "s"));
  }
  for (const int size : options.sizes) {
    if (size < 3 || size > n / 2) {
      throw std::invalid_argument(fmt::format(
          "coverage: found a size of {}, allowed: 3 to {}, half of the realizations", size, n / 2));
    }
  }
  if (options.draws < 1) {
    throw std::invalid_argument(fmt::format("draws: found {}, allowed: 1 or more", options.draws));
  }
  const Weights weights = weights_of(data);
  FitOptions plain;
  plain.huber = options.huber;
  plain.bootstrap = 0;
  plain.jackknife = plain.profile = false;
  std::vector<Fit> all;
  for (const FitModel& model : models) all.push_back(fit(data, weights, model, plain));
  SelectionOptions selecting;
  selecting.huber = options.huber;
  Coverage out;
  for (const JudgedModel& m : select(data, weights, models, all, selecting).models) {
    if (m.distinguishable != Answer::yes) out.kept.push_back(m.name);
  }
  for (const int size : options.sizes) {
    std::vector<Drawn> draws(static_cast<std::size_t>(options.draws));
    in_parts(options.draws, options.threads, [&](int first, int last) {
      for (int d = first; d < last; ++d) {
        const std::uint64_t seed = options.seed + 1000003ULL * static_cast<std::uint64_t>(size) +
                                   static_cast<std::uint64_t>(d);
        draws[static_cast<std::size_t>(d)] = fit_draw(data, models, all, options, size, seed);
      }
    });
    for (std::size_t m = 0; m < models.size(); ++m) {
      for (std::size_t p = 0; p < models[m].parameters.size(); ++p) {
        out.constants.push_back(of_constant(draws, m, p, std::sqrt(1.0 + size / (n - 1.0 * size))));
        out.constants.back().size = size;
      }
    }
    VerdictCoverage verdict{size, options.draws};
    for (const Drawn& d : draws) {
      verdict.false_alarms += d.alarm;
      if (d.named.empty()) continue;
      ++verdict.named;
      verdict.wrong += std::find(out.kept.begin(), out.kept.end(), d.named) == out.kept.end();
    }
    out.verdicts.push_back(verdict);
  }
  return out;
}

namespace {

// Over all constants of one size: every draw that counts counts once.
ConstantCoverage pooled(const std::vector<ConstantCoverage>& constants, int size) {
  ConstantCoverage out;
  out.size = size;
  double covariance = 0, bootstrap = 0, jackknife = 0, profile = 0;
  for (const ConstantCoverage& c : constants) {
    if (c.size != size || c.draws == 0) continue;
    out.draws += c.draws;
    covariance += c.draws * c.by_covariance;
    bootstrap += c.draws * c.by_bootstrap;
    jackknife += c.draws * c.by_jackknife;
    profile += c.draws * c.by_profile;
  }
  const double n = out.draws;  // 0: nan
  out.by_covariance = covariance / n;
  out.by_bootstrap = bootstrap / n;
  out.by_jackknife = jackknife / n;
  out.by_profile = profile / n;
  return out;
}

}  // namespace

std::string coverage_text(const Coverage& coverage, int realizations) {
  std::string out = fmt::format(
      "Drawn out of {} realizations; truth: the constants of the rest.\n\n", realizations);
  const auto share = [](double v) {
    return std::isnan(v) ? "-" : fmt::format("{:.1f} %", 100 * v);
  };
  std::vector<std::vector<std::string>> rows;
  for (const ConstantCoverage& c : coverage.constants) {
    rows.push_back({c.model, c.parameter, fmt::format("{}", c.size), fmt::format("{}", c.draws),
                    share(c.by_covariance), share(c.by_bootstrap), share(c.by_jackknife),
                    share(c.by_profile), number(c.spread), number(c.covariance_error),
                    number(c.jackknife_error)});
  }
  for (const VerdictCoverage& v : coverage.verdicts) {
    const ConstantCoverage all = pooled(coverage.constants, v.size);
    if (all.draws == 0) continue;
    rows.push_back({"all", "", fmt::format("{}", all.size), fmt::format("{}", all.draws),
                    share(all.by_covariance), share(all.by_bootstrap), share(all.by_jackknife),
                    share(all.by_profile), "", "", ""});
  }
  out +=
      markdown_table({"model", "constant", "drawn", "draws", "covariance", "bootstrap", "jackknife",
                      "profile", "spread", "error by the covariance", "error by the jackknife"},
                     rows);
  rows.clear();
  for (const VerdictCoverage& v : coverage.verdicts) {
    rows.push_back({fmt::format("{}", v.size), fmt::format("{}", v.draws),
                    fmt::format("{}", v.named), fmt::format("{}", v.wrong),
                    fmt::format("{}", v.false_alarms)});
  }
  out += "\n" + markdown_table({"drawn", "draws", "one model named", "of these wrong",
                                "differs from the rest by chance"},
                               rows);
  return out +
         fmt::format("\nNot distinguishable from the nearest, all realizations together: {}\n",
                     fmt::join(coverage.kept, ", "));
}

}  // namespace grainfield::coupling
