// Gradient of the coarse-grained displacement u(r) = sum m u_i W / sum m W, W = W(|r - x_i|)
// (Goldhirsch 2010):
//   du/dr = sum m (u_i - u) (outer) grad W / sum m W.
// For an affine displacement u_i = a + B x_i it is B J, where J is the same expression with the
// positions x_i for the u_i: the gradient of the coarse-grained position. Disorder makes J differ
// from the unit matrix, so the measure returns (du/dr) J^-1 (the correction of Randles and Libersky
// 1996 for smoothed particles), or du/dr itself when affine_exact is false.
#include "coupling/averaging/kernel.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "coupling/strain/neighbourhood.h"

namespace grainfield::coupling {
namespace {

class KernelGradient : public StrainMeasure {
 public:
  KernelGradient(const GrainMotion& motion, const StrainOptions& options)
      : motion_(motion),
        options_(options),
        kernel_(make_kernel(options.support, options.width, motion.dim)),
        grains_(motion.position, "circle", kernel_->range()) {}

  GradientFit at(const Eigen::VectorXd& point) const override {
    GradientFit fit;
    const auto grains = grains_.around(point);
    fit.grains = static_cast<int>(grains.size());
    if (fit.grains < options_.least_grains || fit.grains <= motion_.dim) return fit;
    const Eigen::MatrixXd x = rows_of(motion_.position, grains),
                          u = rows_of(motion_.displacement, grains);
    Eigen::VectorXd weight(x.rows());
    Eigen::MatrixXd slope(x.rows(), x.cols());  // m grad W
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      const double m = motion_.mass[grains[static_cast<std::size_t>(k)]];
      const Eigen::RowVectorXd d = point.transpose() - x.row(k);
      const double r = d.norm();
      weight[k] = m * kernel_->value(r);
      slope.row(k) = r > 0 ? Eigen::RowVectorXd(m * kernel_->slope(r) / r * d)
                           : Eigen::RowVectorXd(Eigen::RowVectorXd::Zero(x.cols()));
    }
    const double sum = weight.sum();
    if (!(sum > 0)) return fit;
    const Eigen::RowVectorXd mean_x = weight.transpose() * x / sum,
                             mean_u = weight.transpose() * u / sum;
    const Eigen::MatrixXd from_x = x.rowwise() - mean_x, from_u = u.rowwise() - mean_u;
    const Eigen::MatrixXd of_position = from_x.transpose() * slope / sum,
                          of_displacement = from_u.transpose() * slope / sum;
    const Eigen::VectorXd singular = of_position.jacobiSvd().singularValues();
    fit.condition = singular[0] / singular[singular.size() - 1];
    if (!(fit.condition <= options_.largest_condition)) {
      fit.verdict = GradientFit::Verdict::degenerate;
      return fit;
    }
    fit.verdict = GradientFit::Verdict::good;
    fit.displacement = mean_u.transpose();
    fit.gradient = of_displacement;
    if (options_.affine_exact) fit.gradient *= of_position.inverse();
    const Eigen::VectorXd left =
                              (from_u - from_x * fit.gradient.transpose()).rowwise().squaredNorm(),
                          data = from_u.rowwise().squaredNorm();
    const double all = weight.dot(data);
    fit.misfit = all > 0 ? std::sqrt(weight.dot(left) / all) : 0;
    return fit;
  }

 private:
  const GrainMotion& motion_;
  StrainOptions options_;
  std::unique_ptr<Kernel> kernel_;
  Neighbourhood grains_;
};

}  // namespace

std::unique_ptr<StrainMeasure> make_kernel_gradient(const GrainMotion& motion,
                                                    const StrainOptions& options) {
  return std::make_unique<KernelGradient>(motion, options);
}

}  // namespace grainfield::coupling
