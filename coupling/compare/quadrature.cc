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

void NodeList::add(Eigen::Index point, const Eigen::Ref<const Eigen::RowVectorXd>& at,
                   double weight) {
  for (const double x : at) where_.push_back(x);
  weight_.emplace_back(static_cast<int>(point), static_cast<int>(weight_.size()), weight);
}

SmoothingNodes NodeList::of_points(Eigen::Index points) const {
  const auto count = static_cast<Eigen::Index>(weight_.size());
  SmoothingNodes out;
  out.at = Eigen::Map<const Eigen::MatrixXd>(where_.data(), dim_, count).transpose();
  out.weight.resize(points, count);
  out.weight.setFromTriplets(weight_.begin(), weight_.end());
  return out;
}

}  // namespace grainfield::coupling
