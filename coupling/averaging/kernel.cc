#include "coupling/averaging/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/averaging/kernels.h"
#include "coupling/averaging/nearest.h"

namespace grainfield::coupling {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 30>;

struct Entry {
  std::string name;
  std::unique_ptr<Kernel> (*make)(double width);
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"lucy", make_lucy},
      {"gaussian", make_gaussian},
      {"heaviside", make_heaviside},
  };
  return all;
}

}  // namespace

double Kernel::along_line(double d, double s0, double s1) const {
  const auto weight = [&](double s) { return value(std::hypot(d, s)); };
  if (s0 >= 0 || s1 <= 0) return Gauss::integrate(weight, s0, s1);
  return Gauss::integrate(weight, s0, 0.0) + Gauss::integrate(weight, 0.0, s1);
}

double Kernel::slope(double r) const {
  const double step = 1e-5 * range();  // error of the difference near 1e-10 of value / range
  return (value(r + step) - value(std::abs(r - step))) / (2 * step);
}

double Kernel::standard_deviation() const {
  // Variance along one axis: half of the mean of r^2.
  const auto weight = [&](double r) { return std::numbers::pi * r * r * r * value(r); };
  return std::sqrt(Gauss::integrate(weight, 0.0, range()));
}

double Kernel::marginal(double x) const {
  const double d = std::abs(x), half = std::sqrt(std::max(0.0, range() * range() - d * d));
  return half > 0 ? along_line(d, -half, half) : 0.0;
}

double Kernel::independent_length() const {
  // x = R sin(theta): smooth also for kernels whose side view ends with a vertical tangent.
  const auto squared = [&](double theta) {
    const double m = marginal(range() * std::sin(theta));
    return m * m * range() * std::cos(theta);
  };
  return 1 / (2 * Gauss::integrate(squared, 0.0, std::numbers::pi / 2));
}

double branch_weight(const Kernel& kernel, const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                     const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a, to_point = point - a;
  const double length = along.norm();
  if (length == 0) return kernel.value(to_point.norm());
  const double foot = to_point.dot(along) / length;
  const double d = std::abs(along.x() * to_point.y() - along.y() * to_point.x()) / length;
  const double inside = kernel.range() * kernel.range() - d * d;
  if (inside <= 0) return 0;
  const double half = std::sqrt(inside);
  const double s0 = std::max(-foot, -half), s1 = std::min(length - foot, half);
  return s1 > s0 ? kernel.along_line(d, s0, s1) / length : 0.0;
}

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Entry& entry : entries()) all.push_back(entry.name);
    return all;
  }();
  return names;
}

std::unique_ptr<Kernel> make_kernel(const std::string& name, double width) {
  for (const Entry& entry : entries()) {
    if (entry.name != name) continue;
    if (!(width > 0) || !std::isfinite(width))
      throw std::invalid_argument(
          fmt::format("kernel width is {} m; it must be positive and finite", width));
    return entry.make(width);
  }
  throw std::invalid_argument(unknown_name("kernel", name, kernel_names()));
}

}  // namespace grainfield::coupling
