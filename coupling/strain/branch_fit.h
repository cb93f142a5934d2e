// The fit that Cambou and Liao share: a change at every contact against its branch.
#pragma once
#include "coupling/strain/neighbourhood.h"

namespace grainfield::coupling {

class BranchFit : public StrainMeasure {
 public:
  /// `changes`: one row per contact of `motion`, m; both must outlive this.
  BranchFit(const GrainMotion& motion, const Eigen::MatrixXd& changes,
            const StrainOptions& options);
  /// Contacts whose point is inside the support; `grains` counts centroids inside it.
  GradientFit at(const Eigen::VectorXd& point) const override;

 private:
  const GrainMotion& motion_;
  const Eigen::MatrixXd& changes_;
  StrainOptions options_;
  Neighbourhood grains_, contacts_;
};

}  // namespace grainfield::coupling
