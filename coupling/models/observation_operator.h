// How models are seen at points: through the averaging, as the grains are. Nodes and weights
// depend on points and kernels alone and are worked out once, for as many models as are asked.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "coupling/averaging/kernel.h"
#include "coupling/compare/smooth.h"

namespace grainfield::coupling {

/// How a model's stress is averaged at some points (models' frame), as the grains' is: not at all;
/// with the kernel (over the plane, of points in space over space); along x with the kernel's
/// marginal (of points in space: over the horizontal plane with the kernel as seen from above).
enum class Smoothing { none, kernel, marginal };

struct PointSet {
  Eigen::MatrixXd points;  ///< n x 2 or n x 3
  Smoothing smoothing = Smoothing::none;
  const Kernel* kernel = nullptr;  ///< for kernel, marginal; used by the constructor alone
  /// There is nothing where the model gives nan (outside of a heap): the smoothing counts zero
  /// stress there, and points that are themselves outside stay nan.
  bool empty_outside = false;
  int rings = 6;  ///< of the quadrature of `kernel`
};

class ObservationOperator {
 public:
  /// For sets of points, all in the plane or all in space. Below the base, at -depth, nodes use the
  /// value at the base; depth 0: there is no base.
  ObservationOperator(const std::vector<PointSet>& sets, double depth);
  /// For a heap, through the kernel in the plane. Heaps have kinks and no singularity, so that few
  /// nodes do.
  static ObservationOperator of_heap(const Eigen::MatrixXd& points, const Kernel& kernel,
                                     double depth = 1);

  /// The model at the points, set after set, one row each. One call of `stress`.
  Eigen::MatrixXd seen(const StressFunction& stress) const;

 private:
  // Its rows of nodes_, and with empty_outside its points behind them.
  struct Part {
    Eigen::Index first = 0, nodes = 0, points = 0;
    bool averaged = false, empty_outside = false;
    Eigen::SparseMatrix<double, Eigen::RowMajor> weight;
  };
  static Eigen::MatrixXd smoothed(const Part& part, const Eigen::MatrixXd& values);

  Eigen::MatrixXd nodes_;
  std::vector<Part> parts_;
};

}  // namespace grainfield::coupling
