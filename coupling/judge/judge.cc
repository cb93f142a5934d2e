#include "coupling/judge/judge.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "coupling/judge/power.h"

namespace grainfield::coupling {
namespace {

constexpr int kLeastRealizations = 3;
constexpr double kConfidence = 0.95;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::MatrixXd spread_out(const Eigen::MatrixXd& forecast, Eigen::Index columns) {
  return forecast.cols() == columns ? forecast : forecast.replicate(1, columns);
}

// Mean over the realizations; nan where one is empty.
double squared_distance(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other,
                        Eigen::Index columns) {
  if (one.size() == 0 || other.size() == 0) return kNan;
  return (spread_out(one, columns) - spread_out(other, columns)).colwise().squaredNorm().mean();
}

// Squared differences of a forecast from every realization, one by one.
Eigen::VectorXd squares(const Evidence& e, const Eigen::MatrixXd& forecast) {
  return (e.samples - spread_out(forecast, e.samples.cols())).colwise().squaredNorm();
}

struct Difference {
  double mean = kNan, error = kNan;
};

// Mean and standard error of the paired difference of squares of two forecasts.
Difference paired(const Evidence& e, const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
  if (one.size() == 0 || other.size() == 0) return {};
  const Eigen::VectorXd behind = squares(e, one) - squares(e, other);
  const auto r = static_cast<double>(behind.size());
  Difference out{behind.mean(), kNan};
  if (e.errors_from == ErrorsFrom::data) {
    // Linear in the values.
    const Eigen::VectorXd slope = 2 * (other.col(0) - one.col(0));
    out.error = std::sqrt(e.tied) * slope.cwiseProduct(e.error).norm();
  } else if (e.errors_from == ErrorsFrom::realizations && r >= kLeastRealizations) {
    out.error = std::sqrt((behind.array() - out.mean).square().sum() / (r - 1) / r);
  }
  return out;
}

// `distance`: |model - best|^2; `given`: no number is free, so that they must differ enough.
Power foreseen(const Evidence& e, const Difference& behind, double signal, double distance,
               bool given) {
  Power out;
  if (std::fabs(behind.mean) < kSame * signal || distance < kSame * signal) {
    out.same = true;
    out.realizations = out.least = out.most = kInfinity;
  } else {
    out = power_of(PairedDifference{behind.mean, behind.error, given ? distance : kInfinity,
                                    e.realizations, e.errors_from == ErrorsFrom::data});
  }
  out.difference = behind.mean / signal;
  out.error = behind.error / signal;
  return out;
}

const std::string& family_of(const JudgedModel& m) { return m.family.empty() ? m.name : m.family; }

bool contains(const JudgedModel& general, const std::string& special) {
  return std::find(general.special_cases.begin(), general.special_cases.end(), special) !=
         general.special_cases.end();
}

// Where models are judged, one without values is not.
bool kept(bool judged, const JudgedModel& m) {
  return !m.description && (!judged || m.distinguishable == Answer::no);
}

// best, distinguishable and equations from the marked models.
void conclude(bool judged, Judgement& out) {
  const JudgedModel* best = nullptr;
  std::set<std::string> equations, families;
  for (const JudgedModel& m : out.models) {
    if (!m.description) families.insert(family_of(m));
    if (!kept(judged, m)) continue;
    equations.insert(m.equations);
    if (best == nullptr || (judged && m.free < best->free)) best = &m;
  }
  if (best == nullptr) best = &out.models.front();
  out.best = best->name;
  if (equations.size() == 1 && (judged || equations.begin()->empty())) {
    out.equations = *equations.begin();
  } else if (!equations.empty()) {
    out.equations = "not distinguishable";
  }
  if (!judged || out.models.size() < 2) return;
  out.distinguishable = Answer::yes;
  for (const JudgedModel& m : out.models) {
    const bool relative = families.size() > 1 ? family_of(m) == family_of(*best) : &m == best;
    if (kept(judged, m) && !relative && !contains(m, best->name)) out.distinguishable = Answer::no;
  }
}

}  // namespace

const char* text_of(Answer answer) {
  return answer == Answer::unknown ? "unknown" : answer == Answer::yes ? "yes" : "no";
}

Answer JudgedModel::agrees() const {
  if (std::isnan(misfit) || std::isnan(chance)) return Answer::unknown;
  return misfit <= chance ? Answer::yes : Answer::no;
}

const char* JudgedModel::distinguishable_text() const {
  return nearest && distinguishable != Answer::unknown ? "reference" : text_of(distinguishable);
}

Answer JudgedModel::supported() const {
  if (distinguishable == Answer::unknown || agrees() == Answer::unknown) return Answer::unknown;
  return distinguishable == Answer::no && agrees() == Answer::yes && !description ? Answer::yes
                                                                                  : Answer::no;
}

const JudgedModel* Judgement::find(const std::string& name) const {
  const auto at = std::find_if(models.begin(), models.end(),
                               [&](const JudgedModel& m) { return m.name == name; });
  return at == models.end() ? nullptr : &*at;
}

const JudgedModel& Judgement::best_model() const {
  const JudgedModel* found = find(best);
  if (found == nullptr) throw std::logic_error("judgement: no model " + best);
  return *found;
}

double least_errors(int realizations) {
  if (realizations == 1) return 1.96;
  if (realizations < kLeastRealizations) return kInfinity;
  return boost::math::quantile(boost::math::students_t(realizations - 1.0), (1 + kConfidence) / 2);
}

void mark_distinguishable(std::vector<JudgedModel>& models, const std::vector<double>& apart,
                          double least_errors) {
  for (std::size_t k = 0; k < models.size(); ++k) {
    JudgedModel& m = models[k];
    const double spread = least_errors * m.behind_error;
    const bool behind = k > 0 && m.behind > kSame && m.behind > spread && 2 * apart[k] > spread &&
                        !(m.heights_behind < -kSame) &&  // false for nan
                        !(m.aic_behind <= kNoSupport);
    const bool unseen = std::isnan(m.behind) && !std::isnan(models.front().behind);
    m.distinguishable = unseen ? Answer::unknown : behind ? Answer::yes : Answer::no;
  }
  const std::vector<JudgedModel> judged = models;
  for (std::size_t k = 1; k < models.size(); ++k) {
    for (const JudgedModel& other : judged) {
      if (other.distinguishable == Answer::yes && models[k].behind > other.behind - kSame &&
          !(models[k].heights_behind < other.heights_behind - kSame)) {
        models[k].distinguishable = Answer::yes;
      }
    }
  }
}

void judge_at_widths(const std::vector<double>& diameters,
                     const std::function<Judgement(double)>& again, Judgement& judgement) {
  for (const double width : diameters) {
    AtWidth& at = judgement.widths.emplace_back();
    at.diameters = width;
    try {
      const Judgement there = again(width);
      at.best = there.best;
      at.distinguishable = there.distinguishable;
      at.agrees = there.best_model().agrees();
    } catch (const std::invalid_argument& e) {
      at.why = e.what();
    }
  }
}

Judgement judge(const Evidence& e, std::vector<Candidate> candidates) {
  if (candidates.empty()) throw std::invalid_argument("judge: no model");
  const bool judged =
      e.errors_from == ErrorsFrom::data ||
      (e.errors_from == ErrorsFrom::realizations && e.realizations >= kLeastRealizations);
  const bool single = e.errors_from == ErrorsFrom::data;
  const bool any_free = std::any_of(candidates.begin(), candidates.end(),
                                    [](const Candidate& c) { return c.model.free > 0; });
  const double signal = e.samples.rowwise().mean().squaredNorm();
  for (Candidate& c : candidates) {
    if (c.forecast.size() == 0) continue;
    c.model.score = (squares(e, c.forecast).mean() + (single ? c.taken : 0)) / signal;
  }
  // Descriptions and models without values come last.
  const auto rank = [&](const Candidate& c) {
    const double value = judged ? c.model.score : c.model.rel_l2;
    return std::isnan(value) ? kInfinity : value;
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) {
                     if (a.model.description != b.model.description) return b.model.description;
                     return rank(a) < rank(b);
                   });
  Judgement out;
  out.errors_from = e.errors_from;
  out.realizations = e.realizations;
  const Candidate& nearest = candidates.front();
  std::vector<double> apart;
  for (const Candidate& c : candidates) {
    JudgedModel m = c.model;
    if (!judged) m.chance = kNan;  // two realizations do not tell how they scatter
    if (judged && c.forecast.size() > 0) {
      m.behind = m.score - nearest.model.score;
      m.behind_error = paired(e, c.forecast, nearest.forecast).error / signal;
      const Difference heights = paired(e, c.heights, nearest.heights);
      m.heights_behind = heights.mean / signal;
      m.heights_error = heights.error / signal;
      if (single && any_free) m.aic_behind = c.akaike - nearest.akaike;
    }
    apart.push_back(any_free ? kInfinity
                             : squared_distance(c.forecast, nearest.forecast, e.samples.cols()) /
                                   signal);
    m.nearest = &c == &nearest;
    out.models.push_back(std::move(m));
  }
  if (judged) {
    mark_distinguishable(out.models, apart, least_errors(e.realizations));
    std::stable_partition(out.models.begin(), out.models.end(),
                          [](const JudgedModel& m) { return kept(true, m); });
  }
  conclude(judged, out);

  const JudgedModel& best = out.best_model();
  const auto forecast = [&](const std::string& name) -> const Eigen::MatrixXd& {
    return std::find_if(candidates.begin(), candidates.end(),
                        [&](const Candidate& c) { return c.model.name == name; })
        ->forecast;
  };
  const Eigen::MatrixXd& own = forecast(best.name);
  for (JudgedModel& m : out.models) {
    if (m.name == best.name || std::isnan(m.score)) continue;
    const Difference behind = paired(e, forecast(m.name), own);
    const double distance = squared_distance(forecast(m.name), own, e.samples.cols());
    if (judged) m.power = foreseen(e, behind, signal, distance, !any_free);
    if (!out.rival.empty() || m.description || family_of(m) == family_of(best) ||
        contains(m, best.name)) {
      continue;
    }
    out.rival = m.name;
    if (any_free || !(distance > 0)) continue;
    out.position = {family_of(m), family_of(best), 0.5 + behind.mean / (2 * distance),
                    behind.error / (2 * distance)};
  }
  return out;
}

}  // namespace grainfield::coupling
