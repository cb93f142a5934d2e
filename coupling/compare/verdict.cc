#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "continuum/constants.h"
#include "coupling/compare/compare.h"
#include "coupling/judge/judge.h"
#include "coupling/statistics/agreement.h"

namespace grainfield::coupling {
namespace {

// Errors below this share of the signal are rounding: the realizations are copies of one.
constexpr double kCopies = 1e-9;

// A value of a profile.
struct Place {
  std::size_t profile;
  Eigen::Index point;
};

double error_at(const Profile& p, Eigen::Index i) {
  const double error = i < p.error.size() ? p.error[i] : kNan;
  return error > 0 && std::isfinite(error) ? error : kNan;
}

// The profile's root mean square, in which its values count: 1 where it is nothing.
double unit_of(const Profile& p) {
  double sum = 0;
  int count = 0;
  for (const double v : p.mean) {
    if (!std::isfinite(v)) continue;
    sum += v * v;
    ++count;
  }
  return sum > 0 ? std::sqrt(sum / count) : 1;
}

bool sampled(const Comparison& c) {
  return c.realizations > 1 &&
         std::all_of(c.profiles.begin(), c.profiles.end(), [&](const Profile& p) {
           return p.samples.cols() == c.realizations && p.samples.rows() == p.x.size();
         });
}

// Whether the realizations differ at all (those of a perfect lattice do not).
bool has_spread(const Comparison& c) {
  double error = 0, signal = 0;
  for (const Profile& p : c.profiles) {
    for (Eigen::Index i = 0; i < p.x.size(); ++i) {
      if (std::isfinite(p.mean[i])) signal = std::max(signal, std::fabs(p.mean[i]));
      if (const double e = error_at(p, i); e > error) error = e;
    }
  }
  return error > kCopies * signal;
}

// Places whose errors are known, and those that have a value but no error.
struct Places {
  std::vector<Place> all;
  std::size_t without_error = 0;
};

Places places_of(const Comparison& c, ErrorsFrom from) {
  Places out;
  for (std::size_t k = 0; k < c.profiles.size(); ++k) {
    const Profile& p = c.profiles[k];
    for (Eigen::Index i = 0; i < p.x.size(); ++i) {
      if (!std::isfinite(p.mean[i])) continue;
      const bool known = from == ErrorsFrom::realizations ? p.samples.row(i).allFinite()
                         : from == ErrorsFrom::data       ? !std::isnan(error_at(p, i))
                                                          : true;
      if (known)
        out.all.push_back({k, i});
      else
        ++out.without_error;
    }
  }
  return out;
}

// Values that count as one: the components of a place may be tied, and so are places nearer than
// the independent length.
double tied_values(const Comparison& c, const std::vector<Place>& places) {
  double values = 0, independent = 0;
  std::set<std::string> components;
  std::set<std::size_t> seen;
  for (const Place& at : places) {
    ++values;
    if (!seen.insert(at.profile).second) continue;
    const Profile& p = c.profiles[at.profile];
    components.insert(p.quantity);
    const auto count =
        static_cast<double>(std::count_if(places.begin(), places.end(), [&](const Place& other) {
          return other.profile == at.profile;
        }));
    const double length = p.x.maxCoeff() - p.x.minCoeff();
    independent +=
        p.independent_length > 0 ? std::clamp(length / p.independent_length, 1.0, count) : count;
  }
  if (places.empty()) return 1;
  return std::max(1.0, values / independent) * static_cast<double>(components.size());
}

// In what the values at these places count: their profile's root mean square. A value of a field
// with errors of its own counts in its error, so that those known well decide.
Eigen::VectorXd units_of(const Comparison& c, ErrorsFrom from, const std::vector<Place>& places) {
  std::vector<double> of_profile;
  for (const Profile& p : c.profiles) of_profile.push_back(unit_of(p));
  Eigen::VectorXd out(static_cast<Eigen::Index>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& at = places[k];
    out[static_cast<Eigen::Index>(k)] = from == ErrorsFrom::data
                                            ? error_at(c.profiles[at.profile], at.point)
                                            : of_profile[at.profile];
  }
  return out;
}

Evidence evidence_of(const Comparison& c, ErrorsFrom from, const std::vector<Place>& places) {
  Evidence e;
  e.errors_from = from;
  e.realizations = c.realizations;
  const auto n = static_cast<Eigen::Index>(places.size());
  const bool single = from != ErrorsFrom::realizations;
  e.samples.resize(n, single ? 1 : c.realizations);
  e.error = Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd unit = units_of(c, from, places);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Place& at = places[static_cast<std::size_t>(k)];
    const Profile& p = c.profiles[at.profile];
    if (single)
      e.samples(k, 0) = p.mean[at.point] / unit[k];
    else
      e.samples.row(k) = p.samples.row(at.point) / unit[k];
  }
  e.tied = tied_values(c, places);
  return e;
}

Eigen::MatrixXd forecast_of(const Comparison& c, std::size_t model, ErrorsFrom from,
                            const std::vector<Place>& places) {
  Eigen::VectorXd out = units_of(c, from, places).cwiseInverse();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place& at = places[k];
    out[static_cast<Eigen::Index>(k)] *= c.models[model].values[at.profile][at.point];
  }
  return out;
}

// Those of the places where the models have values.
std::vector<Place> common(const Comparison& c, const std::vector<std::size_t>& models,
                          const std::vector<Place>& places) {
  std::vector<Place> out;
  std::copy_if(places.begin(), places.end(), std::back_inserter(out), [&](const Place& at) {
    return std::all_of(models.begin(), models.end(), [&](std::size_t m) {
      return std::isfinite(c.models[m].values[at.profile][at.point]);
    });
  });
  return out;
}

// Profiles on which a model has values, and where the data have.
std::set<std::size_t> profiles_of(const Comparison& c, std::size_t model,
                                  const std::vector<Place>& places) {
  std::set<std::size_t> out;
  for (const Place& at : common(c, {model}, places)) out.insert(at.profile);
  return out;
}

// A model against the places, of one profile or all.
Agreement agreement_of(const Comparison& c, std::size_t model, ErrorsFrom from,
                       const std::vector<Place>& among) {
  const std::vector<Place> places = common(c, {model}, among);
  if (places.empty() || from == ErrorsFrom::nothing) return {kNan, kNan, kNan, kNan};
  const Evidence e = evidence_of(c, from, places);
  const Eigen::VectorXd mean = e.samples.rowwise().mean();
  const Eigen::VectorXd off = mean - forecast_of(c, model, from, places).col(0);
  if (from == ErrorsFrom::data) {
    return agreement(off, e.error, static_cast<int>(std::lround(e.tied)));
  }
  return agreement(off, e.samples.colwise() - mean);
}

void put(const Agreement& found, Measures& m) {
  m.chi2_per_dof = found.ratio;
  m.chance = found.chance;
  m.dof = found.values;
}

}  // namespace

void judge_comparison(Comparison& c) {
  const bool spread = has_spread(c);
  const ErrorsFrom from = !spread      ? ErrorsFrom::nothing
                          : sampled(c) ? ErrorsFrom::realizations
                                       : ErrorsFrom::data;
  const Places places = places_of(c, from);
  std::vector<std::size_t> present;  // models with a value somewhere
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    for (std::size_t k = 0; k < c.profiles.size(); ++k) {
      std::vector<Place> here;
      std::copy_if(places.all.begin(), places.all.end(), std::back_inserter(here),
                   [&](const Place& at) { return at.profile == k; });
      put(agreement_of(c, m, from, here), c.results[m].per_profile[k]);
    }
    put(agreement_of(c, m, from, places.all), c.results[m].overall);
    if (!common(c, {m}, places.all).empty()) present.push_back(m);
  }
  // A model without values on a profile where another one has them is not judged beside it, unless
  // each lacks one.
  std::vector<std::size_t> reached;  // profiles, by model
  std::set<std::size_t> all;
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    std::set<std::size_t> own = profiles_of(c, m, places.all);
    reached.push_back(own.size());
    all.merge(own);
  }
  const bool one_has_all = std::find(reached.begin(), reached.end(), all.size()) != reached.end();
  const auto is_left_out = [&](std::size_t m) { return one_has_all && reached[m] < all.size(); };
  std::erase_if(present, is_left_out);
  const std::vector<Place> shared = common(c, present, places.all);
  std::vector<Candidate> candidates;
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    const Measures& overall = c.results[m].overall;
    Candidate one;
    one.model.name = c.models[m].key;
    one.model.label = c.models[m].label;
    one.model.family = c.models[m].family;
    one.model.misfit = overall.chi2_per_dof;
    one.model.chance = overall.chance;
    one.model.values = overall.dof;
    one.model.rel_l2 = overall.rel_l2;
    const bool has = std::find(present.begin(), present.end(), m) != present.end();
    if (has && !shared.empty()) one.forecast = forecast_of(c, m, from, shared);
    if (is_left_out(m)) one.model.misfit = one.model.chance = one.model.rel_l2 = kNan;
    candidates.push_back(std::move(one));
  }
  c.judgement = judge(evidence_of(c, shared.empty() ? ErrorsFrom::nothing : from, shared),
                      std::move(candidates));
  c.judgement.equal = !spread && c.realizations > 1;
  c.judgement.measured = c.measured();
  for (std::size_t m = 0; m < c.models.size(); ++m) {
    if (!is_left_out(m)) continue;
    c.judgement.doubts.push_back(
        fmt::format("{} has no values on {} of {} profiles, where others have, and is not judged.",
                    c.models[m].label, all.size() - reached[m], all.size()));
  }
  if (from == ErrorsFrom::data && places.without_error > 0) {
    c.judgement.doubts.push_back(fmt::format(
        "{} of {} values have no error and are left out of misfit and position: give them errors.",
        places.without_error, places.without_error + places.all.size()));
  }
}

}  // namespace grainfield::coupling
