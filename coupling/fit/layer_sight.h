// How models of a layer under a point load are seen at the points of the data: through the kernel
// of the averaging in the plane, through its marginal on the base. Lengths in units of the depth h,
// stresses of F/h; load at (0, 0), y up, base y = -1.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <map>
#include <utility>
#include <vector>

#include "continuum/closed/orthotropic_layer.h"
#include "coupling/averaging/kernel.h"
#include "coupling/compare/smooth.h"

namespace grainfield::coupling {

/// Everything that depends on the points and the kernel alone is worked out once, so that a fit
/// can ask for many parameters.
class LayerSight {
 public:
  /// `points`: n x 2, -1 <= y < 0; those with y = -1 are on the base. `kernel`: its width over h.
  LayerSight(const Eigen::MatrixXd& points, const Kernel& kernel);

  /// The model smoothed at the points, n x 3. `half_plane`: it goes on below the base; otherwise
  /// nodes below the base take its value at the base. One call of `stress`.
  Eigen::MatrixXd seen(const StressFunction& stress, bool half_plane) const;
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
  Nodes nodes_of(const Kernel& kernel, double depth) const;
  void make_levels(const Kernel& kernel);

  Eigen::MatrixXd points_;
  std::map<std::pair<double, double>, Eigen::Index> row_;
  Nodes layer_, half_plane_;
  std::vector<Level> levels_;
  Eigen::VectorXd shares_, waves_, measure_;  // depths, u, its weight du/pi
  Eigen::MatrixXd cosine_, sine_;             // points x wave numbers
};

}  // namespace grainfield::coupling
