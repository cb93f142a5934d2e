// Where models of a layer fail: grains, model and residual on a grid.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/fit/layer_data.h"
#include "coupling/report/report.h"

namespace grainfield::coupling {

/// The ensemble's response on a grid inside the layer, lengths over h, stresses over F/h.
struct LayerMaps {
  int columns = 0, rows = 0;
  Eigen::MatrixXd points;       ///< n x 2
  Eigen::MatrixXd mean, error;  ///< n x 3 (xx, yy, xy); error: standard, nan with one realization
};

LayerMaps layer_maps(const Case& value, const std::vector<std::string>& files,
                     const LayerData& data, int threads);

/// A fitted model on the maps' points, seen through the same kernel, n x 3.
Eigen::MatrixXd model_on_maps(const LayerMaps& maps, const LayerData& data, const Fit& fit);

/// Pictures: sigma_yy of grains, model and residual on one colour scale; residuals of all three
/// components in standard errors.
std::vector<Section> map_sections(const LayerMaps& maps, const Eigen::MatrixXd& model,
                                  const std::string& name, const std::string& of = "");

}  // namespace grainfield::coupling
