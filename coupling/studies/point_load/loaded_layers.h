// Loaded layers in the plane and in space: what their analyses have in common.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "coupling/averaging/layer.h"
#include "coupling/observe/method_averages.h"
#include "coupling/observe/seen_models.h"
#include "coupling/run/realization_file.h"

namespace grainfield::coupling {

/// An ensemble on the way: every method's response along lines at average.depths and on a map.
struct LoadedLayers {
  /// `beside`: further averages of each method.
  LoadedLayers(const Case& value, const std::vector<std::string>& files, int threads, int dim,
               std::size_t beside);

  const Case& value;
  const std::vector<std::string>& files;
  const AverageSetup& setup;
  int dim;
  double force;  ///< N
  MeanLayer layer;
  double half;  ///< m: of lines and map, either side of the load
  int columns, rows;
  std::vector<MethodAverages> methods;
  std::shared_ptr<const Kernel> kernel;  ///< of the first method
  std::map<std::string, std::vector<double>> figures;
  std::vector<double> pushed;  ///< pushed_over_radius of each realization

  std::string component() const { return dim == 2 ? "sigma_yy" : "sigma_zz"; }
  double height(std::size_t line) const { return -setup.depths[line] * layer.depth; }
  void add_figures_of(const Realization& realization);
  /// With what `grainfield compare` needs to know of a field.
  Field described(Field field, const AverageOptions& options) const;
  /// The first method's lines, and the base; in space of radii. `note` ends that of tables.
  Observations observed(const Ensemble& base, const Field& map, const std::string& note = "") const;
  void add_own_figures(Summary& summary) const;
  /// Appends, where the load rearranges grains, that no elastic model applies.
  void add_doubts(std::vector<std::string>& doubts) const;
};

/// A field on points of the models' frame; nx, ny, nz: of a grid.
Field in_models_frame(Field field, const Eigen::MatrixXd& points, int nx = 0, int ny = 0,
                      int nz = 0);

}  // namespace grainfield::coupling
