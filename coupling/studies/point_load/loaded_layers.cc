#include "coupling/studies/point_load/loaded_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/averaging/average.h"
#include "coupling/averaging/base.h"
#include "coupling/run/study_result.h"
#include "coupling/statistics/spread.h"
#include "coupling/studies/point_load/figures.h"
#include "coupling/studies/point_load/load_effect.h"
#include "coupling/studies/point_load/simulation.h"

namespace grainfield::coupling {
LoadedLayers::LoadedLayers(const Case& a_case, const std::vector<std::string>& realizations,
                           int threads, int dimension, std::size_t beside)
    : value(a_case),
      files(realizations),
      setup(value.get<AverageSetup>()),
      dim(dimension),
      force(dem::force_of_load(value.get<dem::PointLoadSetup>())),
      layer(mean_layer(files)),
      half(setup.half_width > 0 ? std::min(setup.half_width, layer.half_width) : layer.half_width),
      columns(static_cast<int>(setup.map_columns)),
      rows(static_cast<int>(setup.map_rows)),
      methods(methods_of(setup, layer.diameter, threads, setup.depths.size(), beside)),
      kernel(seeing_kernel(methods.front().options, dim)) {}

void LoadedLayers::add_figures_of(const Realization& realization) {
  for (const auto& [key, figure] : realization.figures) figures[key].push_back(figure);
  pushed.push_back(pushed_over_radius(realization["unloaded"], realization["loaded"]));
  figures["response.total_over_load"].push_back(
      total_over_load(realization["unloaded"], realization["loaded"]));
}

Field LoadedLayers::described(Field field, const AverageOptions& options) const {
  say_averaging(options, field);
  field.attributes["h"] = layer.depth;
  field.attributes["F"] = force;
  field.attributes["frame"] = "layer";
  return field;
}

Observations LoadedLayers::observed(const Ensemble& base, const Field& map,
                                    const std::string& note) const {
  const double least = *std::min_element(setup.depths.begin(), setup.depths.end());
  Observations out;
  out.specimen = Specimen::layer;
  out.realizations = static_cast<int>(files.size());
  out.scale = scale_of_load(force, layer.depth, dim, note);
  out.told = {force, layer.depth, dim, least * layer.depth, "", {}};
  out.map = map;
  const MethodAverages& first = methods.front();
  const auto add = [&](const Ensemble& line, const std::string& name, const std::string& key,
                       Smoothing smoothing) {
    out.lines.push_back(observed_line(described(line.with_samples(), first.options),
                                      {component(), name, key, smoothing, dim == 3}, kernel));
  };
  for (std::size_t d = 0; d < first.lines.size(); ++d) {
    const double share = setup.depths[d];
    add(first.lines[d], fmt::format("depth {:g} h ({:.4g} m)", share, share * layer.depth),
        fmt::format("depth_{:g}", share), Smoothing::kernel);
  }
  add(base, "base", "base", Smoothing::marginal);
  return out;
}

void LoadedLayers::add_own_figures(Summary& summary) const {
  add_figures(summary, figures);
  add_values(layers_rows(), {layer.depth, force, layer.diameter, dim}, summary);
  for (const MethodAverages& a : methods) add_method_figures(summary, a, component());
}

void LoadedLayers::add_doubts(std::vector<std::string>& doubts) const {
  const auto mean = [&](const char* key) {
    const auto at = figures.find(key);
    return at == figures.end() ? 0 : spread_of(at->second).mean;
  };
  const LoadEffect effect{force, mean("load.max_displacement_over_radius"),
                          mean("load.contacts_gained") + mean("load.contacts_lost"),
                          mean("dem.contacts"), pushed};
  const bool by_weights = dim == 3 && value.get<dem::PointLoadSetup>().load.weights > 0;
  const std::string doubt = rearrangement_doubt(effect, by_weights ? "load.weights" : "load.force");
  if (!doubt.empty()) doubts.push_back(doubt);
}

Field in_models_frame(Field field, const Eigen::MatrixXd& points, int nx, int ny, int nz) {
  field.points = points;
  field.nx = nx;
  field.ny = ny;
  field.nz = nz;
  return field;
}

}  // namespace grainfield::coupling
