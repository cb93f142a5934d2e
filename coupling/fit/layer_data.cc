#include "coupling/fit/layer_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/averaging/layer.h"
#include "coupling/fit/setup.h"
#include "coupling/run/averaging_setup.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {
namespace {

constexpr int kLeastValues = 10;

void measure(const std::vector<std::string>& files, LayerData& out) {
  const auto n = static_cast<double>(files.size());
  out.half_width = std::numeric_limits<double>::infinity();
  for (const std::string& file : files) {
    const Realization r = read_realization(file);
    const LayerFrame frame = layer_frame(r["unloaded"], r["loaded"].loaded_grain);
    out.depth += frame.depth() / n;
    out.diameter += mean_diameter(r["unloaded"]) / n;
    out.force += -r["loaded"].applied_force.y() / n;
    out.half_width =
        std::min({out.half_width, frame.load_x - frame.left, frame.right - frame.load_x});
  }
}

}  // namespace

LayerData layer_data(const Case& value, const std::vector<std::string>& files, int threads) {
  LayerData out;
  measure(files, out);
  const AverageSetup& setup = value.get<AverageSetup>();
  AverageOptions options = average_options(setup, setup.methods.front(), out.diameter, threads);
  const auto kernel = seeing_kernel(options);
  options.width /= out.depth;
  out.kernel = seeing_kernel(options);
  options.width *= out.depth;
  double half = out.half_width - kernel->range();
  if (setup.half_width > 0) half = std::min(half, setup.half_width);
  if (half <= 0) {
    throw std::invalid_argument(
        fmt::format("average.width_diameters: found a kernel that reaches {:.3g} m, allowed: less "
                    "than the {:.3g} "
                    "m from the load to the side wall",
                    kernel->range(), out.half_width));
  }
  const int side = static_cast<int>(half / (0.5 * kernel->independent_length()));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(2 * side + 1, -half, half);

  // Rows: component after component of a level, level after level.
  FitData& data = out.data;
  data.components = value.get<VerdictSetup>().components;
  std::vector<Eigen::RowVector2d> places;
  std::vector<std::string> columns;
  for (std::size_t l = 0; l <= setup.depths.size(); ++l) {
    const bool base = l == setup.depths.size();
    if (base && !value.get<VerdictSetup>().base) break;
    data.levels.push_back(base ? "base" : fmt::format("{:g}", setup.depths[l]));
    for (std::size_t c = 0; c < data.components.size(); ++c) {
      if (base && data.components[c] == "sigma_xx") continue;
      for (const double at : x) {
        places.emplace_back(at / out.depth, base ? -1 : -setup.depths[l]);
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
      line << x, Eigen::VectorXd::Constant(x.size(), base ? 0 : -setup.depths[l] * out.depth);
      const Field field = base ? base_response(unloaded, loaded, x.array() + frame.load_x, *kernel)
                               : response(unloaded, loaded, frame.to_packing(line), options);
      for (const std::string& component : data.components) {
        if (base && component == "sigma_xx") continue;
        all.block(row, static_cast<Eigen::Index>(r), x.size(), 1) =
            field.find(component)->value * (out.depth / out.force);
        row += x.size();
      }
    }
  }
  std::vector<int> kept;
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (all.row(k).allFinite()) kept.push_back(static_cast<int>(k));
  }
  out.left_out = static_cast<int>(rows) - static_cast<int>(kept.size());
  if (static_cast<int>(kept.size()) < kLeastValues) {
    throw std::invalid_argument(fmt::format(
        "average.depths: found {} values in the layers, needed: {} or more; choose deeper lines or "
        "a smaller average.width_diameters",
        kept.size(), kLeastValues));
  }
  data.points.resize(rows, 2);
  for (Eigen::Index k = 0; k < rows; ++k) data.points.row(k) = places[static_cast<std::size_t>(k)];
  data.samples = all;
  data.scale = (-data.points.col(1)).cwiseInverse();
  data = rows_of(data, kept);
  return out;
}

}  // namespace grainfield::coupling
