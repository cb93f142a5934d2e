#include "coupling/compare/quadrature.h"

#include <boost/math/special_functions/legendre.hpp>

namespace grainfield::coupling {

std::vector<Node> gauss_points(int n, double a, double b) {
  std::vector<Node> out;
  for (const double zero : boost::math::legendre_p_zeros<double>(n)) {
    const double slope = boost::math::legendre_p_prime(n, zero);
    const double weight = (b - a) / ((1 - zero * zero) * slope * slope);
    out.push_back({(a + b) / 2 + (b - a) / 2 * zero, weight});
    if (zero > 0) out.push_back({(a + b) / 2 - (b - a) / 2 * zero, weight});
  }
  return out;
}

void SmoothingPlan::add(Eigen::Index point, const Eigen::Ref<const Eigen::RowVectorXd>& at,
                        double weight) {
  for (const double x : at) where_.push_back(x);
  owner_.push_back(point);
  weight_.push_back(weight);
}

Eigen::MatrixXd SmoothingPlan::evaluate(const StressFunction& stress, Eigen::Index points) const {
  const Eigen::MatrixXd value =
      stress(Eigen::Map<const Eigen::MatrixXd>(where_.data(), dim_,
                                               static_cast<Eigen::Index>(owner_.size()))
                 .transpose());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(points, value.cols());
  for (std::size_t k = 0; k < owner_.size(); ++k)
    result.row(owner_[k]) += weight_[k] * value.row(static_cast<Eigen::Index>(k));
  return result;
}

}  // namespace grainfield::coupling
