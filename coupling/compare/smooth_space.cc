#include "coupling/compare/smooth_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// As in smooth.cc: nodes stay inside the model, and how near the load counts as near.
constexpr double kInsideBase = 1e-9, kNearLoad = 1.5;
constexpr double kPi = std::numbers::pi;

struct Weighted {
  double at, weight;
};

// Gauss-Legendre on [a, b].
std::vector<Weighted> gauss_points(int n, double a, double b) {
  std::vector<Weighted> out;
  for (const double zero : boost::math::legendre_p_zeros<double>(n)) {
    const double slope = boost::math::legendre_p_prime(n, zero);
    const double weight = (b - a) / ((1 - zero * zero) * slope * slope);
    out.push_back({(a + b) / 2 + (b - a) / 2 * zero, weight});
    if (zero > 0) out.push_back({(a + b) / 2 - (b - a) / 2 * zero, weight});
  }
  return out;
}

struct SpaceNode {
  Vector3d at;
  double weight;
};

// About `centre`, along directions within `angle` of `axis`: radius, angle from the axis, round it.
template <class Add>
void each_in_cone(const Vector3d& axis, double angle, double r0, double r1, int n, int round,
                  Add&& add) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis);
  for (const Weighted& c : gauss_points(n, std::cos(angle), 1)) {
    const double s = std::sqrt(std::max(0.0, 1 - c.at * c.at));
    for (int k = 0; k < round; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / round;
      const Vector3d direction = turn * Vector3d(s * std::cos(phi), s * std::sin(phi), c.at);
      for (const Weighted& r : gauss_points(n, r0, r1))
        add(r.at * direction, r.at * r.at * r.weight * c.weight * 2 * kPi / round);
    }
  }
}

}  // namespace

Eigen::MatrixXd smooth_in_space(const StressFunction& stress, const Eigen::MatrixXd& points,
                                const Kernel& kernel, double depth, int rings) {
  if (points.cols() != 3 || kernel.dim() != 3)
    throw std::invalid_argument("smoothing in space needs points and a kernel of space");
  if (rings < 1) throw std::invalid_argument("smoothing needs at least one node");
  const double range = kernel.range();
  std::vector<SpaceNode> ball;
  double total = 0;
  each_in_cone(Vector3d::UnitZ(), kPi, 0, range, rings, 2 * rings,
               [&](const Vector3d& offset, double volume) {
                 ball.push_back({offset, volume * kernel.value(offset.norm())});
                 total += ball.back().weight;
               });
  for (SpaceNode& node : ball) node.weight /= total;
  std::vector<Vector3d> where;
  std::vector<double> weights;
  std::vector<Index> owner;
  const auto add = [&](Index point, Vector3d at, double weight) {
    if (at.z() >= 0 || weight == 0) return;
    if (depth > 0) at.z() = std::max(at.z(), -depth * (1 - kInsideBase));
    where.push_back(at);
    weights.push_back(weight);
    owner.push_back(point);
  };
  for (Index p = 0; p < points.rows(); ++p) {
    const Vector3d point = points.row(p).transpose();
    const double distance = point.norm();
    if (distance < kNearLoad * range && point.z() <= 0) {
      const bool inside = distance <= range;
      each_in_cone(inside ? Vector3d(0, 0, -1) : Vector3d(point / distance),
                   inside ? kPi / 2 : std::asin(range / distance), std::max(0.0, distance - range),
                   distance + range, 3 * rings, 6 * rings, [&](const Vector3d& at, double volume) {
                     add(p, at, volume * kernel.value((at - point).norm()));
                   });
      continue;
    }
    for (const SpaceNode& node : ball) add(p, point + node.at, node.weight);
  }
  Eigen::MatrixXd nodes(static_cast<Index>(where.size()), 3);
  for (std::size_t k = 0; k < where.size(); ++k)
    nodes.row(static_cast<Index>(k)) = where[k].transpose();
  const Eigen::MatrixXd values = stress(nodes);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(points.rows(), values.cols());
  for (std::size_t k = 0; k < where.size(); ++k)
    out.row(owner[k]) += weights[k] * values.row(static_cast<Index>(k));
  return out;
}

}  // namespace grainfield::coupling
