#include "coupling/studies/boussinesq_limit/settlement.h"

#include <cmath>
#include <limits>

#include "continuum/model.h"
#include "coupling/compare/quadrature.h"

namespace grainfield::coupling {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
// Over the depth: nearest to the load that is predicted, and that is compared; farthest.
constexpr double kNearest = 0.1, kCompared = 0.25, kFarthest = 1, kDeepest = 0.75;
// Nodes on each of equal parts of a vertical line.
constexpr int kParts = 16, kNodes = 3;

/// Vertical strain of a stress: xx, yy, xy, in space xx, yy, zz, yz, xz, xy.
double vertical_strain(const continuum::TransverseModuli& m, const Eigen::RowVectorXd& stress) {
  if (stress.size() == 3) {
    const Eigen::Matrix3d c = continuum::compliance(m.plane_strain());
    return c.row(1).dot(stress);
  }
  return (stress[2] - m.nu_v * (stress[0] + stress[1])) / m.E_v;
}

/// A distance from the axis with its weight: Gauss' rule over a line, in space over a disk, which
/// are `aside` from the axis at most.
std::vector<Node> beside_axis(double aside, int dim) {
  std::vector<Node> out;
  if (dim == 2) return gauss_points(3, -aside, aside);
  for (const Node& n : gauss_points(2, 0, 1)) out.push_back({aside * std::sqrt(n.at), n.weight});
  return out;
}

template <class Wanted>
MeanSettlement mean_of(const Eigen::VectorXd& of, const Eigen::VectorXd& other,
                       const Eigen::VectorXd& places, const Wanted& wanted) {
  MeanSettlement out;
  int count = 0;
  for (Eigen::Index k = 0; k < places.size(); ++k) {
    if (!wanted(std::fabs(places[k])) || !std::isfinite(of[k]) || !std::isfinite(other[k]))
      continue;
    out.of += of[k];
    out.other += other[k];
    ++count;
  }
  if (count == 0) return {kNotKnown, kNotKnown};
  return {out.of / count, out.other / count};
}

}  // namespace

Settlements predicted_settlements(const ModelChoice& layer, const RunFacts& facts,
                                  const continuum::ModuliByDepth& moduli,
                                  const SettlementPlaces& places) {
  const int dim = facts.dim, up = dim - 1;
  const double depth = facts.height;
  struct Line {
    double aside, below, weight;
    double* sum;
  };
  Settlements out{Eigen::VectorXd::Constant(places.surface.size(), kNotKnown),
                  Eigen::VectorXd::Constant(places.axis.size(), kNotKnown)};
  std::vector<Line> lines;
  for (Eigen::Index k = 0; k < places.surface.size(); ++k) {
    if (std::fabs(places.surface[k]) < kNearest * depth) continue;
    out.surface[k] = 0;
    lines.push_back({places.surface[k], 0, 1, &out.surface[k]});
  }
  for (Eigen::Index k = 0; k < places.axis.size(); ++k) {
    if (places.axis[k] < kNearest * depth || places.axis[k] > depth) continue;
    out.axis[k] = 0;
    const std::vector<Node> nodes = beside_axis(places.aside, dim);
    double all = 0;
    for (const Node& n : nodes) all += n.weight;
    for (const Node& n : nodes)
      lines.push_back({n.at, places.axis[k], n.weight / all, &out.axis[k]});
  }
  constexpr Eigen::Index kOfLine = kParts * kNodes;
  const auto count = static_cast<Eigen::Index>(lines.size());
  Eigen::MatrixXd points = Eigen::MatrixXd::Zero(count * kOfLine, dim);
  Eigen::VectorXd lengths(points.rows());
  Eigen::Index row = 0;
  for (const Line& line : lines) {
    const double part = (depth - line.below) / kParts;
    for (int p = 0; p < kParts; ++p) {
      for (const Node& n : gauss_points(kNodes, -depth + p * part, -depth + (p + 1) * part)) {
        points(row, 0) = line.aside;
        points(row, up) = n.at;
        lengths[row++] = line.weight * n.weight;
      }
    }
  }
  const auto model = continuum::make_model(layer.name, filled_settings(layer, facts));
  const Eigen::MatrixXd stress = stress_at(layer, *model, points);
  for (row = 0; row < points.rows(); ++row) {
    const double strain = vertical_strain(moduli.at(-points(row, up)), stress.row(row));
    *lines[static_cast<std::size_t>(row / kOfLine)].sum -= lengths[row] * strain;
  }
  return out;
}

MeanSettlement mean_on_surface(const Settlements& of, const Settlements& other,
                               const SettlementPlaces& places, double depth) {
  return mean_of(of.surface, other.surface, places.surface,
                 [&](double at) { return at >= kCompared * depth && at <= kFarthest * depth; });
}

MeanSettlement mean_on_axis(const Settlements& of, const Settlements& other,
                            const SettlementPlaces& places, double depth) {
  return mean_of(of.axis, other.axis, places.axis,
                 [&](double at) { return at >= kCompared * depth && at <= kDeepest * depth; });
}

}  // namespace grainfield::coupling
