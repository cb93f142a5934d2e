#include "coupling/fit/heap_sight.h"

#include <cmath>
#include <numbers>

namespace grainfield::coupling {

FitModel seen_through_kernel(FitModel model, double smoothing) {
  if (!(smoothing > 0) || model.name == "cantelaube") return model;
  model.at_point = model.stress;
  model.stress = [exact = model.stress, smoothing](const Eigen::MatrixXd& points,
                                                   const Eigen::VectorXd& parameters) {
    const Eigen::MatrixXd centre = exact(points, parameters);
    Eigen::MatrixXd out = centre / 2;
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3;
      Eigen::MatrixXd moved = points;
      moved.col(0).array() += 2 * smoothing * std::cos(angle);
      moved.col(1).array() += 2 * smoothing * std::sin(angle);
      out +=
          exact(moved, parameters).unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v / 12; });
    }
    return out;  // nan where the centre is
  };
  return model;
}

}  // namespace grainfield::coupling
