#include "coupling/judge/power.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

namespace grainfield::coupling {
namespace {

constexpr double kFoundLevel = 0.95, kPower = 0.8;
constexpr double kFewestOfAll = 3, kMostOfAll = 1e6;
constexpr double kKnownErrors = 1.96;  // errors, of kFoundLevel, where they are known
// Standard deviations: kFewestOfAll find larger differences.
constexpr double kMostSize = 6;
constexpr double kNever = std::numeric_limits<double>::infinity();

double errors_at(double realizations) {
  return boost::math::quantile(boost::math::students_t(realizations - 1), (1 + kFoundLevel) / 2);
}

// Fewest realizations with a power of kPower; `power` grows with their number.
template <class Function>
double fewest(const Function& power) {
  double low = kFewestOfAll, high = low;
  if (power(low) >= kPower) return low;
  while (power(high) < kPower) {
    low = high;
    high *= 2;
    if (high > kMostOfAll) return kNever;
  }
  while (high - low > 0.01 * low && high - low > 0.1) {
    const double middle = (low + high) / 2;
    (power(middle) < kPower ? low : high) = middle;
  }
  return high;
}

// Share of ensembles like this one whose difference, over its error and without its sign, is at
// most `found`, if the true one is `size` standard deviations. Decreasing in size.
double share_below(double found, double size, const PairedDifference& d) {
  const double shift = size * std::sqrt(static_cast<double>(d.realizations));
  if (d.error_is_known) {
    const boost::math::normal normal(shift);
    return boost::math::cdf(normal, found) - boost::math::cdf(normal, -found);
  }
  const boost::math::non_central_t t(d.realizations - 1, shift);
  return boost::math::cdf(t, found) - boost::math::cdf(t, -found);
}

// The size, standard deviations, of which this share of ensembles finds a smaller difference; 0
// where chance alone finds larger ones too often.
double size_at(double share, double found, const PairedDifference& d) {
  const double low = 0, high = kMostSize;
  if (share_below(found, low, d) <= share) return low;
  if (share_below(found, high, d) >= share) return high;
  std::uintmax_t steps = 50;
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double size) { return share_below(found, size, d) - share; }, low, high,
      [](double a, double b) { return std::fabs(b - a) < 1e-4; }, steps);
  return (below + above) / 2;
}

// Fewest realizations whose error is below the models' distance, `apart` standard deviations as
// they were found; `spread`: the true standard deviation over the found one.
double realizations_for_distance(double apart, double spread, const PairedDifference& d) {
  const double distance = 2 * apart / spread;
  if (d.error_is_known) return std::pow(kKnownErrors / distance, 2);
  return fewest([&](double n) {
    const double most = std::sqrt(n) * distance / errors_at(n);
    return boost::math::cdf(boost::math::chi_squared(n - 1), (n - 1) * most * most);
  });
}

// The true standard deviation over the found one, of which this share of ensembles finds a smaller
// one.
double spread_at(double share, const PairedDifference& d) {
  if (d.error_is_known) return 1;
  const double free = d.realizations - 1;
  return std::sqrt(free / boost::math::quantile(boost::math::chi_squared(free), share));
}

}  // namespace

double realizations_for_power(double mean, double deviation) {
  if (!(std::fabs(mean) > 0)) return kNever;
  if (!(deviation > 0)) return kFewestOfAll;
  return fewest([&](double n) {
    const double shift = std::min(std::sqrt(n) * std::fabs(mean) / deviation, 30.0);
    return boost::math::cdf(complement(boost::math::non_central_t(n - 1, shift), errors_at(n)));
  });
}

Power power_of(const PairedDifference& d) {
  Power out;
  if (std::isnan(d.error)) return out;
  const double root = std::sqrt(static_cast<double>(d.realizations));
  // More than any ensemble finds of the largest size.
  const double most = 2 * kMostSize * root;
  const auto in_errors = [&](double value) {
    return d.error > 0 ? std::min(value / d.error, most) : most;
  };
  const double found = in_errors(std::fabs(d.mean)), apart = in_errors(d.distance) / root;
  const auto number = [&](double size_share, double spread_share) {
    return std::max(realizations_for_power(size_at(size_share, found, d), 1),
                    realizations_for_distance(apart, spread_at(spread_share, d), d));
  };
  const double low = (1 - kForesight) / 2, high = (1 + kForesight) / 2;
  out.realizations = number(0.5, 0.5);
  out.least = number(low, high);
  out.most = number(high, low);
  return out;
}

}  // namespace grainfield::coupling
