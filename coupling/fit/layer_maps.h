// Where models of a layer fail: grains, model and residual on a grid.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "coupling/fit/fit.h"
#include "coupling/fit/layer_data.h"
#include "coupling/fit/stress_maps.h"

namespace grainfield::coupling {

/// The ensemble's response on a grid inside the layer, lengths over h, stresses over F/h.
StressMaps layer_maps(const Case& value, const std::vector<std::string>& files,
                      const LayerData& data, int threads);

/// A fitted model on the maps' points, seen through the same kernel, n x 3.
Eigen::MatrixXd model_on_maps(const StressMaps& maps, const LayerData& data, const Fit& fit);

}  // namespace grainfield::coupling
