#include "coupling/statistics/moments.h"

#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {

Moments moments(const Eigen::VectorXd& numbers) {
  Moments result{static_cast<int>(numbers.size()), kNan, kNan, kNan};
  if (numbers.size() == 0) return result;
  const double n = static_cast<double>(numbers.size());
  result.mean = numbers.sum() / n;
  if (numbers.size() < 2) return result;
  result.deviation = std::sqrt((numbers.array() - result.mean).square().sum() / (n - 1));
  result.error = result.deviation / std::sqrt(n);
  return result;
}

}  // namespace grainfield::coupling
