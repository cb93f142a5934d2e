// Cundall and Strack 1983 (Roul 2.58-2.66): the gradient G that minimises, over the grains with
// centroid in the support,
//   sum |(du_p - <du>) - G (x_p - <x>)|^2.
#include "coupling/strain/neighbourhood.h"

namespace grainfield::coupling {
namespace {

class Cundall : public StrainMeasure {
 public:
  Cundall(const GrainMotion& motion, const StrainOptions& options)
      : motion_(motion),
        options_(options),
        grains_(motion.position, options.support, options.width) {}

  GradientFit at(const Eigen::VectorXd& point) const override {
    GradientFit fit;
    const auto grains = grains_.around(point);
    fit.grains = static_cast<int>(grains.size());
    if (fit.grains < options_.least_grains || fit.grains <= motion_.dim) return fit;
    Eigen::MatrixXd x = rows_of(motion_.position, grains),
                    u = rows_of(motion_.displacement, grains);
    fit.displacement = u.colwise().mean().transpose();
    x.rowwise() -= Eigen::RowVectorXd(x.colwise().mean());
    u.rowwise() -= Eigen::RowVectorXd(fit.displacement.transpose());
    fit_gradient(x, u, options_.largest_condition, fit);
    return fit;
  }

 private:
  const GrainMotion& motion_;
  StrainOptions options_;
  Neighbourhood grains_;
};

}  // namespace

std::unique_ptr<StrainMeasure> make_cundall(const GrainMotion& motion,
                                            const StrainOptions& options) {
  return std::make_unique<Cundall>(motion, options);
}

}  // namespace grainfield::coupling
