// The verdict in one number: the simulation is projected on the line from model A (the best of the
// family that loses) to model B (the best of the family that wins):
//   position = sum (simulation - A)(B - A) / sum (B - A)^2   over all points of all profiles,
// 0 at A, 1 at B, and its standard error from the realizations' own positions. Points where A and B
// agree do not weigh, and correlations between points are in the spread of the realizations.
#include "coupling/compare/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "continuum/constants.h"
#include "coupling/statistics/agreement.h"

namespace grainfield::coupling {
namespace {

constexpr double confidence = 0.95;
// With fewer realizations the errors are too uncertain to weigh points by: rank by relative L2.
constexpr int least_for_chi2 = 4;
// Errors below this share of the signal are rounding: the realizations are copies of one.
constexpr double rounding = 1e-9;
// A model that misses by more than half of the signal describes nothing, even when others do worse.
constexpr double most_rel_l2 = 0.5;
// A position so far outside of [0, 1] says little: the grains' part along the line that neither
// model has is as large as half the distance of the two.
constexpr double most_beyond = 0.5;

struct Projection {
  double position = kNan, error = kNan;
};

// The standard error that a value brings with it; nan: none.
double own_error(const Profile& p, Eigen::Index i) {
  const double error = i < p.error.size() ? p.error[i] : kNan;
  return error > 0 && std::isfinite(error) ? error : kNan;
}

// Values of a profile, and those without an error.
struct Count {
  Eigen::Index values = 0, without = 0;
};
Count count_of(const Profile& p) {
  Count out;
  for (Eigen::Index i = 0; i < p.x.size(); ++i) {
    if (!std::isfinite(p.mean[i])) continue;
    ++out.values;
    if (std::isnan(own_error(p, i))) ++out.without;
  }
  return out;
}
Count count_of(const Comparison& c) {
  Count out;
  for (const Profile& p : c.profiles) {
    const Count one = count_of(p);
    out.values += one.values;
    out.without += one.without;
  }
  return out;
}

// A field with errors of its own, whose realizations are not at hand: a measurement, or a mean.
bool has_own_errors(const Comparison& c) {
  const Count count = count_of(c);
  return count.without < count.values &&
         std::all_of(c.profiles.begin(), c.profiles.end(),
                     [](const Profile& p) { return p.samples.cols() < 2; });
}

// How many values count as one there: the components of a place may be tied, and so are places
// nearer than the independent length.
double tied_values(const Comparison& c) {
  double values = 0, independent = 0;
  bool near = false;
  std::set<std::string> components;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    const Count count = count_of(p);
    if (count.without == count.values) continue;
    components.insert(p.quantity);
    near |= p.independent_length > 0;
    values += static_cast<double>(count.values);
    independent += c.results.front().per_profile[k].dof;
  }
  const double tied = near && independent > 0 ? std::max(1.0, values / independent) : 1;
  return tied * static_cast<double>(components.size());
}

// Of a field with errors of its own each value counts by 1/error^2, as in the chi2 that ranks;
// values without an error are left out. Its variance is tied / sum (B - A)^2/error^2.
Projection project(const Comparison& c, const ModelProfiles& a, const ModelProfiles& b) {
  const auto realizations = static_cast<Eigen::Index>(c.realizations);
  const bool own_errors = has_own_errors(c);
  double norm = 0, sum = 0;
  Eigen::VectorXd each = Eigen::VectorXd::Zero(realizations);
  bool sampled = realizations > 1;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    const bool here = p.samples.cols() == realizations && p.samples.rows() == p.x.size();
    sampled = sampled && here;
    for (Eigen::Index i = 0; i < p.x.size(); ++i) {
      const double from = a.values[k][i], step = b.values[k][i] - from;
      if (!std::isfinite(step) || !std::isfinite(p.mean[i])) continue;
      const double weight = own_errors ? 1 / std::pow(own_error(p, i), 2) : 1;
      if (std::isnan(weight)) continue;
      norm += weight * step * step;
      sum += weight * (p.mean[i] - from) * step;
      if (here)
        for (Eigen::Index r = 0; r < realizations; ++r) each[r] += (p.samples(i, r) - from) * step;
    }
  }
  if (!(norm > 0)) return {};
  Projection result{sum / norm, kNan};
  if (own_errors) {
    result.error = std::sqrt(tied_values(c) / norm);
  } else if (sampled) {
    each /= norm;
    const double n = static_cast<double>(realizations);
    result.error = std::sqrt((each.array() - each.mean()).square().sum() / (n - 1) / n);
  }
  return result;
}

// Beyond the middle between A and B by more than the spread (95 %, two-sided: Student's t over
// realizations, the normal distribution of a single field's errors), which is itself less than
// their distance: nearer than the spread the two curves are one.
bool beyond_spread(const Projection& p, int realizations) {
  if (!std::isfinite(p.error)) return false;
  const double level = (1 + confidence) / 2;
  const double errors = realizations < 2
                            ? quantile(boost::math::normal(), level)
                            : quantile(boost::math::students_t(realizations - 1), level);
  const double spread = errors * p.error;
  return p.position - 0.5 > spread && spread < 1;
}

// Says so where the grains are farther from both than the two from each other: then the number is
// no share of a way between them.
std::string beyond_both(const Comparison& c, const Projection& p) {
  if (p.position >= -most_beyond && p.position <= 1 + most_beyond) return "";
  return fmt::format(
      " (beyond both: the two differ less from each other than the {0} from either, so this says "
      "only on which side the {0} {1})",
      c.subject(), c.measured() ? "is" : "are");
}

// Whether the realizations differ at all (those of a perfect lattice do not).
bool has_spread(const Comparison& c) {
  double error = 0, signal = 0;
  for (const Profile& p : c.profiles) {
    for (Eigen::Index i = 0; i < p.error.size(); ++i) {
      if (std::isfinite(p.error[i])) error = std::max(error, p.error[i]);
    }
    for (Eigen::Index i = 0; i < p.mean.size(); ++i) {
      if (std::isfinite(p.mean[i])) signal = std::max(signal, std::fabs(p.mean[i]));
    }
  }
  return error > rounding * signal;
}

double score(const ModelComparison& result, bool by_chi2) {
  const double value = by_chi2 ? result.overall.chi2_per_dof : result.overall.rel_l2;
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

std::string describe(const ModelComparison& result, bool by_chi2) {
  return by_chi2
             ? fmt::format("{} (chi2/dof {:.3g}, relative L2 {:.1f} %)", result.label,
                           result.overall.chi2_per_dof, 100 * result.overall.rel_l2)
             : fmt::format("{} (relative L2 {:.1f} %)", result.label, 100 * result.overall.rel_l2);
}

// It describes nothing.
bool misses(const ModelComparison& best) { return best.overall.rel_l2 > most_rel_l2; }

// The model against the realizations, as fits have it (statistics/agreement.h): every profile in
// units of its own root mean square. Without single values of every realization by the field's own
// errors; nan without these.
Agreement agreement_of(const Comparison& c, std::size_t model) {
  const bool own_errors = has_own_errors(c);
  std::vector<double> off, errors;
  std::vector<Eigen::VectorXd> samples;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    if (!own_errors && (p.samples.cols() != c.realizations || p.samples.rows() != p.x.size()))
      return {kNan, kNan, kNan, kNan};
    double square = 0;
    int count = 0;
    for (const double v : p.mean) {
      if (!std::isfinite(v)) continue;
      square += v * v;
      ++count;
    }
    const double unit = std::sqrt(square / std::max(count, 1));
    for (Eigen::Index i = 0; unit > 0 && i < p.x.size(); ++i) {
      const double d = p.mean[i] - c.models[model].values[k][i];
      if (!std::isfinite(d)) continue;
      if (own_errors) {
        const double error = own_error(p, i);
        if (std::isnan(error)) continue;
        off.push_back(d / unit);
        errors.push_back(error / unit);
        continue;
      }
      if (!p.samples.row(i).allFinite()) continue;
      off.push_back(d / unit);
      samples.emplace_back((p.samples.row(i).array() - p.samples.row(i).mean()) / unit);
    }
  }
  if (own_errors) {
    const auto count = static_cast<Eigen::Index>(off.size());
    return agreement(Eigen::Map<const Eigen::VectorXd>(off.data(), count),
                     Eigen::Map<const Eigen::VectorXd>(errors.data(), count),
                     static_cast<int>(std::lround(tied_values(c))));
  }
  Eigen::MatrixXd deviations(static_cast<Eigen::Index>(off.size()), c.realizations);
  for (std::size_t k = 0; k < off.size(); ++k) {
    deviations.row(static_cast<Eigen::Index>(k)) = samples[k].transpose();
  }
  return agreement(
      Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size())),
      deviations);
}

// How the verdict begins where two families are told apart: a family that does not agree with the
// data is nearer than the other, and no more.
std::string claim(const Comparison& c, bool agrees) {
  if (agrees) return c.measured() ? "The measurement supports the" : "The grains support the";
  return c.measured() ? "The measurement is nearer to the" : "The grains are nearer to the";
}

// Says so when even the nearest model is not within the errors, or describes nothing.
void add_misfit(const Comparison& c, const ModelComparison& best, const Agreement& found,
                std::string& sentence) {
  if (misses(best)) {
    sentence = fmt::format(
        "None of the models describes {} {}: even the nearest misses by {:.0f} % (relative L2). {}",
        c.measured() ? "this" : "these", c.subject(), 100 * best.overall.rel_l2, sentence);
    return;
  }
  if (found.ratio > found.chance) {
    sentence += fmt::format(
        " No model agrees within the errors: the nearest misses by {:.3g} times what the {} "
        "explains, where up to {:.3g} would be chance.",
        found.ratio, c.realizations < 2 ? "error" : "spread", found.chance);
  }
}

// Of a field with errors of its own: how many values have none.
void add_left_out(const Comparison& c, std::string& sentence) {
  const Count count = count_of(c);
  if (!has_own_errors(c) || count.without == 0) return;
  sentence += fmt::format(" {} of {} values have no error and are left out of chi2 and position.",
                          count.without, count.values);
}

}  // namespace

Verdict judge(const Comparison& c) {
  Verdict v;
  const bool spread = has_spread(c);
  const bool single = c.realizations < 2;
  const bool by_chi2 = spread && (single ? has_own_errors(c) : c.realizations >= least_for_chi2) &&
                       std::all_of(c.results.begin(), c.results.end(), [](const auto& r) {
                         return std::isfinite(r.overall.chi2_per_dof);
                       });
  v.ranked_by = by_chi2 ? "chi2_per_dof" : "rel_l2";
  std::vector<std::size_t> order(c.results.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return score(c.results[a], by_chi2) < score(c.results[b], by_chi2);
  });
  for (std::size_t k : order) v.ranking.push_back(c.results[k].key);
  const ModelComparison& best = c.results[order.front()];
  const Agreement found =
      by_chi2 ? agreement_of(c, order.front()) : Agreement{kNan, kNan, kNan, kNan};
  v.best_model = best.key;
  v.position = v.position_error = kNan;

  const auto other = std::find_if(order.begin(), order.end(), [&](std::size_t k) {
    return c.results[k].family != best.family;
  });
  std::string runner_up;  // the next one of the winner's own family
  for (std::size_t k : order)
    if (k != order.front() && c.results[k].family == best.family) {
      const Projection p = project(c, c.models[k], c.models[order.front()]);
      const bool apart = beyond_spread(p, c.realizations);
      runner_up = fmt::format("; {} follows{}", describe(c.results[k], by_chi2),
                              apart ? "" : ", not distinguishable from it within the spread");
      break;
    }
  if (other == order.end()) {
    v.sentence =
        fmt::format("Of the {} models, the {} {} nearest to {}{}.", best.family, c.subject(),
                    c.measured() ? "is" : "are", describe(best, by_chi2), runner_up);
    add_misfit(c, best, found, v.sentence);
    add_left_out(c, v.sentence);
    return v;
  }
  Projection p = project(c, c.models[*other], c.models[order.front()]);
  if (!spread) p.error = kNan;
  v.position = p.position;
  v.position_error = p.error;
  v.distinguishable = beyond_spread(p, c.realizations);
  const ModelComparison& loser = c.results[*other];
  const bool agrees = !misses(best) && !(found.ratio > found.chance);
  if (v.distinguishable) {
    v.sentence = fmt::format(
        "{} {}{} the {}: nearest is {}, against {}; on the line from {} (0) to {} (1) {} at {:.2f} "
        "+- {:.2f}{}{}.",
        claim(c, agrees), best.family, agrees ? ", not" : " than to", loser.family,
        describe(best, by_chi2), describe(loser, by_chi2), loser.family, best.family,
        c.measured() ? "it stands" : "they stand", p.position, p.error, beyond_both(c, p),
        runner_up);
  } else if (std::isfinite(p.error)) {
    v.sentence = fmt::format(
        "{} and {} are not distinguishable within {}: nearest is {}, "
        "against {}; on the line from {} (0) to {} (1) the {} at {:.2f} +- {:.2f}{}{}.",
        best.family, loser.family,
        single ? std::string("the errors of this field")
               : fmt::format("the spread of {} realizations", c.realizations),
        describe(best, by_chi2), describe(loser, by_chi2), loser.family, best.family,
        c.measured() ? "measurement stands" : "grains stand", p.position, p.error,
        beyond_both(c, p), runner_up);
    v.sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(v.sentence[0])));
  } else {
    v.sentence = fmt::format(
        "{}: the {} nearest to {}, against {}; on the line from {} (0) to {} (1) {} at {:.2f}{}.",
        c.realizations < 2 ? "One realization, spread unknown"
        : spread ? fmt::format("Mean of {} realizations without their single values, spread of the "
                               "position unknown",
                               c.realizations)
                 : fmt::format("All {} realizations are equal, spread unknown", c.realizations),
        c.measured() ? "measurement is" : "grains are", describe(best, by_chi2),
        describe(loser, by_chi2), loser.family, best.family,
        c.measured() ? "it stands" : "they stand", p.position, beyond_both(c, p));
  }
  add_misfit(c, best, found, v.sentence);
  add_left_out(c, v.sentence);
  return v;
}

}  // namespace grainfield::coupling
