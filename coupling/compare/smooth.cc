#include "coupling/compare/smooth.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "coupling/compare/quadrature.h"

namespace grainfield::coupling {
namespace {

void check(const Eigen::MatrixXd& points, int nodes) {
  if (points.cols() != 2) throw std::invalid_argument("smoothing needs points of the plane");
  if (nodes < 1) throw std::invalid_argument("smoothing needs at least one node");
}

struct PlaneNode {
  Eigen::RowVector2d offset;
  double weight;
};

void normalise(std::vector<PlaneNode>& nodes) {
  double total = 0;
  for (const PlaneNode& node : nodes) total += node.weight;
  for (PlaneNode& node : nodes) node.weight /= total;
}

// Near the load the stress grows as 1/distance: polar coordinates about the load take the growth
// away, and the kernel is what varies over the nodes.
void add_around_load(NodeList& plan, Eigen::Index point, const Eigen::RowVector2d& at,
                     const Kernel& kernel, double depth, int nodes_per_axis) {
  const double distance = at.norm(), range = kernel.range(), pi = std::numbers::pi;
  const double r0 = std::max(0.0, distance - range), r1 = distance + range;
  double from = -pi, to = 0;
  if (distance > range) {
    const double direction = std::atan2(at.y(), at.x()), half = std::asin(range / distance);
    from = std::max(from, direction - half);
    to = std::min(to, direction + half);
  }
  const std::vector<Node> nodes = gauss_points(nodes_per_axis);
  for (const Node& radial : nodes)
    for (const Node& angular : nodes) {
      const double r = (r0 + r1) / 2 + (r1 - r0) / 2 * radial.at;
      const double angle = (from + to) / 2 + (to - from) / 2 * angular.at;
      Eigen::RowVector2d node(r * std::cos(angle), r * std::sin(angle));
      const double value = kernel.value((node - at).norm());
      if (value == 0) continue;
      if (depth > 0) node.y() = std::max(node.y(), -depth * (1 - kInsideBase));
      plan.add(point, node,
               value * r * radial.weight * angular.weight * (r1 - r0) / 2 * (to - from) / 2);
    }
}

}  // namespace

SmoothingNodes nodes_in_plane(const Eigen::MatrixXd& points, const Kernel& kernel, double depth,
                              int rings) {
  check(points, rings);
  const int directions = 2 * rings + 2;
  std::vector<PlaneNode> nodes;
  for (const Node& ring : gauss_points(rings)) {
    const double r = kernel.range() * (1 + ring.at) / 2;
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / directions;
      nodes.push_back({r * Eigen::RowVector2d(std::cos(angle), std::sin(angle)),
                       ring.weight * r * kernel.value(r)});
    }
  }
  normalise(nodes);
  NodeList plan(2);
  for (Eigen::Index p = 0; p < points.rows(); ++p) {
    const Eigen::RowVector2d point = points.row(p);
    if (point.norm() < kNearLoad * kernel.range() && point.y() <= 0) {
      add_around_load(plan, p, point, kernel, depth, 4 * rings);
      continue;
    }
    for (const PlaneNode& node : nodes) {
      Eigen::RowVector2d at = point + node.offset;
      if (at.y() >= 0) continue;
      if (depth > 0) at.y() = std::max(at.y(), -depth * (1 - kInsideBase));
      plan.add(p, at, node.weight);
    }
  }
  return plan.of_points(points.rows());
}

SmoothingNodes nodes_along_x(const Eigen::MatrixXd& points, const Kernel& kernel, int count) {
  check(points, count);
  std::vector<PlaneNode> nodes;
  // x = R sin(theta) keeps the integrand smooth where the marginal ends steeply.
  for (const Node& node : gauss_points(count)) {
    const double theta = node.at * std::numbers::pi / 2, x = kernel.range() * std::sin(theta);
    nodes.push_back({Eigen::RowVector2d(x, 0), node.weight * kernel.marginal(x) * std::cos(theta)});
  }
  normalise(nodes);
  NodeList plan(2);
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    for (const PlaneNode& node : nodes)
      plan.add(p, Eigen::RowVector2d(points.row(p) + node.offset), node.weight);
  return plan.of_points(points.rows());
}

}  // namespace grainfield::coupling
