#include "coupling/elastic_constants/elastic_map.h"

#include <fmt/format.h>

#include "continuum/constants.h"
#include "coupling/result/csv.h"

namespace grainfield::coupling {

std::string elastic_map_text(const Field& constants) {
  const Eigen::MatrixXd& at = constants.points;
  const Eigen::Index nx = constants.nx;
  const double x0 = at(0, 0), y0 = at(0, 1), dx = at(1, 0) - x0, dy = at(nx, 1) - y0;
  const Column &young = *constants.find("young"), &poisson = *constants.find("poisson");
  Csv out(Csv::kAllDigits);
  out.comment(fmt::format(
      "grainfield elastic map, plane strain: x, y in m, young in N/m; {} x {} nodes, x fastest", nx,
      constants.ny));
  out.row("x", "y", "young", "poisson", "young_error", "poisson_error");
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const bool stable = poisson.value[k] > -1 && poisson.value[k] < 0.5;
    const auto shown = [&](const Eigen::VectorXd& values) { return stable ? values[k] : kNan; };
    out.row(x0 + static_cast<double>(k % nx) * dx, y0 + static_cast<double>(k / nx) * dy,
            shown(young.value), shown(poisson.value), shown(young.error), shown(poisson.error));
  }
  return out.text();
}

}  // namespace grainfield::coupling
