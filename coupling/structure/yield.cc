#include "coupling/structure/yield.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace grainfield::coupling {

double mohr_coulomb_expression(double xx, double yy, double xy, double phi_deg) {
  const double s = std::sin(phi_deg * std::numbers::pi / 180);
  return (xx - yy) * (xx - yy) + 4 * xy * xy - (xx + yy) * (xx + yy) * s * s;
}

double mobilised_friction_deg(double xx, double yy, double xy) {
  const double pressure = -(xx + yy);
  if (!(pressure > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double shear = std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy);
  return std::asin(std::min(1.0, shear / pressure)) * 180 / std::numbers::pi;
}

void add_yield_columns(Field& field, double phi_deg) {
  if (!(phi_deg > 0 && phi_deg < 90))
    throw std::invalid_argument(
        fmt::format("friction angle: found {:g} degrees, allowed: above 0, below 90", phi_deg));
  for (const char* name : {"sigma_xx", "sigma_yy", "sigma_xy"})
    if (!field.find(name))
      throw std::invalid_argument(fmt::format("the field has no column {}", name));
  const Eigen::VectorXd xx = field.find("sigma_xx")->value, yy = field.find("sigma_yy")->value;
  Eigen::VectorXd xy = field.find("sigma_xy")->value;
  if (const Column* yx = field.find("sigma_yx")) xy = (xy + yx->value) / 2;
  Eigen::VectorXd relative(xx.size()), mobilised(xx.size());
  for (Eigen::Index p = 0; p < xx.size(); ++p) {
    const double sum = xx[p] + yy[p];
    relative[p] = sum == 0 ? std::numeric_limits<double>::quiet_NaN()
                           : mohr_coulomb_expression(xx[p], yy[p], xy[p], phi_deg) / (sum * sum);
    mobilised[p] = mobilised_friction_deg(xx[p], yy[p], xy[p]);
  }
  field.add("mohr_coulomb", "1").value = relative;
  field.add("mobilised_friction", "deg").value = mobilised;
}

}  // namespace grainfield::coupling
