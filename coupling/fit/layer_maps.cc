#include "coupling/fit/layer_maps.h"

#include <fmt/format.h>

#include <cctype>
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
const char* const kLabels[] = {"-sigma_xx", "-sigma_yy", "sigma_xy"};
constexpr double kSigns[] = {-1, -1, 1};

}  // namespace

LayerMaps layer_maps(const Case& value, const std::vector<std::string>& files,
                     const LayerData& data, int threads) {
  LayerMaps out;
  out.columns = static_cast<int>(value.average.map_columns);
  out.rows = static_cast<int>(value.average.map_rows);
  const double half = data.data.points.col(0).cwiseAbs().maxCoeff();
  out.points = grid_points(-half, half, out.columns, kBottom, kTop, out.rows);
  const AverageOptions options =
      average_options(value.average, value.average.methods.front(), data.diameter, threads);
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

Eigen::MatrixXd model_on_maps(const LayerMaps& maps, const LayerData& data, const Fit& fit) {
  const auto sight = std::make_shared<const LayerSight>(maps.points, *data.kernel);
  return find_fit_model(layer_models(sight), fit.name).stress(maps.points, parameters_of(fit));
}

std::vector<Section> map_sections(const LayerMaps& m, const Eigen::MatrixXd& model,
                                  const std::string& name, const std::string& of) {
  const auto map = [&](const std::string& title, const Eigen::VectorXd& values) {
    return Map{title, m.columns, m.rows, m.points, values};
  };
  const auto titled = [&](const std::string& text, const std::string& start) {
    return of.empty() ? start + text : of + ": " + static_cast<char>(std::tolower(start[0])) + text;
  };
  std::vector<Section> out;
  Picture side = maps(titled("rains, model and residual", "G"), "x / h", "y / h", "-σ_{yy}  (F/h)",
                      {map("grains", -m.mean.col(1)), map(name, -model.col(1)),
                       map("grains - " + name, model.col(1) - m.mean.col(1))});
  side.caption =
      "Response to the load, one colour scale for all three; it ends at the 99 % quantile. The "
      "model is smoothed with the kernel of the averaging.";
  out.emplace_back(std::move(side));
  if (m.error.array().isNaN().all()) return out;
  std::vector<Map> residuals;
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd off =
        kSigns[c] * (m.mean.col(c) - model.col(c)).cwiseQuotient(m.error.col(c));
    residuals.push_back(map(
        kLabels[c], off.unaryExpr([](double v) { return std::isfinite(v) ? v : std::nan(""); })));
  }
  Picture where = maps(titled(fmt::format("here {} fails", name), "W"), "x / h", "y / h",
                       "(grains - model) / standard error", residuals);
  where.caption =
      "Residuals in standard errors of the ensemble's mean. Chance alone gives patches of 2 in "
      "places; a coherent region beyond 3 is where the model is wrong.";
  out.emplace_back(std::move(where));
  return out;
}

}  // namespace grainfield::coupling
