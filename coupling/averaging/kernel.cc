#include "coupling/averaging/kernel.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coupling/base/unknown_name.h"

namespace grainfield::coupling {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 30>;

struct Entry {
  std::string name;
  std::unique_ptr<Kernel> (*make)(double width, int dim);
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

double Kernel::marginal(double x) const {
  const double d = std::abs(x), half = std::sqrt(std::max(0.0, range() * range() - d * d));
  if (half <= 0) return 0;
  if (dim() == 2) return along_line(d, -half, half);
  const auto ring = [&](double rho) {
    return 2 * std::numbers::pi * rho * value(std::min(std::hypot(d, rho), range() * (1 - 1e-15)));
  };
  return Gauss::integrate(ring, 0.0, half);
}

double Kernel::beyond(double x) const {
  if (x >= range()) return 0;
  if (x <= -range()) return 1;
  // x = R sin(theta): smooth also for kernels whose side view ends with a vertical tangent.
  const auto piece = [&](double theta) {
    return marginal(range() * std::sin(theta)) * range() * std::cos(theta);
  };
  const double tail =
      Gauss::integrate(piece, std::asin(std::abs(x) / range()), std::numbers::pi / 2);
  return x >= 0 ? tail : 1 - tail;
}

double Kernel::independent_length() const {
  // x = R sin(theta): smooth also for kernels whose side view ends with a vertical tangent.
  const auto squared = [&](double theta) {
    const double m = marginal(range() * std::sin(theta));
    return m * m * range() * std::cos(theta);
  };
  return 1 / (2 * Gauss::integrate(squared, 0.0, std::numbers::pi / 2));
}

namespace {

double across(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(a.x() * b.y() - a.y() * b.x());
}
double across(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.cross(b).norm(); }

template <class Vector>
double weight_of_branch(const Kernel& kernel, const Vector& point, const Vector& a,
                        const Vector& b) {
  const Vector along = b - a, to_point = point - a;
  const double length = along.norm();
  if (length == 0) return kernel.value(to_point.norm());
  const double foot = to_point.dot(along) / length;
  const double d = across(along, to_point) / length;
  const double inside = kernel.range() * kernel.range() - d * d;
  if (inside <= 0) return 0;
  const double half = std::sqrt(inside);
  const double s0 = std::max(-foot, -half), s1 = std::min(length - foot, half);
  return s1 > s0 ? kernel.along_line(d, s0, s1) / length : 0.0;
}

}  // namespace

double branch_weight(const Kernel& kernel, const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                     const Eigen::Vector2d& b) {
  return weight_of_branch(kernel, point, a, b);
}

double branch_weight(const Kernel& kernel, const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                     const Eigen::Vector3d& b) {
  return weight_of_branch(kernel, point, a, b);
}

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Entry& entry : entries()) all.push_back(entry.name);
    return all;
  }();
  return names;
}

std::unique_ptr<Kernel> make_kernel(const std::string& name, double width, int dim) {
  for (const Entry& entry : entries()) {
    if (entry.name != name) continue;
    if (!(width > 0) || !std::isfinite(width))
      throw std::invalid_argument(
          fmt::format("kernel width is {} m; it must be positive and finite", width));
    return entry.make(width, dim);
  }
  throw std::invalid_argument(unknown_name("kernel", name, kernel_names()));
}

}  // namespace grainfield::coupling
