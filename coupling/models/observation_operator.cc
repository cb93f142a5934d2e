#include "coupling/models/observation_operator.h"

#include <cmath>
#include <limits>

#include "coupling/compare/smooth.h"

namespace grainfield::coupling {
namespace {

constexpr int kHeapRings = 3;

SmoothingNodes nodes_of(const PointSet& set, double depth) {
  const bool space = set.points.cols() == 3;
  if (set.smoothing == Smoothing::marginal) {
    return space ? nodes_over_plane(set.points, *set.kernel)
                 : nodes_along_x(set.points, *set.kernel);
  }
  return space ? nodes_in_space(set.points, *set.kernel, depth, set.rings)
               : nodes_in_plane(set.points, *set.kernel, depth, set.rings);
}

Eigen::MatrixXd stacked(const std::vector<Eigen::MatrixXd>& blocks) {
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& block : blocks) rows += block.rows();
  Eigen::MatrixXd out(rows, blocks.empty() ? 2 : blocks.front().cols());
  rows = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    out.middleRows(rows, block.rows()) = block;
    rows += block.rows();
  }
  return out;
}

}  // namespace

ObservationOperator::ObservationOperator(const std::vector<PointSet>& sets, double depth) {
  std::vector<Eigen::MatrixXd> asked;
  Eigen::Index first = 0;
  for (const PointSet& set : sets) {
    Part part{first, 0, set.points.rows(), set.smoothing != Smoothing::none, set.empty_outside, {}};
    if (part.averaged) {
      SmoothingNodes nodes = nodes_of(set, depth);
      part.nodes = nodes.at.rows();
      part.weight = std::move(nodes.weight);
      asked.push_back(std::move(nodes.at));
    }
    const bool itself = !part.averaged || part.empty_outside;
    if (itself) asked.push_back(set.points);
    first += part.nodes + (itself ? part.points : 0);
    parts_.push_back(std::move(part));
  }
  nodes_ = stacked(asked);
}

ObservationOperator ObservationOperator::of_heap(const Eigen::MatrixXd& points,
                                                 const Kernel& kernel, double depth) {
  return ObservationOperator({{points, Smoothing::kernel, &kernel, true, kHeapRings}}, depth);
}

Eigen::MatrixXd ObservationOperator::smoothed(const Part& part, const Eigen::MatrixXd& values) {
  const auto nodes = values.middleRows(part.first, part.nodes);
  if (!part.empty_outside) return part.weight * nodes;
  Eigen::MatrixXd out =
      part.weight * nodes.unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v; });
  const auto itself = values.middleRows(part.first + part.nodes, part.points);
  for (Eigen::Index p = 0; p < part.points; ++p) {
    if (!itself.row(p).allFinite())
      out.row(p).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

Eigen::MatrixXd ObservationOperator::seen(const StressFunction& stress) const {
  const Eigen::MatrixXd values = stress(nodes_);
  std::vector<Eigen::MatrixXd> out;
  for (const Part& part : parts_) {
    out.push_back(part.averaged ? smoothed(part, values)
                                : Eigen::MatrixXd(values.middleRows(part.first, part.points)));
  }
  return stacked(out);
}

}  // namespace grainfield::coupling
