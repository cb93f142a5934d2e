#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/averaging/base_space.h"
#include "coupling/compare/quadrature.h"
#include "coupling/compare/smooth.h"

namespace grainfield::coupling {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

struct SpaceNode {
  Vector3d at;
  double weight;
};

// About `centre`, along directions within `angle` of `axis`: radius, angle from the axis, round it.
template <class Add>
void each_in_cone(const Vector3d& axis, double angle, double r0, double r1, int n, int round,
                  Add&& add) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis);
  const std::vector<Node> radii = gauss_points(n, r0, r1);
  for (const Node& c : gauss_points(n, std::cos(angle), 1)) {
    const double s = std::sqrt(std::max(0.0, 1 - c.at * c.at));
    for (int k = 0; k < round; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / round;
      const Vector3d direction = turn * Vector3d(s * std::cos(phi), s * std::sin(phi), c.at);
      for (const Node& r : radii)
        add(r.at * direction, r.at * r.at * r.weight * c.weight * 2 * kPi / round);
    }
  }
}

}  // namespace

SmoothingNodes nodes_in_space(const Eigen::MatrixXd& points, const Kernel& kernel, double depth,
                              int rings) {
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
  NodeList plan(3);
  const auto add = [&](Index point, Vector3d at, double weight) {
    if (at.z() >= 0 || weight == 0) return;
    if (depth > 0) at.z() = std::max(at.z(), -depth * (1 - kInsideBase));
    plan.add(point, at.transpose(), weight);
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
  return plan.of_points(points.rows());
}

SmoothingNodes nodes_over_plane(const Eigen::MatrixXd& points, const Kernel& kernel, int rings) {
  if (points.cols() != 3 || kernel.dim() != 3)
    throw std::invalid_argument("smoothing in space needs points and a kernel of space");
  if (rings < 1) throw std::invalid_argument("smoothing needs at least one node");
  std::vector<SpaceNode> disk;
  double total = 0;
  const int round = 2 * rings + 2;
  for (const Node& r : gauss_points(rings, 0, kernel.range())) {
    const double weight = r.at * r.weight * seen_from_above(kernel, r.at);
    for (int k = 0; k < round; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / round;
      disk.push_back({Vector3d(r.at * std::cos(phi), r.at * std::sin(phi), 0), weight});
      total += weight;
    }
  }
  NodeList plan(3);
  for (Index p = 0; p < points.rows(); ++p) {
    for (const SpaceNode& node : disk) {
      plan.add(p, points.row(p) + node.at.transpose(), node.weight / total);
    }
  }
  return plan.of_points(points.rows());
}

}  // namespace grainfield::coupling
