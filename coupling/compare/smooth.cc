#include "coupling/compare/smooth.h"

#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace grainfield::coupling {
namespace {

// The base is at -depth up to this share of the depth inside, so that rounding cannot put a node
// outside the model's domain.
constexpr double inside_base = 1e-9;

struct Node {
  double at, weight;
};

// Gauss-Legendre on [-1, 1].
std::vector<Node> gauss_legendre(int n) {
  std::vector<Node> nodes;
  for (double zero : boost::math::legendre_p_zeros<double>(n)) {
    const double slope = boost::math::legendre_p_prime(n, zero);
    const double weight = 2 / ((1 - zero * zero) * slope * slope);
    nodes.push_back({zero, weight});
    if (zero > 0) nodes.push_back({-zero, weight});
  }
  return nodes;
}

void check(const Eigen::MatrixXd& points, int nodes) {
  if (points.cols() != 2) throw std::invalid_argument("smoothing needs points of the plane");
  if (nodes < 1) throw std::invalid_argument("smoothing needs at least one node");
}

struct PlaneNode {
  Eigen::RowVector2d offset;
  double weight;
};

// sum over the nodes of weight * stress(point + offset), zero above the surface.
Eigen::MatrixXd convolve(const StressFunction& stress, const Eigen::MatrixXd& points,
                         std::vector<PlaneNode> nodes, double depth, bool surface) {
  double total = 0;
  for (const PlaneNode& node : nodes) total += node.weight;
  for (PlaneNode& node : nodes) node.weight /= total;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd where(points.rows() * n, 2);
  std::vector<double> weight(static_cast<std::size_t>(points.rows() * n));
  Eigen::Index used = 0;
  std::vector<Eigen::Index> owner;
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    for (const PlaneNode& node : nodes) {
      Eigen::RowVector2d at = points.row(p) + node.offset;
      if (surface && at.y() >= 0) continue;
      if (surface && depth > 0) at.y() = std::max(at.y(), -depth * (1 - inside_base));
      where.row(used) = at;
      weight[static_cast<std::size_t>(used++)] = node.weight;
      owner.push_back(p);
    }
  const Eigen::MatrixXd value = stress(where.topRows(used));
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(points.rows(), value.cols());
  for (Eigen::Index k = 0; k < used; ++k)
    result.row(owner[static_cast<std::size_t>(k)]) +=
        weight[static_cast<std::size_t>(k)] * value.row(k);
  return result;
}

}  // namespace

Eigen::MatrixXd smooth_in_plane(const StressFunction& stress, const Eigen::MatrixXd& points,
                                const Kernel& kernel, double depth, int rings) {
  check(points, rings);
  const int directions = 2 * rings + 2;
  std::vector<PlaneNode> nodes;
  for (const Node& ring : gauss_legendre(rings)) {
    const double r = kernel.range() * (1 + ring.at) / 2;
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / directions;
      nodes.push_back({r * Eigen::RowVector2d(std::cos(angle), std::sin(angle)),
                       ring.weight * r * kernel.value(r)});
    }
  }
  return convolve(stress, points, std::move(nodes), depth, true);
}

Eigen::MatrixXd smooth_along_x(const StressFunction& stress, const Eigen::MatrixXd& points,
                               const Kernel& kernel, int count) {
  check(points, count);
  std::vector<PlaneNode> nodes;
  // x = R sin(theta) keeps the integrand smooth where the marginal ends steeply.
  for (const Node& node : gauss_legendre(count)) {
    const double theta = node.at * std::numbers::pi / 2, x = kernel.range() * std::sin(theta);
    nodes.push_back({Eigen::RowVector2d(x, 0), node.weight * kernel.marginal(x) * std::cos(theta)});
  }
  return convolve(stress, points, std::move(nodes), 0, false);
}

}  // namespace grainfield::coupling
