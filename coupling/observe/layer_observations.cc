// Responses of layers to a point load.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/ensemble.h"
#include "coupling/averaging/layer.h"
#include "coupling/observe/observations.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {
namespace {

// Nearer to the surface one grain carries everything; nearer to the base the kernel is cut.
constexpr double kMapTop = -0.12, kMapBottom = -0.97;

// The response on a grid as wide as the lines' complete rows.
void add_maps(const AverageSetup& setup, const std::vector<std::string>& files,
              const MeanLayer& layer, const AverageOptions& options, Observations& out) {
  StressMaps& maps = out.maps;
  maps.columns = static_cast<int>(setup.map_columns);
  maps.rows = static_cast<int>(setup.map_rows);
  const double half = out.data.points.col(0).cwiseAbs().maxCoeff();
  maps.points = grid_points(-half, half, maps.columns, kMapBottom, kMapTop, maps.rows);
  Ensemble all;
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    const LayerFrame frame = layer_frame(one["unloaded"], one["loaded"].loaded_grain);
    all.add(response(one["unloaded"], one["loaded"], frame.to_packing(layer.depth * maps.points),
                     options));
  }
  const Eigen::Index n = maps.points.rows();
  Eigen::MatrixXd samples(3 * n, all.realizations());
  for (std::size_t c = 0; c < kPlaneStress.size(); ++c) {
    samples.middleRows(static_cast<Eigen::Index>(c) * n, n) =
        all.samples(kPlaneStress[c]) * (layer.depth / layer.force);
  }
  average_maps(
      samples, [](double, double) { return true; }, maps);
}

// The depths of the lines, as shares; 1 is the base.
std::vector<double> levels_of(const Case& value) {
  std::vector<double> out = value.get<AverageSetup>().depths;
  if (value.get<FitSetup>().base) out.push_back(1);
  return out;
}

}  // namespace

Observations observe_layers(const Case& value, const std::vector<std::string>& files, int threads) {
  Observations out;
  out.specimen = Specimen::layer;
  const MeanLayer layer = mean_layer(files);
  out.scale = scale_of_load(layer.force, layer.depth);
  const AverageSetup& setup = value.get<AverageSetup>();
  AverageOptions options = average_options(setup, setup.methods.front(), layer.diameter, threads);
  options.quantities = {"sigma"};
  out.width = options.width;
  const auto kernel = seeing_kernel(options);
  options.width /= layer.depth;
  out.kernel = seeing_kernel(options);
  options.width *= layer.depth;
  double half = layer.half_width - kernel->range();
  if (setup.half_width > 0) half = std::min(half, setup.half_width);
  if (half <= 0) {
    throw std::invalid_argument(
        fmt::format("average.width_diameters: found a kernel that reaches {:.3g} m, allowed: less "
                    "than the {:.3g} "
                    "m from the load to the side wall",
                    kernel->range(), layer.half_width));
  }
  const int side = static_cast<int>(half / (0.5 * kernel->independent_length()));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(2 * side + 1, -half, half);

  const std::vector<double> levels = levels_of(value);
  std::vector<Ensemble> lines(levels.size());
  for (const std::string& file : files) {
    const Realization one = read_realization(file);
    const dem::Snapshot &unloaded = one["unloaded"], &loaded = one["loaded"];
    const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
    for (std::size_t l = 0; l < levels.size(); ++l) {
      Eigen::MatrixXd line(x.size(), 2);
      line << x, Eigen::VectorXd::Constant(x.size(), -levels[l] * layer.depth);
      lines[l].add(l == setup.depths.size()
                       ? base_response(unloaded, loaded, x.array() + frame.load_x, *kernel)
                       : response(unloaded, loaded, frame.to_packing(line), options));
    }
  }
  // Rows: component after component of a level, level after level.
  FitData data;
  data.components = value.get<FitSetup>().components;
  const auto n = x.size();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const bool base = l == setup.depths.size();
    data.levels.push_back(base ? "base" : fmt::format("{:g}", levels[l]));
    for (std::size_t c = 0; c < data.components.size(); ++c) {
      if (base && data.components[c] == "sigma_xx") continue;
      const auto row = data.points.rows();
      data.points.conservativeResize(row + n, 2);
      data.points.bottomRows(n) << x / layer.depth, Eigen::VectorXd::Constant(n, -levels[l]);
      data.samples.conservativeResize(row + n, std::ssize(files));
      data.samples.bottomRows(n) =
          lines[l].samples(data.components[c]) * (layer.depth / layer.force);
      data.component.insert(data.component.end(), static_cast<std::size_t>(n), static_cast<int>(c));
      data.level.insert(data.level.end(), static_cast<std::size_t>(n), static_cast<int>(l));
    }
  }
  data.scale = (-data.points.col(1)).cwiseInverse();
  keep_complete_rows(data, "average.depths",
                     "choose deeper lines or a smaller average.width_diameters", out);
  add_maps(setup, files, layer, options, out);
  return out;
}

}  // namespace grainfield::coupling
