#include "coupling/fit/layer_maps.h"

#include <fmt/format.h>

#include <cmath>

#include "coupling/averaging/average.h"
#include "coupling/averaging/layer.h"
#include "coupling/fit/layer_models.h"
#include "coupling/fit/models.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {
namespace {

// Nearer to the surface one grain carries everything; nearer to the base the kernel is cut.
constexpr double kTop = -0.12, kBottom = -0.97;
const char* const kColumns[] = {"sigma_xx", "sigma_yy", "sigma_xy"};

}  // namespace

StressMaps layer_maps(const Case& value, const std::vector<std::string>& files,
                      const LayerData& data, int threads) {
  StressMaps out;
  out.columns = static_cast<int>(value.get<AverageSetup>().map_columns);
  out.rows = static_cast<int>(value.get<AverageSetup>().map_rows);
  const double half = data.data.points.col(0).cwiseAbs().maxCoeff();
  out.points = grid_points(-half, half, out.columns, kBottom, kTop, out.rows);
  const AverageOptions options = average_options(
      value.get<AverageSetup>(), value.get<AverageSetup>().methods.front(), data.diameter, threads);
  const auto n = static_cast<double>(files.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(out.points.rows(), 3), squares = sum;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    const LayerFrame frame = layer_frame(one["unloaded"], one["loaded"].loaded_grain);
    const Field field = response(one["unloaded"], one["loaded"],
                                 frame.to_packing(data.depth * out.points), options);
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd v = field.find(kColumns[c])->value * (data.depth / data.force);
      sum.col(c) += v;
      squares.col(c) += v.cwiseAbs2();
    }
  }
  out.mean = sum / n;
  out.error = ((squares / n - out.mean.cwiseAbs2()).cwiseMax(0) / (n - 1)).cwiseSqrt();
  if (files.size() < 2) out.error.setConstant(std::nan(""));
  return out;
}

Eigen::MatrixXd model_on_maps(const StressMaps& maps, const LayerData& data, const Fit& fit) {
  const auto sight = std::make_shared<const LayerSight>(maps.points, *data.kernel);
  return find_fit_model(layer_models(sight), fit.name).stress(maps.points, parameters_of(fit));
}

}  // namespace grainfield::coupling
