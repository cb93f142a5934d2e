// Responses of layers to a point load.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/layer.h"
#include "coupling/fit/observations.h"
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
  const Eigen::Index n = maps.points.rows();
  Eigen::MatrixXd samples(3 * n, static_cast<Eigen::Index>(files.size()));
  for (std::size_t r = 0; r < files.size(); ++r) {
    const Realization one = read_realization(files[r]);
    const LayerFrame frame = layer_frame(one["unloaded"], one["loaded"].loaded_grain);
    const Field field = response(one["unloaded"], one["loaded"],
                                 frame.to_packing(layer.depth * maps.points), options);
    for (std::size_t c = 0; c < kPlaneStress.size(); ++c) {
      samples.block(static_cast<Eigen::Index>(c) * n, static_cast<Eigen::Index>(r), n, 1) =
          field.find(kPlaneStress[c])->value * (layer.depth / layer.force);
    }
  }
  average_maps(
      samples, [](double, double) { return true; }, maps);
}

}  // namespace

Observations observe_layers(const Case& value, const std::vector<std::string>& files, int threads) {
  Observations out;
  out.specimen = Specimen::layer;
  const MeanLayer layer = mean_layer(files);
  out.height = layer.depth;
  out.unit = layer.force / layer.depth;
  const AverageSetup& setup = value.get<AverageSetup>();
  AverageOptions options = average_options(setup, setup.methods.front(), layer.diameter, threads);
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

  // Rows: component after component of a level, level after level.
  FitData data;
  data.components = value.get<VerdictSetup>().components;
  std::vector<Eigen::RowVector2d> places;
  for (std::size_t l = 0; l <= setup.depths.size(); ++l) {
    const bool base = l == setup.depths.size();
    if (base && !value.get<VerdictSetup>().base) break;
    data.levels.push_back(base ? "base" : fmt::format("{:g}", setup.depths[l]));
    for (std::size_t c = 0; c < data.components.size(); ++c) {
      if (base && data.components[c] == "sigma_xx") continue;
      for (const double at : x) {
        places.emplace_back(at / layer.depth, base ? -1 : -setup.depths[l]);
        data.component.push_back(static_cast<int>(c));
        data.level.push_back(static_cast<int>(l));
      }
    }
  }
  const auto rows = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd all(rows, static_cast<Eigen::Index>(files.size()));
  for (std::size_t r = 0; r < files.size(); ++r) {
    const Realization one = read_realization(files[r]);
    const dem::Snapshot &unloaded = one["unloaded"], &loaded = one["loaded"];
    const LayerFrame frame = layer_frame(unloaded, loaded.loaded_grain);
    Eigen::Index row = 0;
    for (std::size_t l = 0; l < data.levels.size(); ++l) {
      const bool base = l == setup.depths.size();
      Eigen::MatrixXd line(x.size(), 2);
      line << x, Eigen::VectorXd::Constant(x.size(), base ? 0 : -setup.depths[l] * layer.depth);
      const Field field = base ? base_response(unloaded, loaded, x.array() + frame.load_x, *kernel)
                               : response(unloaded, loaded, frame.to_packing(line), options);
      for (const std::string& component : data.components) {
        if (base && component == "sigma_xx") continue;
        all.block(row, static_cast<Eigen::Index>(r), x.size(), 1) =
            field.find(component)->value * (layer.depth / layer.force);
        row += x.size();
      }
    }
  }
  data.points.resize(rows, 2);
  for (Eigen::Index k = 0; k < rows; ++k) data.points.row(k) = places[static_cast<std::size_t>(k)];
  data.samples = all;
  data.scale = (-data.points.col(1)).cwiseInverse();
  keep_complete_rows(data, "average.depths",
                     "choose deeper lines or a smaller average.width_diameters", out);
  add_maps(setup, files, layer, options, out);
  return out;
}

}  // namespace grainfield::coupling
