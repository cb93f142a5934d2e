#include "coupling/statistics/spread.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "continuum/constants.h"

namespace grainfield::coupling {

Spread spread_of(const std::vector<double>& values) {
  Spread out{kNan, kNan, kNan, static_cast<int>(values.size())};
  if (values.empty()) return out;
  const auto n = static_cast<double>(values.size());
  double sum = 0, square = 0;
  for (const double v : values) sum += v;
  out.mean = sum / n;
  if (values.size() < 2) return out;
  for (const double v : values) square += (v - out.mean) * (v - out.mean);
  out.standard_error = std::sqrt(square / (n - 1) / n);
  if (out.values < least_for_significance || !(out.standard_error > 0)) return out;
  const boost::math::students_t t(n - 1);
  out.p_value = cdf(complement(t, out.mean / out.standard_error));
  return out;
}

}  // namespace grainfield::coupling
