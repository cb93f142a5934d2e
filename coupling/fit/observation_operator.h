// How models are seen at the points of the observations: through the kernel of the averaging, as
// the grains are. Lengths in units of h.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <map>
#include <utility>
#include <vector>

#include "continuum/closed/orthotropic_layer.h"
#include "coupling/averaging/kernel.h"
#include "coupling/compare/smooth.h"
#include "coupling/fit/model.h"

namespace grainfield::coupling {

/// Of a layer under a point load: through the kernel in the plane, through its marginal on the
/// base. Stresses of F/h; load at (0, 0), y up, base y = -1. Everything that depends on the points
/// and the kernel alone is worked out once, so that a fit can ask for many parameters.
class ObservationOperator {
 public:
  /// `points`: n x 2, -1 <= y < 0; those with y = -1 are on the base. `kernel`: its width over h.
  ObservationOperator(const Eigen::MatrixXd& points, const Kernel& kernel);

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

/// Of a heap: the model smoothed over a kernel of the standard deviation `smoothing` along a line:
/// the mean of its point (half of the weight) and six around it at twice that distance, which have
/// the kernel's second moments. Outside the heap there is nothing, 0; where the point itself is
/// outside: nan. Kinks are judged as the grains show them, and the misfit is smooth where one
/// crosses a point. `at_point` of the result is the model as it was. `cantelaube` passes from core
/// to flank over the same width by itself and stays as it is.
FitModel seen_through_kernel(FitModel model, double smoothing);

}  // namespace grainfield::coupling
