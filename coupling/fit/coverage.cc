#include "coupling/fit/coverage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "continuum/constants.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/statistics/parallel.h"
#include "dem/random/random.h"

namespace grainfield::coupling {
namespace {

FitData columns_of(const FitData& data, const std::vector<int>& chosen) {
  FitData out = data;
  out.samples = data.samples(Eigen::all, chosen);
  return out;
}

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

struct Drawn {
  std::vector<Fit> fits;                ///< in the order of the models
  std::vector<Eigen::VectorXd> others;  ///< constants of the rest
  std::string named;                    ///< the model supported alone; empty: none
};

Drawn fit_draw(const FitData& data, const std::vector<FitModel>& models,
               const std::vector<Fit>& all, const CoverageOptions& options, int size,
               std::uint64_t seed) {
  const auto [chosen, rest] = draw(data.realizations(), size, seed);
  const FitData few = columns_of(data, chosen), many = columns_of(data, rest);
  const Covariance own = covariance_of(few, options.covariance);
  const Covariance theirs = covariance_of(many, options.covariance);
  FitOptions fitting;
  fitting.huber = options.huber;
  fitting.bootstrap = options.bootstrap;
  fitting.level = options.level;
  Drawn out;
  for (std::size_t m = 0; m < models.size(); ++m) {
    out.fits.push_back(fit(few, own, models[m], fitting));
    Eigen::VectorXd start(static_cast<Eigen::Index>(all[m].parameters.size()));
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      start[k] = all[m].parameters[static_cast<std::size_t>(k)].value;
    }
    out.others.push_back(
        best_parameters(many, many.mean(), theirs.whitener, models[m], {start}, options.huber));
  }
  SelectionOptions selecting;
  selecting.huber = options.huber;
  selecting.by_level = false;
  const Selection selection = select(few, own, models, out.fits, selecting);
  if (selection.distinguishable) out.named = selection.ranking.front().name;
  return out;
}

ConstantCoverage of_constant(const std::vector<Drawn>& draws, std::size_t m, std::size_t p) {
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
    out.by_covariance += f.by_covariance.holds(truth);
    out.by_bootstrap += f.by_bootstrap.holds(truth);
    out.by_jackknife += f.by_jackknife.holds(truth);
    out.by_profile += f.by_profile.holds(truth);
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
  out.spread = n > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1)) : kNan;
  out.covariance_error = std::sqrt(out.covariance_error / n);
  out.jackknife_error = std::sqrt(out.jackknife_error / n);
  return out;
}

}  // namespace

Coverage coverage_of(const FitData& data, const std::vector<FitModel>& models,
                     const CoverageOptions& options) {
  const int n = data.realizations();
  for (const int size : options.sizes) {
    if (size < 3 || size > n / 2) {
      throw std::invalid_argument(
          fmt::format("sizes: found {}, allowed: 3 to {}, half of the realizations", size, n / 2));
    }
  }
  if (options.draws < 1) {
    throw std::invalid_argument(fmt::format("draws: found {}, allowed: 1 or more", options.draws));
  }
  const Covariance covariance = covariance_of(data, options.covariance);
  FitOptions plain;
  plain.huber = options.huber;
  plain.bootstrap = 0;
  plain.jackknife = plain.profile = false;
  std::vector<Fit> all;
  for (const FitModel& model : models) all.push_back(fit(data, covariance, model, plain));
  SelectionOptions selecting;
  selecting.huber = options.huber;
  selecting.by_level = false;
  Coverage out;
  for (const Score& s : select(data, covariance, models, all, selecting).ranking) {
    if (s.supported) out.supported.push_back(s.name);
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
        out.constants.push_back(of_constant(draws, m, p));
        out.constants.back().size = size;
      }
    }
    VerdictCoverage verdict{size, options.draws};
    for (const Drawn& d : draws) {
      if (d.named.empty()) continue;
      ++verdict.named;
      verdict.wrong +=
          std::find(out.supported.begin(), out.supported.end(), d.named) == out.supported.end();
    }
    out.verdicts.push_back(verdict);
  }
  return out;
}

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
  out +=
      markdown_table({"model", "constant", "drawn", "draws", "covariance", "bootstrap", "jackknife",
                      "profile", "spread", "error by the covariance", "error by the jackknife"},
                     rows);
  rows.clear();
  for (const VerdictCoverage& v : coverage.verdicts) {
    rows.push_back({fmt::format("{}", v.size), fmt::format("{}", v.draws),
                    fmt::format("{}", v.named), fmt::format("{}", v.wrong)});
  }
  out += "\n" + markdown_table({"drawn", "draws", "one model named", "of these wrong"}, rows);
  return out + fmt::format("\nSupported by all realizations together: {}\n",
                           fmt::join(coverage.supported, ", "));
}

}  // namespace grainfield::coupling
