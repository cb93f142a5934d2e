// How models are seen at the points of the observations: through the kernel of the averaging, as
// the grains are. Lengths in units of h.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "continuum/closed/orthotropic_layer.h"
#include "coupling/averaging/kernel.h"
#include "coupling/compare/smooth.h"
#include "coupling/fit/model.h"

namespace grainfield::coupling {

/// Of a layer under a point load: through the kernel in the plane, through its marginal on the
/// base. Stresses of F/h; load at (0, 0), y up, base y = -1. Of a heap: through the kernel in the
/// plane, apex at (0, 0). Everything that depends on the points and the kernel alone is worked out
/// once, so that a fit can ask for many parameters.
class ObservationOperator {
 public:
  /// Of a layer. `points`: n x 2, -1 <= y < 0; those with y = -1 are on the base. `kernel`: its
  /// width over h.
  ObservationOperator(const Eigen::MatrixXd& points, const Kernel& kernel);
  /// Of a heap with its base at y = -depth; lengths of points and kernel in the same unit.
  static ObservationOperator of_heap(const Eigen::MatrixXd& points, const Kernel& kernel,
                                     double depth = 1);

  /// Of a heap that was measured: cells are flat, each as long as the kernel is wide.
  static ObservationOperator of_cells(const Eigen::MatrixXd& points, const Kernel& kernel);

  /// The model smoothed at the points, n x 3. `half_plane`: a layer's model goes on below the base;
  /// otherwise nodes below the base take its value at the base. One call of `stress`.
  Eigen::MatrixXd seen(const StressFunction& stress, bool half_plane) const;
  /// The same of a heap's model: where it is nan there is nothing, 0; where the point itself is
  /// outside, or the model has no value anywhere, nan. Two calls of `stress`.
  Eigen::MatrixXd seen_in_heap(const StressFunction& stress) const;
  /// The same of an orthotropic layer under F = 1 with h = 1, by its transform: the smoothing is a
  /// product there.
  Eigen::MatrixXd seen(const continuum::OrthotropicWaves& waves) const;
  /// The rows of `values` (one per point of the constructor) that belong to these points, each of
  /// which must be one of them. Throws std::logic_error otherwise.
  Eigen::MatrixXd pick(const Eigen::MatrixXd& values, const Eigen::MatrixXd& points) const;

  const Eigen::MatrixXd& points() const { return points_; }

 private:
  struct Nodes {
    Eigen::MatrixXd at;
    Eigen::SparseMatrix<double, Eigen::RowMajor> weight;
  };
  struct Level {
    std::vector<Eigen::Index> points;
    Eigen::Index first = 0, count = 0;  // of its depths in shares_
    Eigen::MatrixXd weight;             // wave numbers x depths
  };
  explicit ObservationOperator(const Eigen::MatrixXd& points);
  using Smoothing = std::function<Eigen::MatrixXd(const StressFunction&, const Eigen::MatrixXd&)>;
  Nodes nodes_of(const Smoothing& smooth) const;
  Nodes layer_nodes(const Kernel& kernel, double depth) const;
  void make_levels(const Kernel& kernel);

  Eigen::MatrixXd points_;
  std::map<std::pair<double, double>, Eigen::Index> row_;
  Nodes layer_, half_plane_;
  std::vector<Level> levels_;
  Eigen::VectorXd shares_, waves_, measure_;  // depths, u, its weight du/pi
  Eigen::MatrixXd cosine_, sine_;             // points x wave numbers
};

/// The model of a heap through the operator, at the operator's points alone.
FitModel seen_through(FitModel model, std::shared_ptr<const ObservationOperator> seeing);

}  // namespace grainfield::coupling
