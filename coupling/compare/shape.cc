#include "coupling/compare/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "continuum/constants.h"

namespace grainfield::coupling {
namespace {

constexpr double least_relative_prominence =
    0.05;                           // of the largest value: what an eye calls a peak
constexpr double least_errors = 2;  // prominence in standard errors: about 95 %

struct Resampled {
  double x, value, error;
};

// Height of `at` above the higher of the lowest points that separate it from higher ground. Of two
// equal heights the left one is the higher: else a dent between them, however shallow, would make
// two peaks of one.
double prominence(const std::vector<Resampled>& s, std::size_t at) {
  const double height = s[at].value;
  double left = height, right = height;
  for (std::size_t k = at; k-- > 0 && s[k].value < height;) left = std::min(left, s[k].value);
  for (std::size_t k = at + 1; k < s.size() && s[k].value <= height; ++k)
    right = std::min(right, s[k].value);
  return height - std::max(left, right);
}

int count_peaks(const std::vector<Resampled>& s, double largest) {
  int peaks = 0;
  for (std::size_t k = 1; k + 1 < s.size(); ++k) {
    if (s[k].value <= s[k - 1].value) continue;
    std::size_t end = k;  // of a plateau
    while (end + 1 < s.size() && s[end + 1].value == s[k].value) ++end;
    if (end + 1 == s.size() || s[end + 1].value > s[k].value) continue;
    const double noise = std::isfinite(s[k].error) ? least_errors * s[k].error : 0;
    if (prominence(s, k) > std::max(noise, least_relative_prominence * largest)) ++peaks;
  }
  return peaks;
}

double crossing(const Resampled& low, const Resampled& high, double level) {
  return low.x + (high.x - low.x) * (level - low.value) / (high.value - low.value);
}

double half_width(const std::vector<Resampled>& s, double level) {
  std::size_t first = 0, last = s.size() - 1;
  while (s[first].value < level) ++first;
  while (s[last].value < level) --last;
  if (first == 0 || last + 1 == s.size()) return kNan;
  return crossing(s[last + 1], s[last], level) - crossing(s[first - 1], s[first], level);
}

}  // namespace

ProfileShape profile_shape(const Eigen::VectorXd& x, const Eigen::VectorXd& value,
                           const Eigen::VectorXd& error) {
  if (x.size() != value.size() || (error.size() != 0 && error.size() != x.size()))
    throw std::invalid_argument(fmt::format("a profile of {} positions, {} values and {} errors",
                                            x.size(), value.size(), error.size()));
  std::vector<Resampled> s;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (k > 0 && !(x[k] > x[k - 1]))
      throw std::invalid_argument(
          fmt::format("a profile's positions must ascend; {} m follows {} m", x[k], x[k - 1]));
    if (std::isfinite(value[k])) s.push_back({x[k], value[k], error.size() ? error[k] : kNan});
  }
  if (s.size() < 3)
    throw std::invalid_argument(
        fmt::format("a profile has {} values; its shape needs at least 3", s.size()));

  ProfileShape shape;
  const auto top = std::max_element(
      s.begin(), s.end(), [](const Resampled& a, const Resampled& b) { return a.value < b.value; });
  shape.peak = top->value;
  shape.peak_at = top->x;
  shape.fwhm = shape.peak > 0 ? half_width(s, shape.peak / 2) : kNan;
  shape.peaks = shape.peak > 0 ? count_peaks(s, shape.peak) : 0;
  double first = 0, second = 0;
  for (std::size_t k = 1; k < s.size(); ++k) {
    const double step = (s[k].x - s[k - 1].x) / 2;
    const auto moment = [&](auto power) {
      return step * (power(s[k - 1].x) * s[k - 1].value + power(s[k].x) * s[k].value);
    };
    shape.integral += moment([](double) { return 1.0; });
    first += moment([](double at) { return at; });
    second += moment([](double at) { return at * at; });
  }
  const double mean = first / shape.integral;
  const double variance = second / shape.integral - mean * mean;
  shape.rms_width = shape.integral > 0 && variance >= 0 ? std::sqrt(variance) : kNan;
  return shape;
}

ProfileShape shape_errors(const Eigen::VectorXd& x, const Eigen::MatrixXd& samples) {
  const Eigen::Index n = samples.cols();
  const Eigen::VectorXd sum = samples.rowwise().sum();
  if (n < 2 || sum.array().isFinite().count() < 3) return {kNan, kNan, kNan, kNan, 0, kNan};
  Eigen::Matrix<double, 4, Eigen::Dynamic> without(4, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const ProfileShape s =
        profile_shape(x, (sum - samples.col(r)) / static_cast<double>(n - 1), {});
    without.col(r) << s.peak, s.fwhm, s.rms_width, s.integral;
  }
  const Eigen::Vector4d centre = without.rowwise().mean();
  const Eigen::Vector4d squares = (without.colwise() - centre).rowwise().squaredNorm();
  const double share = static_cast<double>(n - 1) / static_cast<double>(n);
  const Eigen::Vector4d error = (share * squares).cwiseSqrt();
  return {error[0], kNan, error[1], error[2], 0, error[3]};
}

}  // namespace grainfield::coupling
