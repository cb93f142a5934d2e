// What both smoothings (smooth.cc, smooth_space.cc) share. Internal to the room.
#pragma once
#include <vector>

#include "coupling/compare/smooth.h"

namespace grainfield::coupling {

/// The base is at -depth up to this share of the depth inside, so that rounding cannot put a node
/// outside the model's domain.
inline constexpr double kInsideBase = 1e-9;
/// Closer to the load than this many kernel ranges the load's singularity decides the error.
inline constexpr double kNearLoad = 1.5;

struct Node {
  double at, weight;
};

/// Gauss-Legendre of n nodes on [a, b].
std::vector<Node> gauss_points(int n, double a = -1, double b = 1);

/// Collects nodes; those of one point one after the other, points in their order.
class NodeList {
 public:
  explicit NodeList(int dim) : dim_(dim) {}

  void add(Eigen::Index point, const Eigen::Ref<const Eigen::RowVectorXd>& at, double weight);
  SmoothingNodes of_points(Eigen::Index points) const;

 private:
  int dim_;
  std::vector<double> where_;  // node by node
  std::vector<Eigen::Triplet<double>> weight_;
};

}  // namespace grainfield::coupling
