// How well the judge foresees, from few realizations, how many would distinguish two models.
#pragma once
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "coupling/compare/compare.h"
#include "coupling/judge/judge.h"
#include "coupling/judge/power.h"
#include "coupling/tasks/compare_task.h"
#include "dem/random/random.h"

namespace grainfield::coupling::test {

/// Share of draws, and what it is a share of.
struct Foresight {
  int draws = 0;
  int near = 0;      ///< foreseen and needed within a factor of 1.5
  int inside = 0;    ///< needed within least and most
  int too_many = 0;  ///< foreseen above needed
  int too_few = 0;   ///< below
  std::vector<double> foreseen, needed;

  void add(const Power& power, double truth) {
    const double number = std::ceil(power.realizations);
    ++draws;
    near += number <= 1.5 * truth && truth <= 1.5 * number;
    inside += std::ceil(power.least) <= truth && truth <= std::ceil(power.most);
    too_many += number > truth;
    too_few += number < truth;
    foreseen.push_back(number);
    needed.push_back(truth);
  }
};

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// One value with this mean over its standard deviation, normal, in so many realizations.
inline Evidence normal_evidence(double mean, int realizations, dem::Random& random) {
  Evidence e;
  e.samples.resize(1, realizations);
  for (double& v : e.samples.reshaped()) {
    double sum = -6;  // of twelve uniform numbers
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    v = mean + sum;
  }
  e.errors_from = ErrorsFrom::realizations;
  e.realizations = realizations;
  return e;
}

/// Two models far from each other whose paired difference has this mean over its standard
/// deviation.
inline Judgement normal_difference(double size, int realizations, dem::Random& random) {
  std::vector<Candidate> two(2);
  for (std::size_t k = 0; k < 2; ++k) {
    two[k].model.name = two[k].model.label = k == 0 ? "a" : "b";
    two[k].forecast = Eigen::MatrixXd::Constant(1, 1, k == 0 ? 10 : -10);
  }
  return judge(normal_evidence(size, realizations, random), two);
}

/// The first `size` of the realizations `among`, shuffled; they are moved to its front.
inline std::vector<int> draw(std::vector<int>& among, int size, dem::Random& random) {
  const auto n = static_cast<int>(among.size());
  for (int k = 0; k < size; ++k) {
    const int other = std::min(k + static_cast<int>(random.uniform() * (n - k)), n - 1);
    std::swap(among[static_cast<std::size_t>(k)], among[static_cast<std::size_t>(other)]);
  }
  return {among.begin(), among.begin() + size};
}

/// Fields of many realizations with models, judged by parts of them.
class ManyRealizations {
 public:
  /// `file`: of responses to a load, with the values of single realizations.
  ManyRealizations(const std::string& file, const std::vector<std::string>& models) {
    CompareRequest request;
    request.file = file;
    request.models = models;
    all_ = run_compare(request).comparison;
  }

  int realizations() const { return all_.realizations; }
  const std::vector<ModelProfiles>& models() const { return all_.models; }

  /// The verdict of these realizations on these models, by number.
  Judgement judged(const std::vector<int>& realizations,
                   const std::vector<std::size_t>& models) const {
    const double n = static_cast<double>(realizations.size());
    Comparison c;
    c.realizations = static_cast<int>(realizations.size());
    c.scale = all_.scale;
    for (const Profile& p : all_.profiles) {
      Profile& own = c.profiles.emplace_back(p);
      own.samples = p.samples(Eigen::all, realizations);
      own.mean = own.samples.rowwise().mean();
      own.error =
          ((own.samples.colwise() - own.mean).rowwise().squaredNorm() / (n - 1) / n).cwiseSqrt();
    }
    for (const std::size_t m : models) {
      c.models.push_back(all_.models[m]);
      ModelComparison& result = c.results.emplace_back();
      result.per_profile.resize(c.profiles.size());
    }
    judge_comparison(c);
    return c.judgement;
  }

  /// Fewest realizations of which 80 in 100 draws out of `among` distinguish the two models;
  /// infinite: more than three quarters of them.
  double needed(std::vector<int> among, const std::vector<std::size_t>& two, int tries,
                dem::Random& random) const {
    const auto found = [&](int size) {
      int count = 0;
      for (int k = 0; k < tries; ++k) {
        count += judged(draw(among, size, random), two).distinguishable == Answer::yes;
      }
      return count >= 0.8 * tries;
    };
    const int most = static_cast<int>(3 * among.size()) / 4;
    int low = 2, high = 4;
    while (!found(high)) {
      low = high;
      if (high == most) return std::numeric_limits<double>::infinity();
      high = std::min(2 * high, most);
    }
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (found(middle) ? high : low) = middle;
    }
    return high;
  }

  /// One more draw of 8: foreseen from them, needed of the rest.
  void strike(const std::vector<std::size_t>& two, int tries, dem::Random& random,
              Foresight& out) const {
    std::vector<int> all(static_cast<std::size_t>(realizations()));
    std::iota(all.begin(), all.end(), 0);
    const std::vector<int> few = draw(all, 8, random);
    const Judgement j = judged(few, two);
    const JudgedModel& rival = j.models.front().name == j.best ? j.models.back() : j.models.front();
    out.add(rival.power, needed({all.begin() + 8, all.end()}, two, tries, random));
  }

 private:
  Comparison all_;
};

}  // namespace grainfield::coupling::test
