// Where models fail: grains, model and residual on a grid, of heaps and of layers.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "coupling/report/report.h"

namespace grainfield::coupling {

/// The ensemble's mean stress on a grid, lengths over h, stresses in the unit of the fit.
struct StressMaps {
  int columns = 0, rows = 0;
  int realizations = 0;         ///< behind `error`
  Eigen::MatrixXd points;       ///< n x 2; no rows: there is no map
  Eigen::MatrixXd mean, error;  ///< n x 3 (xx, yy, xy); error: standard, nan with one realization
};

/// Mean and standard error of sigma_xx, _yy, _xy on maps.points, nan where `shown` (x, y) is false;
/// `samples`: 3n x realizations, the components one after the other.
void average_maps(const Eigen::MatrixXd& samples, const std::function<bool(double, double)>& shown,
                  StressMaps& maps);

struct MapWords {
  std::string unit;     ///< of the stresses, for gnuplot: "F/h"
  std::string caption;  ///< of grains, model and residual side by side
  std::string of;       ///< whose they are, before the titles; may be empty
};

/// Pictures: sigma_yy of grains, model `name` and residual on one colour scale; residuals of all
/// three components in standard errors where there are any. `model`: n x 3.
std::vector<Section> map_sections(const StressMaps& maps, const Eigen::MatrixXd& model,
                                  const std::string& name, const MapWords& words);

}  // namespace grainfield::coupling
