#include "coupling/compare/ring.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "continuum/constants.h"
#include "coupling/statistics/spread.h"

namespace grainfield::coupling {
namespace {

constexpr double kChance = 0.05;

}  // namespace

std::string RingAgainstAxis::word() const {
  if (std::isnan(p)) return "";
  if (p >= kChance) return "neither";
  return difference > 0 ? "ring" : "peak";
}

RingAgainstAxis ring_against_axis(const Eigen::VectorXd& r, const Eigen::MatrixXd& samples,
                                  double least) {
  const Eigen::Index realizations = samples.cols();
  const Eigen::Index beside =
      std::lower_bound(r.data(), r.data() + r.size(), least) - r.data();  // the first one
  if (realizations < least_for_significance || beside == 0 || beside >= r.size() ||
      samples.rows() != r.size() || !samples.allFinite()) {
    return {kNan, kNan, kNan, kNan};
  }
  const Eigen::VectorXd sum = samples.rowwise().sum();
  std::vector<double> differences;
  RingAgainstAxis out;
  for (Eigen::Index k = 0; k < realizations; ++k) {
    const Eigen::VectorXd others = (sum - samples.col(k)).tail(r.size() - beside);
    Eigen::Index largest = 0;
    others.maxCoeff(&largest);
    differences.push_back(samples(beside + largest, k) - samples(0, k));
    out.at += r[beside + largest] / static_cast<double>(realizations);
  }
  const Spread spread = spread_of(differences);
  out.difference = spread.mean;
  out.error = spread.standard_error;
  out.p = 2 * std::min(spread.p_value, 1 - spread.p_value);
  return out;
}

}  // namespace grainfield::coupling
